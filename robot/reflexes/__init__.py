"""What the body does without asking: one table (`table`), and one pure function that reads it (`decisions`).

It works when everything above is dead: it needs the newest frame of the base, a few ages, and the speeds wanted.
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
