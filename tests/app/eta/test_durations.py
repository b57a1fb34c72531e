"""Durations of legs and services, learned from observations."""

from random import Random

import pytest

from fleet.eta.durations import ASSUMED, KEPT, Durations, Kind, Thing
from fleet.eta.intervals import interval_of

HERE = Thing(Kind.CORRIDOR, "a b", 100.0)
THERE = Thing(Kind.CORRIDOR, "b c", 400.0)


def test_before_anything_was_seen_the_map_is_all_there_is() -> None:
    assert Durations().quantile_s(HERE, 0.5) == pytest.approx(100.0)
    assert Durations().quantile_s(THERE, 0.5) == pytest.approx(400.0)


def test_what_was_seen_counts_more_with_each_time() -> None:
    durations, medians = Durations(), []
    for _ in range(12):
        durations.observe(HERE, 150.0)
        medians.append(durations.quantile_s(HERE, 0.5))
    assert medians == sorted(medians)
    assert medians[-1] == 150.0


def test_slow_robots_are_expected_to_be_slow_where_they_have_never_been() -> None:
    durations = Durations()
    for _ in range(len(ASSUMED[Kind.CORRIDOR])):
        durations.observe(HERE, 200.0)
    assert durations.quantile_s(THERE, 0.5) == 800.0
    assert durations.quantile_s(Thing(Kind.LOAD, "attended", 120.0), 0.5) < 200.0, "another kind of thing"


def test_what_has_changed_is_known_after_a_while_and_what_was_before_forgotten() -> None:
    durations = Durations()
    for _ in range(500):
        durations.observe(HERE, 300.0)
    for _ in range(KEPT):
        durations.observe(HERE, 90.0)
    assert durations.quantile_s(HERE, 0.9) == 90.0


def test_draws_come_as_often_as_the_quantiles_say() -> None:
    durations, rng = Durations(), Random(1)
    for _ in range(60):
        durations.observe(HERE, rng.uniform(80.0, 120.0))
    drawn = interval_of([durations.draw_s(HERE, rng) for _ in range(4000)])
    for told_s, share in zip(drawn, (0.1, 0.5, 0.9), strict=True):
        assert durations.quantile_s(HERE, share) == pytest.approx(told_s, abs=3.0)


def test_what_lasts_is_expected_to_last_longer_than_it_has() -> None:
    durations, rng = Durations(), Random(1)
    for _ in range(30):
        durations.observe(HERE, 100.0)
    assert durations.draw_s(HERE, rng, over_s=90.0) > 90.0
    assert durations.draw_s(HERE, rng, over_s=5000.0) == 6000.0, "longer than anything ever was"


@pytest.mark.parametrize("seconds", [-1.0, 5 * 3600.0])
def test_a_clock_that_was_set_and_a_night_in_a_corridor_teach_nothing(seconds: float) -> None:
    durations = Durations()
    assert not durations.observe(HERE, seconds)
    assert (durations.seen(Kind.CORRIDOR), durations.version) == (0, 0)
