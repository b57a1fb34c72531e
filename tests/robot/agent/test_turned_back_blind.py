"""A robot that turns back near to the post behind it has passed the marker of that post on its way in."""

import pytest

from robot.localization.place import Between
from robot.localization.steps import SURELY_SEEN_MM, turned_round
from robot.mission.store import Store
from tests.robot.agent.walk import Walk


def on_its_way(walk: Walk, rolled_mm: float) -> None:
    walk.navigator.place("post1", "post2")
    walk.look()
    walk.navigator.leave()
    walk.body.rolls(rolled_mm)
    walk.look()


def test_switched_on_on_its_way_and_turned_back_it_does_not_know_how_far_the_post_is(walk: Walk, store: Store) -> None:
    on_its_way(walk, 700.0)
    again = Walk(store)
    again.look()
    assert again.navigator.doubted is None, "ahead the next marker tells"
    again.body.rolls(50.0)
    again.look()
    again.navigator.turned()
    assert (again.navigator.doubted, again.navigator.look_back_mm) == ("post1", 0.0)
    again = Walk(store)
    again.look()
    assert (again.navigator.doubted, again.navigator.look_back_mm) == ("post1", 0.0), "nor after another power cut"
    again.body.sees("post1")
    again.look()
    assert again.navigator.doubted is None


def test_it_knows_that_the_marker_is_ahead_once_it_has_driven_farther_than_that_is_seen(
    walk: Walk, store: Store
) -> None:
    on_its_way(walk, 300.0)
    again = Walk(store)
    again.look()
    again.body.rolls(SURELY_SEEN_MM + 10.0)
    again.look()
    again.navigator.turned()
    assert (again.navigator.doubted, again.navigator.goes_by_length) == (None, False)


def test_turned_back_near_to_the_post_it_goes_by_its_wheels_and_not_after_a_power_cut(walk: Walk, store: Store) -> None:
    on_its_way(walk, 500.0)
    walk.navigator.turned()
    walk.body.rolls(100.0)
    walk.look()
    assert (walk.navigator.doubted, walk.navigator.goes_by_length) == (None, True)
    assert walk.navigator.way_left_mm == pytest.approx(400.0, abs=1.0)
    again = Walk(store)
    again.look()
    assert (again.navigator.doubted, again.navigator.look_back_mm) == ("post1", 0.0)


def test_put_down_before_a_marker_it_knows_the_way_back_by_the_map(walk: Walk) -> None:
    (corridor,) = [one for one in walk.navigator.campus.corridors if {one.a, one.b} == {"post1", "post2"}]
    place = Between(corridor, "post1", "post2", None, 5_400.0, by_marker=True)
    back = turned_round(place, 5_000.0)
    assert back.ahead_mm == pytest.approx(5_000.0 + 1000 * corridor.length_m - 400.0)
    assert not back.doubted
