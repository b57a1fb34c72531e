"""Reflexes: they stop the wheels without waiting for mind, network or disk.

May use the drivers' interfaces alone.
Start at `decisions.py`.
"""

from robot.reflexes.decisions import BACK_OFF, Decision, ReflexState, decide
from robot.reflexes.lasting import Lasting
from robot.reflexes.senses import Senses
from robot.reflexes.table import FAULTS, HALTING, LATCHED, REFUSING, STOPPING, TOLD, Fault, Response

__all__ = [
    "BACK_OFF",
    "FAULTS",
    "HALTING",
    "LATCHED",
    "REFUSING",
    "STOPPING",
    "TOLD",
    "Decision",
    "Fault",
    "Lasting",
    "ReflexState",
    "Response",
    "Senses",
    "decide",
]
