"""Intervals: three quantiles in seconds."""

from collections.abc import Sequence
from typing import Final, NamedTuple

LOW, MIDDLE, HIGH = 0.1, 0.5, 0.9
SHARES: Final = (LOW, MIDDLE, HIGH)


class Interval(NamedTuple):
    """Of ten truths one lies below `p10_s`, five below `p50_s`, nine below `p90_s`."""

    p10_s: float
    p50_s: float
    p90_s: float

    def holds(self, truth_s: float) -> bool:
        """Tell if the truth came about as people were told."""
        return self.p10_s <= truth_s <= self.p90_s


def quantile(ordered: Sequence[float], share: float) -> float:
    """Between the two values that lie next to it; of values in order, at least one."""
    place = share * (len(ordered) - 1)
    below = int(place)
    above = min(below + 1, len(ordered) - 1)
    return ordered[below] + (place - below) * (ordered[above] - ordered[below])


def interval_of(values: Sequence[float]) -> Interval:
    """The three quantiles of draws, or of what was seen."""
    ordered = sorted(values)
    return Interval(*(quantile(ordered, share) for share in SHARES))


def around(middle_s: float) -> Interval:
    """Of something that no draws can be made for, as what robots will be given next: from half to twice as long. That
    is assumed."""
    return Interval(middle_s / 2, middle_s, 2 * middle_s)


def pinball_s(told: Interval, truth_s: float) -> float:
    """The usual loss of quantiles, mean of the three: least, in the long run, for the right ones."""
    losses = (max(share * (truth_s - at), (share - 1) * (truth_s - at)) for share, at in zip(SHARES, told, strict=True))
    return sum(losses) / len(SHARES)
