"""A simulated robot with its drive loop and camera, stepped in memory: what the tests drive."""

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np

from maps import CampusMap
from robot.drive_loop import DriveLoop
from robot.drivers.camera.marker_reader import MarkerReader, MarkerWatch
from robot.drivers.create2.create2 import Create2
from robot.drivers.interfaces import BodyShape
from robot.drivers.line_sensor import ThreeDiodes
from robot.simulated import Options, SimulatedRobot
from robot.skills.interfaces import JobEnd, Outcome, Skill
from tests.plain_maps import plain_map

TICK_S = 0.02
CAMERA_EVERY = 5


@dataclass
class Drive:
    """Steps world, drive loop and camera together; keeps the path and every speed that was sent."""

    start: str
    campus: CampusMap = field(default_factory=lambda: plain_map("test_track"))
    seed: int = 1
    options: Options = field(default_factory=Options)
    battery_ratio: float | None = None
    camera_works: bool = True

    def __post_init__(self) -> None:
        self.now = 100.0
        self.robot = SimulatedRobot(
            self.campus,
            self.now,
            self.start,
            self.seed,
            in_memory=True,
            options=self.options,
            battery_ratio=self.battery_ratio,
        )
        mount = self.options.build.diodes
        self.shape = BodyShape(sensor_lead_mm=mount.lead_mm, diode_spacing_mm=mount.spacing_mm)
        self.base = Create2(self.robot.memory_port, self.robot.brc)
        pins = (f"GPIO{pin}" for pin in (mount.left_pin, mount.centre_pin, mount.right_pin))
        self.sensor = ThreeDiodes(*pins, pin_factory=self.robot.pin_factory)
        self.loop = DriveLoop(self.base, self.sensor, self.shape, self.now)
        self.watch = MarkerWatch(self.robot.camera, MarkerReader(self.campus.track.posts), self.now)
        self.path: list[tuple[float, float]] = []
        self.sent: list[tuple[float, float]] = []
        self.readings: list[str] = []
        self.mind_lives = True
        self._ticks = 0
        self.steps(0.3)

    def tick(self) -> None:
        self.now += TICK_S
        self._ticks += 1
        self.robot.step_until(self.now)
        if self.mind_lives:
            self.loop.heartbeat(self.now)
        if self._ticks % CAMERA_EVERY == 0:
            self.loop.report(self.watch.tick(self.now), self.now)
        self.loop.tick(self.now)
        self.path.append((self.robot.pose.x_m, self.robot.pose.y_m))
        self.sent.append(tuple(self.loop.view.sent))
        self.readings.append(self.loop.view.reading.pattern)

    def steps(self, for_s: float) -> None:
        for _ in range(round(for_s / TICK_S)):
            self.tick()

    def until(self, condition: Callable[[], bool], limit_s: float = 60.0) -> float:
        """Seconds until it holds; AssertionError after `limit_s`."""
        began = self.now
        while not condition():
            assert self.now - began < limit_s, f"not within {limit_s} s: {self.loop.view}"
            self.tick()
        return self.now - began

    def end_of(self, job: int, limit_s: float = 120.0) -> Outcome:
        ends: list[JobEnd] = []

        def over() -> bool:
            ends.extend(end for end in self.loop.finished() if end.job == job)
            return bool(ends)

        self.until(over, limit_s)
        return ends[0].outcome

    def do(self, skill: Skill, limit_s: float = 120.0) -> Outcome:
        return self.end_of(self.loop.start(skill, self.now), limit_s)

    def distance_to_m(self, post: str) -> float:
        there, here = self.campus.post(post), self.robot.pose
        return float(np.hypot(there.x_m - here.x_m, there.y_m - here.y_m))

    def close(self) -> None:
        self.base.close()
        self.sensor.close()
        self.robot.close()


def draw(drive: Drive, file: Path, px_per_m: float = 250.0) -> None:
    """The tape and the path of the axle, as a picture to look at."""
    xs = [x for x, _ in drive.path] + [post.x_m for post in drive.campus.posts.values()]
    ys = [y for _, y in drive.path] + [post.y_m for post in drive.campus.posts.values()]
    left, top = min(xs) - 0.4, max(ys) + 0.4
    size = (round((max(ys) - min(ys) + 0.8) * px_per_m), round((max(xs) - min(xs) + 0.8) * px_per_m), 3)
    picture = np.full(size, 255, np.uint8)

    def px(point: tuple[float, float]) -> tuple[int, int]:
        return round((point[0] - left) * px_per_m), round((top - point[1]) * px_per_m)

    for corridor in drive.campus.corridors:
        for a, b in pairwise(corridor.tape):
            cv2.line(picture, px(a), px(b), (210, 210, 210), max(1, round(0.024 * px_per_m)))
    for a, b in pairwise(drive.path):
        cv2.line(picture, px(a), px(b), (200, 60, 20), 1, cv2.LINE_AA)
    cv2.imwrite(str(file), picture)
