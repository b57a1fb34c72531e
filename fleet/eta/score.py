"""Scores of estimates, by the truths that came."""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from statistics import fmean
from typing import Final, NamedTuple

from fleet.eta.intervals import MIDDLE, Interval, pinball_s, quantile

SCORED: Final = 500
"""Latest truths that count."""


class Truth(NamedTuple):
    """One truth: what was told, what the lengths on the map alone would have told, and what came."""

    told: Interval
    by_map: Interval
    seconds: float


@dataclass(frozen=True)
class Score:
    """`inside`: share of truths between p10 and p90. `median_error`: of the middle, as a share of the truth."""

    count: int
    inside: float
    below: float
    above: float
    median_error: float
    median_error_by_map: float
    pinball_s: float
    pinball_by_map_s: float


@dataclass
class ScoreBoard:
    """The latest truths."""

    _truths: deque[Truth] = field(default_factory=lambda: deque(maxlen=SCORED))

    def add(self, truth: Truth) -> None:
        self._truths.append(truth)

    def score(self) -> Score | None:
        """None as long as nothing has come."""
        return score_of(self._truths) if self._truths else None


def score_of(truths: Sequence[Truth]) -> Score:
    """Of some truths, at least one."""
    return Score(
        count=len(truths),
        inside=fmean(one.told.holds(one.seconds) for one in truths),
        below=fmean(one.seconds < one.told.p10_s for one in truths),
        above=fmean(one.seconds > one.told.p90_s for one in truths),
        median_error=_median([_error(one.told, one.seconds) for one in truths]),
        median_error_by_map=_median([_error(one.by_map, one.seconds) for one in truths]),
        pinball_s=fmean(pinball_s(one.told, one.seconds) for one in truths),
        pinball_by_map_s=fmean(pinball_s(one.by_map, one.seconds) for one in truths),
    )


def _error(told: Interval, truth_s: float) -> float:
    return abs(told.p50_s - truth_s) / max(truth_s, 1.0)


def _median(values: Sequence[float]) -> float:
    return quantile(sorted(values), MIDDLE)
