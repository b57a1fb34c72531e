"""When a standing order comes round: a local time on some weekdays, as moments in UTC. Pure; one moment a day at most.

Where clocks are put forward and the time does not exist, it is taken as the time that the old offset would give (02:30
becomes 03:30); where they are put back and it exists twice, it is the first.
"""

from collections.abc import Collection
from dataclasses import dataclass
from datetime import UTC, date, datetime, time, timedelta
from zoneinfo import ZoneInfo


@dataclass(frozen=True)
class Recurrence:
    """`weekdays` count from 0 (Monday); `until` is the last local day, None: for ever."""

    weekdays: Collection[int]
    at: time
    zone: ZoneInfo
    until: date | None = None


def moment_on(recurrence: Recurrence, day: date) -> datetime:
    """The moment of this local day, in UTC."""
    local = datetime.combine(day, recurrence.at, recurrence.zone)
    return local.astimezone(UTC)


def day_of(recurrence: Recurrence, moment: datetime) -> date:
    """The local day that a moment of `next_after` belongs to.

    A time that does not exist may come to lie on the next day by the clock: it still belongs to its own.
    """
    day = moment.astimezone(recurrence.zone).date()
    return day if moment_on(recurrence, day) == moment else day - timedelta(days=1)


def next_after(recurrence: Recurrence, now: datetime) -> datetime | None:
    """The first moment after `now`; None if there is none any more."""
    day = now.astimezone(recurrence.zone).date() - timedelta(days=1)
    for _ in range(9):  # yesterday to a week from now
        if recurrence.until is not None and day > recurrence.until:
            return None
        if day.weekday() in recurrence.weekdays and (moment := moment_on(recurrence, day)) > now:
            return moment
        day += timedelta(days=1)
    return None
