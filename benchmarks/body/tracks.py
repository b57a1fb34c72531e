"""Taped lines to measure the follower on, as maps with a post at each end, and a robot that is stepped along them."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise

from maps import CampusMap, Corridor, Marker, Point, Post
from maps.geometry import heading_rad, moved, path_length_m
from robot.drive_loop import DriveLoop
from robot.drivers.camera.marker_reader import MarkerReader, MarkerWatch
from robot.drivers.create2.create2 import Create2
from robot.drivers.interfaces import BodyShape
from robot.drivers.line_sensor import ThreeDiodes
from robot.simulated import Build, CameraMount, DiodeMount, Options, SimulatedRobot
from robot.simulated.base.commands import COMMANDS
from robot.simulated.base.serial_line import MemoryPort
from robot.skills.interfaces import Outcome, Skill

STEP_S, STEPS_PER_TICK, TICKS_PER_LOOK = 0.005, 4, 5
"""World and diodes at 200 Hz, drive loop at 50 Hz, camera at 10 Hz, as the daemon has them."""
BEYOND_M = 0.4
"""The tape goes on behind the last post: what is lost at the end of a line is no fault of the follower."""
FLIPPED = 0.01
GAP_M = 0.02
DRIVE_DIRECT, DRIVE = 145, 137


@dataclass(frozen=True)
class Bend:
    """Part of a circle; left is positive."""

    radius_m: float
    angle_rad: float


Leg = float | Bend
"""Metres straight on, or a bend."""
QUARTER = math.pi / 2
TRACKS: dict[str, tuple[Leg, ...]] = {
    "straight": (6.0,),
    "s_600_400": (1.0, Bend(0.6, QUARTER), Bend(0.4, -QUARTER), 1.0),
    "s_250_200": (1.0, Bend(0.25, QUARTER), Bend(0.2, -QUARTER), 1.0),
}
"""Each S has a metre of straight tape before and behind it, and no straight piece between its two bends."""


def tape(legs: tuple[Leg, ...], step_rad: float = math.radians(2)) -> tuple[Point, ...]:
    """The middle of the tape, eastwards from the origin."""
    points, heading = [Point(0.0, 0.0)], 0.0
    for leg in legs:
        if isinstance(leg, float):
            points.append(moved(points[-1], heading, leg))
            continue
        side = math.copysign(1.0, leg.angle_rad)
        centre = moved(points[-1], heading, 0.0, side * leg.radius_m)
        steps = math.ceil(abs(leg.angle_rad) / step_rad)
        for i in range(1, steps + 1):
            points.append(moved(centre, heading + leg.angle_rad * i / steps, 0.0, -side * leg.radius_m))
        heading += leg.angle_rad
    return tuple(points)


def track_map(name: str) -> CampusMap:
    """Posts `a` (where the robot is put down) and `b` (with a marker), and more tape up to `c`."""
    line = tape(TRACKS[name])
    heading = heading_rad(*line[-2:])
    end = line[-1]
    beyond = moved(end, heading, BEYOND_M)
    beside = moved(end, heading, -0.3, 0.35)
    marker = Marker("b", beside.x_m, beside.y_m, heading - math.pi / 2)
    places = (("a", line[0], ()), ("b", end, (marker,)), ("c", beyond, ()))
    posts = {name: Post(name, name, *point, markers) for name, point, markers in places}
    corridors = (
        Corridor("a", "b", path_length_m(line), False, line),
        Corridor("b", "c", BEYOND_M, False, (end, beyond)),
    )
    return CampusMap(name, name, posts, corridors)


@dataclass
class Tap:
    """A serial port that notes every drive command among the bytes that pass."""

    port: MemoryPort
    commands: list[tuple[int, int]] = field(default_factory=list)
    """(right, left) wheel speed in mm/s, as the manual orders them."""
    _rest: bytearray = field(default_factory=bytearray)

    def read(self, size: int = 1) -> bytes:
        return self.port.read(size)

    def write(self, data: bytes) -> int:
        self._rest += data
        while self._take():
            pass
        return self.port.write(data)

    def close(self) -> None:
        self.port.close()

    @property
    def baudrate(self) -> int:
        return self.port.baudrate

    @baudrate.setter
    def baudrate(self, baud: int) -> None:
        self.port.baudrate = baud

    def _take(self) -> bool:
        if not self._rest:
            return False
        command = COMMANDS.get(self._rest[0])
        if command is None:
            # As the base does: what it does not know it ignores, one byte at a time.
            del self._rest[0]
            return True
        size = command.missing(self._rest[1:]) + len(self._rest)
        if size > len(self._rest):
            return False
        taken = bytes(self._rest[:size])
        del self._rest[:size]
        assert taken[0] != DRIVE, "a drive command that this benchmark does not read"
        if taken[0] == DRIVE_DIRECT:
            speeds = tuple(int.from_bytes(taken[i : i + 2], "big", signed=True) for i in (1, 3))
            self.commands.append((speeds[0], speeds[1]))
        return True


class Stepped:
    """World, drive loop and camera in stepped time, with the real drivers on bytes, pins and frames."""

    def __init__(self, campus: CampusMap, start: str, seed: int, lead_mm: float, flipped: float = FLIPPED) -> None:
        mount = DiodeMount(lead_mm=lead_mm)
        options = Options(build=Build(diodes=mount), camera=CameraMount(colour=False), gap_m=GAP_M)
        self.now, self.campus = 100.0, campus
        self.robot = SimulatedRobot(campus, self.now, start, seed, in_memory=True, options=options)
        self.robot.set_fault("floor_flip", flipped)
        self.shape = BodyShape(sensor_lead_mm=lead_mm, diode_spacing_mm=mount.spacing_mm)
        self.wire = Tap(self.robot.memory_port())
        self.base = Create2(lambda: self.wire, self.robot.brc)
        pins = (f"GPIO{pin}" for pin in (mount.left_pin, mount.centre_pin, mount.right_pin))
        self.sensor = ThreeDiodes(*pins, pin_factory=self.robot.pin_factory)
        self.loop = DriveLoop(self.base, self.sensor, self.shape, self.now)
        self.watch = MarkerWatch(self.robot.camera, MarkerReader(campus.posts, shape=self.shape), self.now)
        self._ticks = 0
        for _ in range(20):
            self.tick()

    def tick(self) -> None:
        """A fiftieth of a second; the drive loop takes the fourth look at the diodes itself."""
        for step in range(1, STEPS_PER_TICK + 1):
            self.robot.step_until(self.now + step * STEP_S)
            if step < STEPS_PER_TICK:
                self.loop.sample_line()
        self._ticks += 1
        self.now += STEPS_PER_TICK * STEP_S
        self.loop.heartbeat(self.now)
        if self._ticks % TICKS_PER_LOOK == 0:
            self.loop.report(self.watch.tick(self.now), self.now)
        self.loop.tick(self.now)

    def do(self, skill: Skill, each_tick: Callable[[], None] = lambda: None) -> Outcome:
        """Its outcome; `each_tick` is called after every tick until then."""
        job = self.loop.start(skill, self.now)
        while True:
            self.tick()
            each_tick()
            for end in self.loop.finished():
                if end.job == job:
                    return end.outcome

    def close(self) -> None:
        self.base.close()
        self.sensor.close()
        self.robot.close()


def beside_mm(line: tuple[Point, ...], point: Point) -> float:
    """Return the distance of the point from the line, left of it positive."""
    return 1000 * min((_beside_m(a, b, point) for a, b in pairwise(line)), key=abs)


def _beside_m(a: Point, b: Point, point: Point) -> float:
    heading = heading_rad(a, b)
    dx, dy = point.x_m - a.x_m, point.y_m - a.y_m
    along, across = math.cos(heading), math.sin(heading)
    ahead, left = dx * along + dy * across, dy * along - dx * across
    beyond = ahead - min(max(ahead, 0.0), math.dist(a, b))
    return math.copysign(math.hypot(beyond, left), left or 1.0)
