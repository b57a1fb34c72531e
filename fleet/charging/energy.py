"""The energy that driving and standing cost one robot, learned from what it has spent.

Two figures, per metre and per second, found by a Kalman filter: it weighs what is assumed against what was seen, knows
how sure it is of each, and follows a pack that wears. What is accepted goes by a quantile, never by the mean: its
distance from the mean corrects itself, until it is exceeded as seldom as it should be.
"""

from dataclasses import dataclass, replace
from math import sqrt
from typing import Final

AT_MOST_SHARE: Final = 0.98
"""`at_most` should hold for so many stretches."""
LEAST_SPENT: Final = 0.02
"""A stretch that costs less teaches nothing: charges are told in whole percents."""

_ASSUMED_VAR: Final = 0.25**2
_WEAR_VAR: Final = 0.007**2
"""By so much (squared, relative) a robot may have changed from one stretch to the next."""
_READING_VAR: Final = 0.005**2
_SPREAD_BOUNDS: Final = (5e-5, 1e-2)
_SPREAD_WEIGHT: Final = 0.05
_MARGIN_BOUNDS: Final = (1.6, 6.0)
_MARGIN_STEP: Final = 0.3
_FACTOR_BOUNDS: Final = (0.2, 5.0)
_OUTLIER: Final = 4.0


@dataclass(frozen=True, slots=True)
class Use:
    """A way and the time that it takes, waits included."""

    way_m: float = 0.0
    time_s: float = 0.0

    def __add__(self, other: "Use") -> "Use":
        return Use(self.way_m + other.way_m, self.time_s + other.time_s)


@dataclass(frozen=True, slots=True)
class Rates:
    """The rates of one robot. `per_m` is for driving alone, `per_s` for every second, driven or stood; both are what
    was assumed, and `driving` and `standing` are what has turned out to be the factors of them."""

    per_m: float
    per_s: float
    driving: float = 1.0
    standing: float = 1.0
    driving_var: float = _ASSUMED_VAR
    both_var: float = 0.0
    standing_var: float = _ASSUMED_VAR
    spread: float = 5e-4
    """Variance of what a stretch costs, for each share of charge that it costs."""
    margin: float = 2.5
    stretches: int = 0

    def expected(self, use: Use) -> float:
        driven, stood = self._assumed(use)
        return self.driving * driven + self.standing * stood

    def at_most(self, use: Use) -> float:
        """Return the cost that is exceeded one time in fifty."""
        return self.expected(use) + self.margin * sqrt(self._unsure_var(use) + self.spread * self.expected(use))

    def learned(self, use: Use, spent: float) -> "Rates":
        """After a stretch on which so much was spent and nothing charged; what is too short to tell changes nothing."""
        if self.expected(use) < LEAST_SPENT / 2 or max(spent, self.expected(use)) < LEAST_SPENT:
            return self
        unsure_var = self._unsure_var(use)
        var = unsure_var + self.spread * self.expected(use) + _READING_VAR
        off = spent - self.expected(use)
        kept = max(-_OUTLIER * sqrt(var), min(_OUTLIER * sqrt(var), off))
        return replace(
            self._corrected(use, kept, var),
            spread=self._spread_after(use, kept**2 - unsure_var - _READING_VAR),
            margin=self._margin_after(off / sqrt(var)),
            stretches=self.stretches + 1,
        )

    def _assumed(self, use: Use) -> tuple[float, float]:
        return self.per_m * use.way_m, self.per_s * use.time_s

    def _unsure_var(self, use: Use) -> float:
        driven, stood = self._assumed(use)
        return driven**2 * self.driving_var + 2 * driven * stood * self.both_var + stood**2 * self.standing_var

    def _corrected(self, use: Use, off: float, var: float) -> "Rates":
        driven, stood = self._assumed(use)
        for_driving = self.driving_var * driven + self.both_var * stood
        for_standing = self.both_var * driven + self.standing_var * stood
        return replace(
            self,
            driving=_within(self.driving + for_driving * off / var, _FACTOR_BOUNDS),
            standing=_within(self.standing + for_standing * off / var, _FACTOR_BOUNDS),
            driving_var=min(self.driving_var - for_driving**2 / var + _WEAR_VAR, _ASSUMED_VAR),
            both_var=self.both_var - for_driving * for_standing / var,
            standing_var=min(self.standing_var - for_standing**2 / var + _WEAR_VAR, _ASSUMED_VAR),
        )

    def _spread_after(self, use: Use, seen_var: float) -> float:
        seen = max(0.0, seen_var) / self.expected(use)
        return _within(self.spread + _SPREAD_WEIGHT * (seen - self.spread), _SPREAD_BOUNDS)

    def _margin_after(self, off: float) -> float:
        is_exceeded = float(off > self.margin)
        return _within(self.margin + _MARGIN_STEP * (is_exceeded - (1 - AT_MOST_SHARE)), _MARGIN_BOUNDS)


def assumed_rates(drive_s: float, stand_s: float, speed_m_s: float) -> Rates:
    """Of a robot that nothing is known of: how long a full pack lasts it when it drives, and when it only stands."""
    per_s = 1.0 / stand_s
    return Rates((1.0 / drive_s - per_s) / speed_m_s, per_s)


def _within(value: float, bounds: tuple[float, float]) -> float:
    return max(bounds[0], min(bounds[1], value))
