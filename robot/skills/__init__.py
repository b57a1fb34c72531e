"""Skills: follow the line, turn, dock, hand over. Each is stepped by the drive loop.

May use localization and the drivers' interfaces.
Start at `interfaces.py`, then `follow_line.py`.
"""

from robot.skills.dock import Dock, Undock
from robot.skills.find_line import FindLine
from robot.skills.follow_line import FollowLine
from robot.skills.handover import WaitHandover
from robot.skills.interfaces import (
    Body,
    Done,
    Failed,
    JobEnd,
    Outcome,
    Play,
    Running,
    SeekDock,
    SetMode,
    ShowLights,
    Skill,
    Step,
    View,
)
from robot.skills.look_back import LookBack
from robot.skills.paper import DrivePulse, PaperTurn
from robot.skills.say import Say
from robot.skills.turn import Turn

__all__ = [
    "Body",
    "Dock",
    "Done",
    "DrivePulse",
    "Failed",
    "FindLine",
    "FollowLine",
    "JobEnd",
    "LookBack",
    "Outcome",
    "PaperTurn",
    "Play",
    "Running",
    "Say",
    "SeekDock",
    "SetMode",
    "ShowLights",
    "Skill",
    "Step",
    "Turn",
    "Undock",
    "View",
    "WaitHandover",
]
