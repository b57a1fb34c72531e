"""Which robot fetches which order: decided by the map, the charge, and who has waited longest."""

from datetime import UTC, datetime, timedelta
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.dispatch.choice import (
    ENOUGH_CHARGE,
    Assignment,
    IdleRobot,
    WaitingOrder,
    choose_robots,
    has_enough_charge,
    why_nobody_comes,
)
from app.dispatch.waiting_work import counts_since
from app.models import Priority
from maps import shortest_route
from maps.ways import Ways
from tests.plain_maps import plain_map

TRACK = Ways(plain_map("test_track"))
MAP = plain_map("carleton")
CARLETON = Ways(MAP)


def robot(name: str, post: str | None, battery_ratio: float | None = 0.9) -> IdleRobot:
    return IdleRobot(name, post, battery_ratio)


def test_the_nearest_robot_fetches_the_order_that_waited_longest() -> None:
    waiting = [WaitingOrder("old", "post1"), WaitingOrder("new", "post5")]
    robots = [robot("r1", "post4"), robot("r2", "post2"), robot("r3", "post5")]
    assert choose_robots(waiting, robots, TRACK) == [Assignment("old", "r2"), Assignment("new", "r3")]


def test_nearest_means_by_corridor_and_not_through_the_wall() -> None:
    """post5 is 2 m from post1 through the wall and 6 m by corridor; post4 is 6 m too, post3 only 4 m."""
    robots = [robot("a", "post5"), robot("b", "post3")]
    assert choose_robots([WaitingOrder("o", "post1")], robots, TRACK) == [Assignment("o", "b")]


def test_a_robot_without_charge_is_left_to_charge_and_so_is_one_that_has_not_said() -> None:
    waiting = [WaitingOrder("o", "post1")]
    low, unknown, far = robot("low", "post1", 0.2), robot("unknown", "post1", None), robot("far", "post4", 0.5)
    assert choose_robots(waiting, [low, unknown, far], TRACK) == [Assignment("o", "far")]
    assert choose_robots(waiting, [low, unknown], TRACK) == []


@pytest.mark.parametrize("post", [None, "post_of_another_map"])
def test_a_robot_whose_place_is_not_known_is_the_last_choice_but_a_choice(post: str | None) -> None:
    waiting = [WaitingOrder("o", "post1")]
    assert choose_robots(waiting, [robot("lost", post), robot("far", "post4")], TRACK) == [Assignment("o", "far")]
    assert choose_robots(waiting, [robot("lost", post)], TRACK) == [Assignment("o", "lost")]


def test_nothing_waiting_or_no_robot_free_is_nothing_to_do() -> None:
    assert choose_robots([], [robot("r1", "post1")], TRACK) == []
    assert choose_robots([WaitingOrder("o", "post1")], [], TRACK) == []


def test_a_reassigned_order_goes_with_another_robot_or_with_the_one_that_was_named() -> None:
    robots = [robot("near", "post1"), robot("far", "post4")]
    anybody_else = WaitingOrder("o", "post1", avoided="near")
    assert choose_robots([anybody_else], robots, TRACK) == [Assignment("o", "far")]
    assert choose_robots([anybody_else], robots[:1], TRACK) == []
    named = WaitingOrder("o", "post1", wanted="far")
    assert choose_robots([named, WaitingOrder("p", "post1")], robots, TRACK) == [
        Assignment("o", "far"),
        Assignment("p", "near"),
    ]


def test_an_order_that_waits_for_its_robot_holds_up_no_other() -> None:
    waiting = [WaitingOrder("picky", "post1", wanted="r9"), WaitingOrder("next", "post1")]
    assert choose_robots(waiting, [robot("r1", "post1")], TRACK) == [Assignment("next", "r1")]


def test_priority_is_a_head_start_so_that_no_order_waits_for_ever() -> None:
    nine = datetime(2026, 1, 5, 9, tzinfo=UTC)
    later = nine + timedelta(minutes=29)
    much_later = nine + timedelta(minutes=31)
    assert counts_since(later, Priority.HIGH) < counts_since(nine, Priority.NORMAL)
    assert counts_since(much_later, Priority.HIGH) > counts_since(nine, Priority.NORMAL)
    assert counts_since(nine, Priority.LOW) > counts_since(later, Priority.NORMAL)


posts = st.sampled_from(sorted(MAP.posts))
fleets = st.lists(
    st.builds(IdleRobot, st.sampled_from([f"r{n}" for n in range(9)]), posts, st.floats(0, 1) | st.none()),
    unique_by=lambda one: one.name,
    max_size=8,
)


@given(st.lists(posts, max_size=5), fleets, st.randoms())
def test_the_chosen_robot_is_able_and_no_able_one_is_nearer_however_the_fleet_is_listed(
    from_posts: list[str], fleet: list[IdleRobot], random: Random
) -> None:
    waiting = [WaitingOrder(f"o{number}", post) for number, post in enumerate(from_posts)]
    chosen = choose_robots(waiting, fleet, CARLETON)
    able = {one.name: one for one in fleet if has_enough_charge(one)}
    assert len(chosen) == min(len(waiting), len(able))
    assert [one.order_id for one in chosen] == [one.id for one in waiting[: len(chosen)]]
    for order, one in zip(waiting, chosen, strict=False):
        ways_m = {name: shortest_route(MAP, r.post or "", order.from_post).length_m for name, r in able.items()}
        assert ways_m[one.robot] == min(ways_m.values())
        assert (able.pop(one.robot).battery_ratio or 0) >= ENOUGH_CHARGE
    shuffled = list(fleet)
    random.shuffle(shuffled)
    assert choose_robots(waiting, shuffled, CARLETON) == chosen


def test_the_reason_for_waiting_is_said_in_words() -> None:
    assert "No robot is connected" in why_nobody_comes([], 0)
    assert "busy" in why_nobody_comes([], 2)
    assert "that is to fetch it" in why_nobody_comes([robot("r1", "post1")], 1)
    assert "charging" in why_nobody_comes([robot("r1", "post1", 0.1)], 1)
