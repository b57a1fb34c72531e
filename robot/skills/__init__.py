"""The long actions of the body. What they are, and how they end: interfaces.py.

FollowLine(campus, leaving=None, cruise_mm_s=150.0, shape=None)  Done(post) | line_lost, blocked, docked, timeout
Turn(angle_rad, shape=None)          left is positive; ends on the line. Done() | line_lost, timeout
FindLine(shape=None)                 Done() | line_lost
Dock(tries=3)                        Done() | no_dock
Undock(shape=None)                   Done(), on the line and looking along it | not_docked, line_lost, timeout
WaitHandover(verifiers, limit_s)     Done(sha256 that matched) | Done(None) after Spot twice | no_one_came
Say(tune)                            Done()
DrivePulse(forward|left|right|stop|spiral)   Done() at once; the wheels go on for 0.2 s
PaperTurn(angle_rad)                 Done() | line_lost, timeout after 10 s
"""

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
