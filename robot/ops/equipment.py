"""The devices of a robot on the bench, real or simulated: for commands that look at them without the daemon."""

import math
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, closing, contextmanager, nullcontext
from dataclasses import dataclass
from typing import Any

from maps import Marker, find_map
from protocol.clock import Clock, RealClock, SteppedClock
from robot.core.config import Settings
from robot.drivers.create2.serial_port import SerialPort, open_serial
from robot.drivers.create2.wake_up import WakeUpLine
from robot.drivers.interfaces import Camera
from robot.ops.assembly import Simulation, simulated_robot
from robot.ops.hardware import pin_factory, real_camera, real_port
from robot.simulated import Pose, SimulatedRobot
from robot.simulated.live import Live
from robot.simulated.pushing import pushed_over_the_tape


@dataclass(frozen=True)
class Equipment:
    """Access to the devices. The caller closes what it opens."""

    open_port: Callable[[], SerialPort]
    wake_up_line: WakeUpLine
    pin_factory: Callable[[], Any]
    open_camera: Callable[[], Camera]
    robot: SimulatedRobot | None = None
    """The simulated robot behind them; None on a real one."""

    @property
    def simulated(self) -> bool:
        return self.robot is not None

    def pushed(self) -> AbstractContextManager[None]:
        """The simulated world pushes its robot over the tape meanwhile; a real one is pushed by a person."""
        return pushed_over_the_tape(self.robot) if self.robot else nullcontext()

    def hold_before_marker(self, distance_mm: float) -> None:
        """Put a simulated robot square before the marker that it sees; a real one was put there by a person."""
        if self.robot:
            self.robot.place(_before(self.robot.world.markers[0], distance_mm))


def real_equipment(settings: Settings) -> Equipment:
    """The devices of these settings."""
    line, open_port = real_port(settings)
    return Equipment(open_port, line, pin_factory, lambda: real_camera(settings))


@contextmanager
def living_equipment(settings: Settings) -> Iterator[Equipment]:
    """A simulated robot at the first post that lives in real time, its base at a pseudo-terminal.

    Raises CampusMapError, SimulatedWorldError.
    """
    clock = RealClock()
    robot = _robot(settings, clock, in_memory=False)
    with closing(robot), Live(robot, clock):
        yield _equipment(robot, lambda: open_serial(robot.port_path))


@contextmanager
def stepped_equipment(settings: Settings) -> Iterator[Equipment]:
    """A simulated robot at the first post whose time passes when it is stepped. Raises as `living_equipment`."""
    with closing(_robot(settings, SteppedClock(), in_memory=True)) as robot:
        yield _equipment(robot, robot.memory_port)


def _robot(settings: Settings, clock: Clock, *, in_memory: bool) -> SimulatedRobot:
    campus = find_map(settings.map)
    return simulated_robot(settings, campus, clock, Simulation(next(iter(campus.posts)), in_memory=in_memory))


def _equipment(robot: SimulatedRobot, open_port: Callable[[], SerialPort]) -> Equipment:
    return Equipment(open_port, robot.brc, lambda: robot.pin_factory, lambda: robot.camera, robot)


def _before(marker: Marker, distance_mm: float) -> Pose:
    """The camera looks to the left."""
    away_m, face = distance_mm / 1000, marker.heading_rad
    return Pose(
        marker.x_m + away_m * math.cos(face), marker.y_m + away_m * math.sin(face), marker.heading_rad + math.pi / 2
    )
