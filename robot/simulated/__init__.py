"""The simulated world and body: strict, shipped, on a real pseudo-terminal.

Imports `robot.core` alone: it meets the drivers in bytes, pins and frames.
Start at `world.py` and `robot.py`.
"""

from robot.simulated.base.battery import Pack
from robot.simulated.base.drive_base import Motion
from robot.simulated.base.serial_line import MemoryPort
from robot.simulated.body import Build
from robot.simulated.collisions import Collision, CollisionJudge
from robot.simulated.door import Door
from robot.simulated.errors import SimulatedWorldError, UnknownStart, UnknownSwitch, WrongValue
from robot.simulated.faults import SWITCHES, Faults
from robot.simulated.frames import CameraMount
from robot.simulated.host import SimulatedHost
from robot.simulated.obstacles import Person, Wall
from robot.simulated.pins import DiodeMount
from robot.simulated.robot import Options, SimulatedRobot
from robot.simulated.shared_world import SharedWorld
from robot.simulated.start import Pose
from robot.simulated.true_poses import PoseLog, TruePose
from robot.simulated.world import World
from robot.simulated.world_file import WorldFile

__all__ = [
    "SWITCHES",
    "Build",
    "CameraMount",
    "Collision",
    "CollisionJudge",
    "DiodeMount",
    "Door",
    "Faults",
    "MemoryPort",
    "Motion",
    "Options",
    "Pack",
    "Person",
    "Pose",
    "PoseLog",
    "SharedWorld",
    "SimulatedHost",
    "SimulatedRobot",
    "SimulatedWorldError",
    "TruePose",
    "UnknownStart",
    "UnknownSwitch",
    "Wall",
    "World",
    "WorldFile",
    "WrongValue",
]
