"""When orders come, hour by hour of the week: learned, so that robots charge before they are wanted and not then."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Final

HOURS: Final = 168
"""Of a week."""
_WEIGHT: Final = 0.25
"""Of the last week beside those before it."""
_QUIET_SHARE: Final = 0.6
_HOUR: Final = timedelta(hours=1)


@dataclass
class Demand:
    """Orders of each hour of the week, as they are expected. `zone` is the caller's: hand it local times."""

    per_hour: list[float] = field(default_factory=lambda: [0.0] * HOURS)
    known: list[bool] = field(default_factory=lambda: [False] * HOURS)

    def learn(self, hour: datetime, orders: int) -> None:
        """So many orders came in the hour that began then."""
        at = _hour_of_week(hour)
        weight = _WEIGHT if self.known[at] else 1.0
        self.per_hour[at] += weight * (orders - self.per_hour[at])
        self.known[at] = True

    def expected(self, now: datetime, hours: int = 1) -> float:
        """In the hours from this one on. Of an hour that is not known yet the mean of those that are."""
        return sum(self._expected_at(now + ahead * _HOUR) for ahead in range(hours))

    def is_quiet(self, now: datetime, hours: int = 2) -> bool:
        """Tell if clearly less is to be done in these hours than usual. Nothing is known at first: then no hour is."""
        return self.expected(now, hours) < _QUIET_SHARE * hours * self._mean()

    def _expected_at(self, hour: datetime) -> float:
        at = _hour_of_week(hour)
        return self.per_hour[at] if self.known[at] else self._mean()

    def _mean(self) -> float:
        told = [rate for rate, is_known in zip(self.per_hour, self.known, strict=True) if is_known]
        return _mean_of(told)


def _mean_of(rates: Sequence[float]) -> float:
    return sum(rates) / len(rates) if rates else 0.0


def _hour_of_week(at: datetime) -> int:
    return at.weekday() * 24 + at.hour
