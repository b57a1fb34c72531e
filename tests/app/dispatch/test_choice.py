"""Which robot fetches which order: decided by the map, the charge, and who has waited longest."""

from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.dispatch.choice import (
    ENOUGH_CHARGE,
    Assignment,
    IdleRobot,
    WaitingOrder,
    choose_robot,
    has_enough_charge,
    why_nobody_comes,
)
from maps import builtin_map, shortest_route

TRACK = builtin_map("test_track")
CARLETON = builtin_map("carleton")


def robot(name: str, post: str | None, battery_ratio: float | None = 0.9) -> IdleRobot:
    return IdleRobot(name, post, battery_ratio)


def test_the_nearest_robot_fetches_the_order_that_waited_longest() -> None:
    waiting = [WaitingOrder("old", "post1"), WaitingOrder("new", "post5")]
    robots = [robot("r1", "post4"), robot("r2", "post2"), robot("r3", "post5")]
    assert choose_robot(waiting, robots, TRACK) == Assignment("old", "r2")


def test_nearest_means_by_corridor_and_not_through_the_wall() -> None:
    """post5 is 2 m from post1 through the wall and 6 m by corridor; post4 is 6 m too, post3 only 4 m."""
    assert choose_robot([WaitingOrder("o", "post1")], [robot("a", "post5"), robot("b", "post3")], TRACK) == Assignment(
        "o", "b"
    )


def test_a_robot_without_charge_is_left_to_charge_and_so_is_one_that_has_not_said() -> None:
    waiting = [WaitingOrder("o", "post1")]
    low, unknown, far = robot("low", "post1", 0.2), robot("unknown", "post1", None), robot("far", "post4", 0.5)
    assert choose_robot(waiting, [low, unknown, far], TRACK) == Assignment("o", "far")
    assert choose_robot(waiting, [low, unknown], TRACK) is None


@pytest.mark.parametrize("post", [None, "post_of_another_map"])
def test_a_robot_whose_place_is_not_known_is_the_last_choice_but_a_choice(post: str | None) -> None:
    waiting = [WaitingOrder("o", "post1")]
    assert choose_robot(waiting, [robot("lost", post), robot("far", "post4")], TRACK) == Assignment("o", "far")
    assert choose_robot(waiting, [robot("lost", post)], TRACK) == Assignment("o", "lost")


def test_nothing_waiting_or_nobody_free_is_nothing_to_do() -> None:
    assert choose_robot([], [robot("r1", "post1")], TRACK) is None
    assert choose_robot([WaitingOrder("o", "post1")], [], TRACK) is None


posts = st.sampled_from(sorted(CARLETON.posts))
fleets = st.lists(
    st.builds(IdleRobot, st.sampled_from([f"r{n}" for n in range(9)]), posts, st.floats(0, 1) | st.none()),
    unique_by=lambda one: one.name,
    max_size=8,
)


@given(st.lists(posts, max_size=5), fleets, st.randoms())
def test_whoever_is_chosen_is_able_and_nobody_able_is_nearer_however_the_fleet_is_listed(
    from_posts: list[str], fleet: list[IdleRobot], random: Random
) -> None:
    waiting = [WaitingOrder(f"o{number}", post) for number, post in enumerate(from_posts)]
    chosen = choose_robot(waiting, fleet, CARLETON)
    able = {one.name: one for one in fleet if has_enough_charge(one)}
    if chosen is None:
        assert not waiting or not able
        return
    ways_m = {
        name: shortest_route(CARLETON, one.post or "", waiting[0].from_post).length_m for name, one in able.items()
    }
    assert chosen.order_id == waiting[0].id
    assert ways_m[chosen.robot] == min(ways_m.values())
    assert (able[chosen.robot].battery_ratio or 0) >= ENOUGH_CHARGE
    shuffled = list(fleet)
    random.shuffle(shuffled)
    assert choose_robot(waiting, shuffled, CARLETON) == chosen


def test_the_reason_for_waiting_is_said_in_words() -> None:
    assert "No robot is connected" in why_nobody_comes([], 0)
    assert "busy" in why_nobody_comes([], 2)
    assert "charging" in why_nobody_comes([robot("r1", "post1", 0.1)], 1)
