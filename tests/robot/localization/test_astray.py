"""Gone into the wrong corridor at a crossing: noticed by the way the robot looks, before it is far in."""

import math
from collections.abc import Iterator
from pathlib import Path

import pytest

from robot.localization.astray import really_towards
from robot.mission.store import Store
from tests.plain_maps import plain_map
from tests.robot.agent.walk import Walk

TRACK = plain_map("test_track")


@pytest.fixture
def walk(tmp_path: Path) -> Iterator[Walk]:
    """At post3, having come from post4: post5 lies ahead, post2 to the left."""
    store = Store(tmp_path / "robot.db")
    walk = Walk(store)
    walk.look()
    walk.navigator.place("post4", "post3")
    walk.drives_to("post3")
    walk.navigator.destination = "post2"
    yield walk
    store.close()


def turn_and_follow(walk: Walk, turned_deg: float, rolled_mm: float = 200.0) -> None:
    walk.body.turns(math.radians(turned_deg))
    walk.look()
    walk.navigator.turned()
    walk.navigator.leave()
    walk.body.follows_line()
    walk.body.rolls(rolled_mm)
    walk.look()


@pytest.mark.parametrize("turned_deg", [90, 75, 110])
def test_a_turn_as_meant_is_not_doubted(walk: Walk, turned_deg: float) -> None:
    turn_and_follow(walk, turned_deg)
    assert (walk.navigator.astray, walk.navigator.towards) == (None, "post2")


def test_a_turn_that_met_the_line_ahead_is_noticed_and_the_place_is_known(walk: Walk) -> None:
    walk.body.turns(math.radians(50))  # the tape of post5, met from beside the post: taken for that of post2
    walk.look()
    walk.navigator.turned()
    walk.navigator.leave()
    assert walk.navigator.towards == "post2"
    walk.body.follows_line(math.radians(-45))  # straightened up along it
    walk.body.rolls(200.0)
    walk.look()
    assert (walk.navigator.astray, walk.navigator.towards) == ("post5", "post5")


def test_back_at_the_post_it_knows_which_way_it_looks(walk: Walk) -> None:
    test_a_turn_that_met_the_line_ahead_is_noticed_and_the_place_is_known(walk)
    walk.turns("behind")
    assert (walk.navigator.astray, walk.navigator.towards) == (None, "post3")
    walk.body.rolls(200.0)
    walk.look()
    assert walk.navigator.at == "post3"
    assert walk.navigator.way() == "right", "from post5 it looks south, and post2 lies in the west"


def test_the_marker_of_the_granted_corridor_says_that_the_compass_was_wrong(walk: Walk) -> None:
    test_a_turn_that_met_the_line_ahead_is_noticed_and_the_place_is_known(walk)  # by wheels that slipped in the turn
    walk.body.rolls(1500.0)
    walk.body.sees("post2")
    walk.look()
    assert (walk.navigator.astray, walk.navigator.towards) == (None, "post2")
    assert "foreign_marker" not in walk.missions.held.faults


def test_no_other_marker_of_the_crossing_is_believed_when_astray(walk: Walk) -> None:
    test_a_turn_that_met_the_line_ahead_is_noticed_and_the_place_is_known(walk)
    walk.body.rolls(1500.0)
    walk.body.sees("post4")
    walk.look()
    assert (walk.navigator.astray, walk.navigator.towards) == ("post5", "post5")


def test_without_knowing_which_way_it_looked_it_doubts_nothing(store: Store) -> None:
    walk = Walk(store)
    walk.look()
    walk.navigator.place("post3", None)
    turn_and_follow(walk, 30)
    assert walk.navigator.astray is None


@pytest.mark.parametrize(
    ("looks_deg", "really"), [(180, None), (150, None), (135, None), (100, "post5"), (-80, "post4"), (0, None)]
)
def test_only_what_is_surely_another_corridor_counts(looks_deg: float, really: str | None) -> None:
    assert really_towards(TRACK, "post3", "post2", math.radians(looks_deg)) == really


def test_out_of_its_dock_it_knows_by_its_compass_which_line_it_took(store: Store) -> None:
    walk = Walk(store, home="uc", campus=plain_map("carleton"))
    walk.body.battery(0.5, docked=True)
    walk.look()
    walk.body.battery(0.5)
    walk.body.turns(math.pi)
    walk.look()
    walk.navigator.undocked()
    walk.body.turns(math.radians(-90))
    walk.look()
    walk.navigator.turned()
    walk.navigator.leave()
    assert walk.navigator.towards == "canal"
    walk.body.follows_line(math.radians(90))  # a search brought it onto the line to the west
    walk.body.rolls(200.0)
    walk.look()
    assert (walk.navigator.astray, walk.navigator.towards) == ("azrieli", "azrieli")


def test_a_marker_where_another_corridor_ends_tells_on_the_way_back_which_line_it_took(walk: Walk) -> None:
    walk.turns("left")
    walk.navigator.leave()
    assert walk.navigator.towards == "post2"
    walk.body.rolls(1700.0)
    walk.body.sees("post5")
    walk.look()
    walk.body.rolls(450.0)
    walk.look()
    assert (walk.navigator.at, walk.navigator.towards) == (None, "post2"), "one alone is not believed"
    walk.turns("behind")
    assert (walk.navigator.came_from, walk.navigator.towards) == ("post5", "post3")


def test_a_search_beside_the_post_in_a_turn_does_not_leave_it(walk: Walk) -> None:
    """It would be taken for a way into the corridor that it happens to look along, and for one back from there."""
    walk.navigator.begin_turn()
    walk.body.turns(math.radians(130))  # beyond the line that it was to meet
    walk.body.does("turn")
    walk.look()
    walk.body.rolls(150.0)
    walk.look()
    assert (walk.navigator.at, walk.navigator.towards) == ("post3", None)
    walk.body.turns(math.radians(-40))
    walk.look()
    walk.navigator.turned()
    walk.navigator.leave()
    assert walk.navigator.towards == "post2"


def test_rolled_on_beyond_its_post_and_backed_up_it_still_knows_which_way_it_looks(walk: Walk) -> None:
    way = walk.navigator.way()
    walk.body.follows_line()
    walk.body.rolls(250.0)  # its base did not answer
    walk.look()
    assert walk.navigator.towards == "post5"
    walk.body.rolls(-250.0)
    walk.look()
    walk.navigator.reached("post3")
    assert (walk.navigator.at, walk.navigator.way()) == ("post3", way) == ("post3", "left")


@pytest.mark.parametrize("skill", ["find_line", "dock"])
def test_whoever_looks_around_a_post_is_still_there(walk: Walk, skill: str) -> None:
    walk.body.does(skill)
    walk.body.rolls(250.0)
    walk.look()
    assert walk.navigator.at == "post3"
    walk.body.sees("post3")
    walk.look()
    assert "foreign_marker" not in walk.missions.held.faults


@pytest.mark.parametrize("skill", ["dock", "find_line", "turn"])
def test_a_search_in_curves_at_a_post_knows_which_way_it_looks(walk: Walk, skill: str) -> None:
    assert walk.navigator.way() == "left"
    walk.body.follows_line(math.radians(120))  # in a curve
    walk.body.does(skill)
    walk.look()
    walk.body.turns(math.radians(-120))
    walk.look()
    assert walk.navigator.way() == "left"


def test_a_search_in_curves_on_the_way_out_of_its_dock_knows_which_way_it_looks(store: Store) -> None:
    walk = Walk(store)
    walk.body.battery(0.5, docked=True)
    walk.look()
    walk.navigator.leave()
    walk.body.battery(0.5)
    walk.body.does("undock")
    walk.body.rolls(-300.0)
    walk.look()
    walk.body.turns(math.radians(150))  # it was bumped, and meets no line
    walk.look()
    walk.body.follows_line(math.radians(210))
    walk.body.does("undock")
    walk.look()
    walk.body.turns(math.radians(-180))
    walk.look()
    walk.navigator.undocked()
    walk.navigator.destination = "post3"
    assert (walk.navigator.at, walk.navigator.way()) == ("post5", "forward")


def test_started_anew_it_knows_which_way_it_looks_after_a_search_in_curves(store: Store) -> None:
    before = Walk(store)
    before.look()
    before.navigator.place("post4", "post3")
    before.drives_to("post3")
    walk = Walk(store)
    walk.navigator.destination = "post2"
    walk.look()
    assert walk.navigator.way() == "left"
    walk.body.follows_line(math.radians(120))
    walk.body.does("dock")
    walk.look()
    assert walk.navigator.way() != "left"
    walk.body.turns(math.radians(-120))
    walk.look()
    assert walk.navigator.way() == "left"
