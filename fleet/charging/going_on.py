"""The charge that a robot needs for one more corridor.

Its own battery plan must have no reason to take over before it is through, as good as certain (`Rates.at_most`). So the
robot has the last word and need not say it: its plan would take it to the nearest dock, the robot that stands there,
and keep it there until it is full.
"""

from dataclasses import dataclass
from typing import Final

from fleet.charging.energy import Rates, Use
from fleet.charging.levels import Thresholds

HELD_UP_S: Final = 1800.0
"""So long a robot may have to stand on its way to a dock, by something on the line or before a closed corridor, and
must still come there. Assumed: the staff of the tunnels is there within half an hour."""


@dataclass(frozen=True, slots=True)
class Charge:
    """The charge of a robot, and what it spends."""

    ratio: float
    rates: Rates


def goes_on(charge: Charge, leg: Use, to_dock: Use, thresholds: Thresholds) -> bool:
    """Tell if a robot may enter one more corridor: at its end its own battery plan must not have taken over, and it
    must still come to a dock with a reserve. Else it goes to a dock now, from where it is sure to come to one."""
    rates = charge.rates
    there = leg + to_dock + Use(0.0, HELD_UP_S)
    needed = max(thresholds.low + rates.at_most(leg), thresholds.critical + rates.at_most(there))
    return charge.ratio >= needed
