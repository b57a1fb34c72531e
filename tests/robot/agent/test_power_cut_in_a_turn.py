"""What the robot knows of its heading after a power cut in the middle of a turn."""

import math
from pathlib import Path

import pytest

from maps import read_map
from protocol.parts import Leg
from robot.mission.store import Store
from tests.robot.agent.walk import Walk
from tests.robot.fork import fork

QUARTER_COUNTS = round(235.0 * math.pi / 4 / (72.0 * math.pi / 508.8))
"""Of each wheel in a quarter turn on the spot."""
RESET = (9000, 9000)


def killed_in_a_turn(walk: Walk, store: Store, counted: tuple[int, int]) -> Walk:
    """At post2, where it came looking down; its wheels have counted so much further when it is started again."""
    walk.navigator.place("post1", "post2")
    walk.drives_to("post2")
    walk.navigator.destination = "post4"
    walk.body.counts(-32000, 32000)
    walk.look()
    walk.navigator.begin_turn()
    again = Walk(store)
    again.navigator.destination = "post4"
    again.body.counts(-32000 + counted[0], 32000 + counted[1] - 65536 * (counted[1] > 767))
    return again


@pytest.mark.parametrize(
    ("quarters", "way"), [(0.0, "left"), (1.0, "forward"), (2.0, "right"), (-1.0, "behind"), (-3.5, "forward")]
)
def test_killed_in_a_turn_it_knows_by_the_counts_of_its_base_which_way_it_looks(
    walk: Walk, store: Store, quarters: float, way: str
) -> None:
    counts = round(quarters * QUARTER_COUNTS)
    again = killed_in_a_turn(walk, store, (-counts, counts))
    assert again.navigator.doubted == "post2", "the base has not been heard"
    again.look()
    assert (again.navigator.at, again.navigator.way(), again.navigator.doubted) == ("post2", way, None)
    assert again.navigator.first_legs("post4") == (Leg(from_post="post2", to_post="post3"),)


@pytest.mark.parametrize("counted", [RESET, (-5 * QUARTER_COUNTS, 5 * QUARTER_COUNTS)], ids=["reset", "turned_on"])
def test_a_base_that_was_reset_or_turned_without_end_leaves_open_which_way_it_looks(
    walk: Walk, store: Store, counted: tuple[int, int]
) -> None:
    again = killed_in_a_turn(walk, store, counted)
    again.look()
    assert again.navigator.at == "post2"
    ways = {Leg(from_post="post2", to_post=post) for post in ("post1", "post3")}
    assert set(again.navigator.first_legs("post4")) == ways, "it may look anywhere: each corridor is asked for"


def test_a_power_cut_on_a_line_that_it_does_not_know_leaves_it_on_one_of_its_posts_lines(
    walk: Walk, store: Store
) -> None:
    again = killed_in_a_turn(walk, store, RESET)
    again.look()
    again.navigator.leave()
    again.body.rolls(700.0)
    again.look()
    for _ in range(2):  # however often it is killed there
        again = Walk(store)
        again.look()
        navigator = again.navigator
        assert (navigator.here, navigator.at, navigator.towards) == ("post2", None, None)
        assert navigator.looks_anywhere
    again.body.sees("post3")
    again.look()
    again = Walk(store)
    assert (again.navigator.here, again.navigator.doubted) == ("post2", "post3"), "its marker told which line it is on"


def turned_back_from_post3(walk: Walk) -> None:
    """At post2, where it came from post1, it went on towards post3, and turns round half way."""
    walk.navigator.place("post1", "post2")
    walk.drives_to("post2")
    walk.navigator.destination = "post3"
    walk.turns("left")
    walk.navigator.leave()
    walk.body.rolls(900.0)
    walk.look()
    walk.turns_round()


def test_back_at_a_post_it_knows_after_a_power_cut_that_it_looks_as_it_came_back(walk: Walk, store: Store) -> None:
    turned_back_from_post3(walk)
    walk.body.rolls(900.0)
    walk.look()
    assert walk.navigator.at == "post2"
    again = Walk(store)
    again.look()
    again.navigator.destination = "post3"
    assert (again.navigator.way(), again.navigator.doubted) == ("behind", None), "from post1 it would lie to its left"


def test_back_from_a_bay_it_does_not_take_itself_to_look_as_from_the_bay_beside_it(
    tmp_path: Path, store: Store
) -> None:
    campus = read_map(fork(tmp_path, 32.0, -25.0)).track
    walk = Walk(store, campus=campus)
    walk.navigator.place("b_bay2", "b")
    walk.drives_to("b")
    walk.body.rolls(300.0)
    walk.look()
    walk.navigator.destination = "b_bay1"
    walk.turns(str(walk.navigator.way()))
    walk.navigator.leave()
    walk.body.rolls(400.0)
    walk.look()
    walk.turns_round()
    walk.body.rolls(400.0)
    walk.look()
    assert walk.navigator.at == "b"
    again = Walk(store, campus=campus)
    again.look()
    again.navigator.destination = "a"
    assert math.degrees(again.navigator.aslant_rad) == pytest.approx(-32.0, abs=1.0), "from its other bay: 25 degrees"


def comes_back_to(walk: Walk, post: str) -> None:
    walk.body.rolls(600.0)
    walk.look()
    walk.body.sees(post)
    walk.look()
    walk.body.rolls(300.0)
    walk.look()


@pytest.mark.parametrize("killed", ["half way back", "before the crossing"])
def test_killed_on_its_way_back_it_knows_along_which_line_it_goes(walk: Walk, store: Store, killed: str) -> None:
    turned_back_from_post3(walk)
    walk.look()
    if killed == "before the crossing":
        walk.body.rolls(600.0)
        walk.look()
        walk.body.sees("post2")
        walk.look()
    again = Walk(store)
    again.navigator.destination = "post3"
    again.look()
    assert (again.navigator.here, again.navigator.towards) == ("post2", "post2")
    comes_back_to(again, "post2")
    assert (again.navigator.at, again.navigator.way(), again.navigator.doubted) == ("post2", "behind", None)


def test_killed_once_it_has_turned_round_twice_it_goes_where_it_was_going(walk: Walk, store: Store) -> None:
    turned_back_from_post3(walk)
    walk.look()
    walk.turns_round()
    again = Walk(store)
    again.look()
    assert (again.navigator.here, again.navigator.towards) == ("post2", "post3")


def test_back_at_a_post_and_not_knowing_how_it_looks_it_does_not_know_after_a_power_cut(
    walk: Walk, store: Store
) -> None:
    """It went into a line that it did not know."""
    killed_in_a_turn(walk, store, RESET)
    again = Walk(store)
    again.look()
    again.navigator.leave()
    again.body.rolls(700.0)
    again.look()
    again = Walk(store)
    again.look()
    comes_back_to(again, "post2")
    assert (again.navigator.at, again.navigator.looks_anywhere) == ("post2", True)
    once_more = Walk(store)
    once_more.look()
    assert (once_more.navigator.at, once_more.navigator.looks_anywhere) == ("post2", True)
