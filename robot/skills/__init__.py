"""The long actions of the body. What one is: `interfaces`; how each ends, and by which names it fails: `ends`."""

from .dock import Dock, Undock
from .find_line import FindLine
from .follow_line import FollowLine
from .handover import WaitHandover
from .interfaces import (
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
from .look_back import LookBack
from .paper import DrivePulse, PaperTurn
from .say import Say
from .turn import Turn

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
