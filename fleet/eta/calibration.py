"""Estimates that put themselves right: intervals are stretched and shifted until as many truths fall inside as should.

Each error is measured in widths of the interval that was worked out (1: just at its p90, -1: just at its p10). What is
told has its ends where the latest errors say (conformal prediction), and the shares that are asked of them move a
little against each miss (adaptive conformal inference, Gibbs and Candès 2021), so that coverage holds in the long run
even when the errors of tomorrow are not those of today.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from statistics import NormalDist
from typing import Final

from fleet.eta.intervals import HIGH, LOW, MIDDLE, Interval, quantile

REMEMBERED: Final = 200
"""Latest errors."""
ASSUMED_ERRORS: Final = 20
STEP: Final = 0.01
"""So much a share moves against a miss."""
FARTHEST: Final = 0.09
"""So far at most from where it began."""
NARROWEST: Final = 0.02
"""No interval is narrower than this share of its middle to either side; nor than a second."""


def _assumed_errors() -> list[float]:
    """As if the intervals were right: of a normal distribution, a tenth beyond 1."""
    usual, count = NormalDist(), ASSUMED_ERRORS
    at_high = usual.inv_cdf(HIGH)
    return [usual.inv_cdf((place + 1) / (count + 1)) / at_high for place in range(count)]


class Basis(StrEnum):
    """The basis of an estimate."""

    PLACED = "placed"
    """How long the parts of an order have lately taken: told when it is placed."""
    UNDER_WAY = "under_way"
    """The schedule that is carried out: told of an order that a robot has."""


@dataclass
class Calibration:
    """The latest errors, and which of them bound the interval that is told."""

    low: float = LOW
    high: float = HIGH
    _errors: deque[float] = field(default_factory=lambda: deque(_assumed_errors(), REMEMBERED))
    _learned: int = 0

    def corrected(self, raw: Interval) -> Interval:
        """Return the interval to tell for this one: p10, p50 and p90 where the latest errors put them."""
        ordered = sorted(self._errors)
        low, middle, high = (_at(raw, _bound(ordered, share)) for share in (self.low, MIDDLE, self.high))
        return Interval(max(0.0, low), max(0.0, middle), max(0.0, high))

    def learn(self, raw: Interval, told: Interval, truth_s: float) -> None:
        """It took so long. What this means for the next estimates."""
        if self._learned < ASSUMED_ERRORS:
            self._errors.popleft()
        self._errors.append(_error(raw, truth_s))
        self._learned += 1
        self.low = _near(LOW, self.low + STEP * (LOW - (truth_s < told.p10_s)))
        self.high = _near(HIGH, self.high + STEP * ((truth_s > told.p90_s) - (1.0 - HIGH)))


def _bound(ordered: Sequence[float], share: float) -> float:
    """Below which the *next* error lies with this probability. Of few errors that is further out than their own
    quantile: of 20 the next one lies beyond it in more than one case of eight, not of ten."""
    return quantile(ordered, min(1.0, max(0.0, (share * (len(ordered) + 1) - 1) / (len(ordered) - 1))))


def _widths(raw: Interval) -> tuple[float, float]:
    least_s = max(1.0, NARROWEST * raw.p50_s)
    return max(raw.p50_s - raw.p10_s, least_s), max(raw.p90_s - raw.p50_s, least_s)


def _error(raw: Interval, truth_s: float) -> float:
    below_s, above_s = _widths(raw)
    off_s = truth_s - raw.p50_s
    return off_s / (below_s if off_s < 0 else above_s)


def _at(raw: Interval, error: float) -> float:
    below_s, above_s = _widths(raw)
    return raw.p50_s + error * (below_s if error < 0 else above_s)


def _near(where: float, wanted: float) -> float:
    return min(max(wanted, where - FARTHEST), where + FARTHEST)
