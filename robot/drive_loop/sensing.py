"""The body's sensors: base, line sensor, odometry, and what the camera reported; its own parts fail by name."""

import math
from collections.abc import Iterable

import structlog

from robot.drivers.create2.odometry import advanced
from robot.drivers.interfaces import (
    NOTHING_SEEN,
    Base,
    BaseState,
    BodyShape,
    CameraReport,
    Fix,
    LineSensor,
    Odometry,
    PositionSource,
    Sighting,
    WheelSpeeds,
)
from robot.localization.line_symbol import BelievedLineSymbol
from robot.reflexes import Lasting

log = structlog.get_logger("robot.drive")


class Sensing:
    """One `sense` a tick; between ticks `sample_line` for the majority vote."""

    def __init__(
        self,
        base: Base,
        line_sensor: LineSensor,
        shape: BodyShape,
        now: float,
        sources: Iterable[PositionSource] = (),
    ) -> None:
        self._base, self._line_sensor, self._shape = base, line_sensor, shape
        self.state: BaseState | None = None
        self.odometry = Odometry()
        self.reading = NOTHING_SEEN
        self.word = BelievedLineSymbol()
        self.post: Sighting | None = None
        self.post_odometry = Odometry()
        self.code: Sighting | None = None
        self.fixes: dict[str, tuple[Fix, Odometry]] = {}
        self._sources = tuple(sources)
        self.lasting = Lasting()
        self.diodes_broken = False
        self.spot_went_down = False
        """At this tick."""
        self.something_ahead_s = -math.inf
        self._camera_s, self._camera_age_s = now, 0.0
        self.camera_frozen_s = 0.0
        self._started_s = now

    def sense(self, sent: WheelSpeeds, now: float) -> None:
        """`sent`: what the wheels were told at the tick before."""
        new = self._base.poll(now)
        self.spot_went_down = False
        if new is not None:
            old, self.state = self.state or new, new
            self.spot_went_down = new.spot_pressed and not old.spot_pressed
            self.odometry = advanced(self.odometry, old, new, self._shape)
            self.lasting.feel(old, new, sent)
            if new.something_ahead:
                self.something_ahead_s = now
        elif sent.still:
            self.lasting.standing = False
        for source in self._sources:
            for fix in source.fixes(now):
                self.fixes[fix.source] = fix, self.odometry
        self.sample_line()
        self.reading = self._line_sensor.read()
        travelled_mm = self.odometry.travelled_mm
        self.word = self.word.seen(self.reading, travelled_mm)
        self.lasting.look(self.reading, travelled_mm, self.post and self.post.text, driven=not sent.still)

    def sample_line(self) -> None:
        """Pins that cannot be read are a fault of the line sensor, never the end of the loop that keeps the wheels."""
        try:
            self._line_sensor.sample()
            self.diodes_broken = False
        except Exception as error:
            if not self.diodes_broken:
                log.error("line_sensor_unreadable", error=repr(error))
            self.diodes_broken = True

    def take_report(self, report: CameraReport, now: float) -> None:
        """Take in the camera loop's reading of one frame."""
        self._camera_s, self._camera_age_s = now, report.frame_age_s
        self.camera_frozen_s = report.frozen_s
        for sighting in report.posts:
            self.post, self.post_odometry = sighting, self.odometry
        for sighting in report.codes:
            self.code = sighting

    def camera_age_s(self, now: float) -> float:
        return self._camera_age_s + max(0.0, now - self._camera_s)

    def base_age_s(self, now: float) -> float:
        """Before the first frame: since the start."""
        return now - (self.state.at_s if self.state else self._started_s)
