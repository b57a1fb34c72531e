"""The simulated world that ships with the product: a strict Create 2 on a serial port, pins, frames."""

from .battery import Pack
from .body import Build
from .door import Door
from .drive_base import Motion
from .errors import SimulatedWorldError, UnknownStart, UnknownSwitch, WrongValue
from .faults import SWITCHES, Faults
from .frames import CameraMount
from .host import SimulatedHost
from .obstacles import Person, Wall
from .pins import DiodeMount
from .robot import Options, SimulatedRobot
from .serial_line import MemoryPort
from .start import Pose
from .world import World

__all__ = [
    "SWITCHES",
    "Build",
    "CameraMount",
    "DiodeMount",
    "Door",
    "Faults",
    "MemoryPort",
    "Motion",
    "Options",
    "Pack",
    "Person",
    "Pose",
    "SimulatedHost",
    "SimulatedRobot",
    "SimulatedWorldError",
    "UnknownStart",
    "UnknownSwitch",
    "Wall",
    "World",
    "WrongValue",
]
