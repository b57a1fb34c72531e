"""When standing orders come round: once on each of their days, through every change of clocks."""

from datetime import UTC, date, datetime, time, timedelta
from itertools import pairwise
from zoneinfo import ZoneInfo

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.orders.standing.recurrence import Recurrence, day_of, next_after

TORONTO = ZoneInfo("America/Toronto")
EVERY_DAY = frozenset(range(7))


def moments(recurrence: Recurrence, after: datetime, count: int) -> list[datetime]:
    found = []
    while len(found) < count and (moment := next_after(recurrence, after)) is not None:
        found.append(moment)
        after = moment
    return found


def test_the_local_time_stays_when_clocks_change() -> None:
    mornings = Recurrence(EVERY_DAY, time(9, 30), TORONTO)
    found = moments(mornings, datetime(2026, 3, 7, tzinfo=UTC), 3)
    assert [one.astimezone(TORONTO).time() for one in found] == [time(9, 30)] * 3
    assert found[1] - found[0] == timedelta(hours=23), "on 8 March an hour was missing"


def test_a_time_that_a_day_does_not_have_comes_round_once_all_the_same() -> None:
    nights = Recurrence(EVERY_DAY, time(2, 30), TORONTO)
    found = moments(nights, datetime(2026, 3, 7, 12, tzinfo=UTC), 2)
    assert [one.astimezone(TORONTO).time() for one in found] == [time(3, 30), time(2, 30)]
    assert [day_of(nights, one) for one in found] == [date(2026, 3, 8), date(2026, 3, 9)]


def test_a_time_that_a_day_has_twice_comes_round_once() -> None:
    nights = Recurrence(EVERY_DAY, time(1, 30), TORONTO)
    found = moments(nights, datetime(2026, 10, 31, 12, tzinfo=UTC), 2)
    assert [one.astimezone(TORONTO).date() for one in found] == [date(2026, 11, 1), date(2026, 11, 2)]
    assert found[0] == datetime(2026, 11, 1, 5, 30, tzinfo=UTC), "the first of the two"


def test_it_comes_round_on_its_last_day_and_not_after_it() -> None:
    mondays = Recurrence({0}, time(9), TORONTO, until=date(2026, 1, 12))
    found = moments(mondays, datetime(2026, 1, 1, tzinfo=UTC), 9)
    assert [one.astimezone(TORONTO).date() for one in found] == [date(2026, 1, 5), date(2026, 1, 12)]


ZONES = ("America/Toronto", "Europe/Berlin", "Australia/Lord_Howe", "America/St_Johns", "Asia/Tehran", "UTC")


@pytest.mark.parametrize("zone", ZONES)
@given(
    weekdays=st.frozensets(st.integers(0, 6), min_size=1),
    at=st.times().map(lambda one: one.replace(second=0, microsecond=0)),
    first=st.dates(date(2024, 1, 1), date(2027, 12, 31)),
)
@pytest.mark.slow
def test_each_of_its_days_has_one_moment_whenever_one_asks(
    zone: str, weekdays: frozenset[int], at: time, first: date
) -> None:
    recurrence = Recurrence(weekdays, at, ZoneInfo(zone))
    begin = datetime.combine(first, time(0), UTC)
    found = moments(recurrence, begin, 20)
    days = [day_of(recurrence, one) for one in found]
    assert all(one < two for one, two in pairwise(found))
    expected = [days[0] + timedelta(days=n) for n in range((days[-1] - days[0]).days + 1)]
    assert days == [day for day in expected if day.weekday() in weekdays], "none is left out, none comes twice"
    for one in found:
        assert next_after(recurrence, one - timedelta(microseconds=1)) == one
