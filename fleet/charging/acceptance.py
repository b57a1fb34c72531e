"""Acceptance: the charge that a robot needs for work, before it gets any and again before each leg.

When it comes to a dock after its work its own battery plan must have had no reason to take over, as good as certain
(`Rates.at_most`). So the robot has the last word and need not say it: its plan would take it to the nearest dock,
the robot that stands there, and keep it there until it is full.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Final

from fleet.charging.energy import Rates, Use
from fleet.charging.levels import Thresholds

HELD_UP_S: Final = 1800.0
"""So long a robot may have to stand on its way to a dock, by something on the line or before a closed corridor, and
must still come there. Assumed: the staff of the tunnels is there within half an hour."""


class Answer(StrEnum):
    """To the question whether a robot may take something on."""

    YES = "yes"
    ON_THE_WAY = "on_the_way"
    """It is more than one charge: full as it is, it may, and it will charge in between."""
    CHARGE_FIRST = "charge_first"
    TOO_FAR = "too_far"
    """This robot never: from no dock does it get to one of the stops and back to a dock."""


@dataclass(frozen=True, slots=True)
class Charge:
    """The charge of a robot. `docked`: it stands in a dock, where it begins nothing below `Thresholds.begin`;
    `until_full`: its own battery plan has taken it there, and lets it go again when it is full."""

    ratio: float
    rates: Rates
    docked: bool = False
    until_full: bool = False


@dataclass(frozen=True, slots=True)
class Verdict:
    """`needed`: the charge with which it may; `left`: what it will have at least when the work is done."""

    answer: Answer
    needed: float
    left: float

    @property
    def is_accepted(self) -> bool:
        return self.answer in (Answer.YES, Answer.ON_THE_WAY)


def accepts(charge: Charge, work: Use, to_dock: Use, thresholds: Thresholds, parts: Sequence[Use] = ()) -> Verdict:
    """Decide if a robot may take on work. `work` is all that it has then; `to_dock` leads from its end to a dock.
    `parts` are for what is more than one charge: for each stop the way there from a dock, and on to a dock."""
    rates = charge.rates
    needed = thresholds.low + rates.at_most(work + to_dock)
    if charge.docked:
        needed = max(needed, thresholds.begin + thresholds.hysteresis)
    left = charge.ratio - rates.at_most(work)
    if needed > thresholds.full and any(thresholds.low + rates.at_most(part) > thresholds.full for part in parts):
        return Verdict(Answer.TOO_FAR, needed, left)
    if charge.until_full or charge.ratio < min(needed, thresholds.full):
        return Verdict(Answer.CHARGE_FIRST, min(needed, thresholds.full), left)
    return Verdict(Answer.YES if charge.ratio >= needed else Answer.ON_THE_WAY, needed, left)


def goes_on(charge: Charge, leg: Use, to_dock: Use, thresholds: Thresholds) -> bool:
    """Tell if a robot may enter one more corridor: at its end its own battery plan must not have taken over, and it
    must still come to a dock with a reserve. Else it goes to a dock now, from where it is sure to come to one."""
    rates = charge.rates
    there = leg + to_dock + Use(0.0, HELD_UP_S)
    needed = max(thresholds.low + rates.at_most(leg), thresholds.critical + rates.at_most(there))
    return charge.ratio >= needed
