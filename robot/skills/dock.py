"""Into the dock and out of it. In, the firmware drives by the dock's infrared; out, it does not, so we do."""

import math
from dataclasses import asdict, dataclass

import structlog

from robot.drivers.create2.dock_infrared import sight_of
from robot.drivers.interfaces import STOP, BodyShape, Mode, Odometry, WheelSpeeds
from robot.skills.find_line import align, over_line, sweep
from robot.skills.interfaces import Done, Failed, Outcome, Running, SeekDock, SetMode, View
from robot.skills.script import Part, Script, Scripted, roll, stand, turn_by

log = structlog.get_logger("robot.dock")

CHARGING_S = 3.0
"""Contacts may bounce: only charging for so long is docked."""
CONTACT_LOST_S = 1.0
ATTEMPT_S = 60.0
IDLE_S = 10.0
"""A firmware that has not moved for so long has given up."""
RETRY_BACK_MM, RETRY_BACK_MM_S = 250.0, 100.0
"""Each try begins so much farther off than the one before: from too near the firmware cannot come straight."""
ROAMS_MM, UNSEEN_S = 300.0, 2.0
"""A firmware that has seen no dock for so long roams in search of one: no farther than this, since the corridors around
are not granted."""
AWAITS_BEAMS_S = 15.0
UNDOCK_MM, UNDOCK_MM_S, UNDOCK_TURN_MM_S = 300.0, 200.0, 200.0
TO_POST_MM_S = 200.0
TO_LINE_MM, TO_LINE_MM_S = (280.0, 130.0, 130.0), 150.0
"""A robot that stood aslant in its dock comes out beside the line: after each of these it looks to both sides."""
ROLLS_ON_MM = 12.7
"""What 200 mm/s still roll when the wheels are told to stop."""
MODE_S = 3.0
ASLANT_RAD = math.radians(3)


@dataclass
class DockMetrics:
    """The record of one docking; logged when it is over."""

    tries: int = 0
    bounces: int = 0
    """How often the contacts lost power again before 3 s of charging were over."""
    took_s: float = 0.0
    docked: bool = False


class Dock(Scripted):
    """Done when the dock has charged for 3 s; no_dock after the last try."""

    name = "dock"
    on_timeout = "no_dock"

    def __init__(self, tries: int = 3, shape: BodyShape | None = None, limit_s: float = 300.0) -> None:
        self._tries, self._shape = tries, shape or BodyShape()
        self.limit_s = limit_s
        self.metrics = DockMetrics()
        self._dock_seen_s = -math.inf

    def script(self, view: View) -> Script:
        """Seek; on failure back off, look again the way the line led to the dock, and seek again."""
        began_s, begin = view.at_s, view.odometry
        while self.metrics.tries < self._tries:
            self.metrics.tries += 1
            view = yield from self._seek(view, begin)
            if _charging(view):
                return self._over(Done(), view.at_s - began_s)
            view = yield from self._go_back(view, begin) if self._roams(view, begin) else self._back_off(view, begin)
        return self._over(Failed("no_dock"), view.at_s - began_s)

    def _over(self, outcome: Outcome, took_s: float) -> Outcome:
        self.metrics.took_s, self.metrics.docked = took_s, isinstance(outcome, Done)
        log.info("docking", **asdict(self.metrics))
        return outcome

    def _seek(self, view: View, begin: Odometry) -> Part:
        began_s = moved_s = view.at_s
        charging_since_s: float | None = None
        charging_s = view.at_s
        odometry = view.odometry
        view = yield Running(None, () if _charging(view) else (SeekDock(),))
        while view.at_s - began_s < ATTEMPT_S and not self._roams(view, begin):
            if view.odometry.travelled_mm != odometry.travelled_mm:
                odometry, moved_s = view.odometry, view.at_s
            if _charging(view):
                charging_s = moved_s = view.at_s
                charging_since_s = view.at_s if charging_since_s is None else charging_since_s
                if view.at_s - charging_since_s >= CHARGING_S:
                    return view
            elif view.at_s - charging_s > CONTACT_LOST_S:
                self.metrics.bounces += charging_since_s is not None
                charging_since_s = None
                if view.at_s - moved_s > IDLE_S:
                    return view
            view = yield Running(None)
        return view

    def _back_off(self, view: View, begin: Odometry) -> Part:
        view = yield Running(STOP, (SetMode(Mode.SAFE),))
        back_mm = RETRY_BACK_MM * (1 + self.metrics.tries) / 2
        view = yield from roll(view, back_mm, WheelSpeeds(-RETRY_BACK_MM_S, -RETRY_BACK_MM_S))
        return (yield from self._look_to(view, begin.heading_rad))

    def _go_back(self, view: View, begin: Odometry) -> Part:
        """To where it began, and wait there for the dock to show itself."""
        view = yield Running(STOP, (SetMode(Mode.SAFE),))
        view = yield from _until_mode(view, Mode.SAFE)
        back_x_mm, back_y_mm = begin.x_mm - view.odometry.x_mm, begin.y_mm - view.odometry.y_mm
        view = yield from self._look_to(view, math.atan2(back_y_mm, back_x_mm))
        view = yield from roll(view, math.hypot(back_x_mm, back_y_mm), WheelSpeeds(RETRY_BACK_MM_S, RETRY_BACK_MM_S))
        view = yield from self._look_to(view, begin.heading_rad)
        until_s = view.at_s + AWAITS_BEAMS_S
        while view.at_s < until_s and not _sees_dock(view):
            view = yield Running(STOP)
        return view

    def _roams(self, view: View, begin: Odometry) -> bool:
        """Return whether the firmware has gone far from where it was to begin, and not to a dock."""
        if _sees_dock(view) or _charging(view):
            self._dock_seen_s = view.at_s
        far_mm = math.dist((view.odometry.x_mm, view.odometry.y_mm), (begin.x_mm, begin.y_mm))
        return far_mm > ROAMS_MM and view.at_s - self._dock_seen_s > UNSEEN_S

    def _look_to(self, view: View, heading_rad: float) -> Part:
        off_rad = math.remainder(heading_rad - view.odometry.heading_rad, math.tau)
        return (yield from turn_by(view, off_rad, UNDOCK_TURN_MM_S, self._shape)) if abs(off_rad) > ASLANT_RAD else view


class Undock(Scripted):
    """Back off 300 mm in Full (Safe ends on a powered dock), turn round, and go on to the line."""

    name = "undock"

    def __init__(
        self,
        shape: BodyShape | None = None,
        way_mm: float | None = None,
        line_ahead: bool = True,
        limit_s: float = 60.0,
    ) -> None:
        """`way_mm`: from the docked axle to the post, by the map. `line_ahead`: whether the line leads on from there;
        where all lines lie across, the robot stands at the post and the turn that follows finds one."""
        self._shape, self._way_mm, self._line_ahead = shape or BodyShape(), way_mm, line_ahead
        self.limit_s = limit_s

    def script(self, view: View) -> Script:
        """not_docked when it is not on a dock, line_lost when there is none behind it."""
        if view.base is None or not view.base.docked:
            return Failed("not_docked")
        view = yield Running(STOP, (SetMode(Mode.FULL),))
        view = yield from _until_mode(view, Mode.FULL)
        view = yield from roll(view, UNDOCK_MM, WheelSpeeds(-UNDOCK_MM_S, -UNDOCK_MM_S))
        view = yield Running(STOP, (SetMode(Mode.SAFE),))
        view = yield from _until_mode(view, Mode.SAFE)
        view = yield from turn_by(view, math.pi, UNDOCK_TURN_MM_S, self._shape)
        along_rad = view.odometry.heading_rad
        if self._way_mm is not None:
            rest_mm = max(0.0, self._way_mm - UNDOCK_MM - ROLLS_ON_MM)
            view = yield from roll(view, rest_mm, WheelSpeeds(TO_POST_MM_S, TO_POST_MM_S))
        if not self._line_ahead:
            return Done()
        view = yield from self._to_line(view, along_rad)
        return Done() if over_line(view) else Failed("line_lost")

    def _to_line(self, view: View, along_rad: float) -> Part:
        """The tape ends at the post, some way before the dock; nothing is done by a robot that is over it."""
        if over_line(view):
            return view
        for distance_mm in TO_LINE_MM if self._way_mm is None else (0.0, *TO_LINE_MM[1:]):
            view = yield from roll(view, distance_mm, WheelSpeeds(TO_LINE_MM_S, TO_LINE_MM_S), over_line)
            if over_line(view):
                break
            view = yield from sweep(view, self._shape)
            if over_line(view):
                return (yield from align(view, self._shape, along_rad))
        return view


def _sees_dock(view: View) -> bool:
    return view.base is not None and sight_of(view.base) is not None


def _charging(view: View) -> bool:
    return view.base is not None and view.base.docked and view.base.charging


def _until_mode(view: View, mode: Mode) -> Part:
    """Wait until the base says so; an odd firmware never does, so not for ever."""
    until_s = view.at_s + MODE_S
    while view.at_s < until_s and view.base is not None and view.base.mode not in (mode, Mode.UNKNOWN):
        view = yield Running(STOP)
    return (yield from stand(view, 0.05))
