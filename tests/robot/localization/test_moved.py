"""Carried away and put down elsewhere: the next marker tells the navigator, and the navigator the agent."""

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from protocol.parts import Leg
from robot.drivers.interfaces import Sighting
from robot.localization.expected import hangs_beside_this_line
from robot.localization.facing import facing_by
from robot.mission.store import Store
from tests.plain_maps import plain_map
from tests.robot.agent.walk import Walk

TRACK = plain_map("test_track")
LEG = Leg(from_post="post1", to_post="post2")


@pytest.fixture
def walk(tmp_path: Path) -> Iterator[Walk]:
    store = Store(tmp_path / "robot.db")
    walk = Walk(store)
    walk.look()
    walk.navigator.place("post1", "post2")
    walk.missions.memory.grant([LEG])
    walk.missions.seen("post1")
    yield walk
    store.close()


def leave_and_lift(walk: Walk) -> None:
    walk.navigator.leave()
    walk.body.rolls(700.0)
    walk.look()
    walk.body.view = replace(walk.body.view, faults=frozenset({"wheel_drop"}))
    walk.look()
    assert (walk.navigator.at, walk.navigator.corridor) == (None, None), "in a person's hands it claims nothing"
    walk.body.view = replace(walk.body.view, faults=frozenset())
    walk.look()


def sees_and_rolls(walk: Walk, post: str) -> None:
    walk.body.sees(post)
    walk.look()
    walk.body.rolls(300.0)
    walk.look()


def test_two_markers_that_agree_say_that_it_was_moved(walk: Walk) -> None:
    walk.navigator.leave()
    walk.body.rolls(700.0)
    walk.look()
    sees_and_rolls(walk, "post3")
    assert (walk.navigator.moved, walk.navigator.at) == (None, None), "one alone may be a stranger's"
    assert walk.missions.held.grants == (LEG,)
    walk.body.rolls(1700.0)
    walk.look()
    sees_and_rolls(walk, "post4")
    assert (walk.navigator.moved, walk.navigator.at) == ("post4", "post4")
    assert walk.missions.held.grants == (), "it is not in that corridor any more"
    assert "foreign_marker" not in walk.missions.held.faults
    walk.navigator.destination = "post3"
    assert walk.navigator.way() == "behind", "post4 has one way in, so its marker says where the robot looks"
    walk.navigator.noted_move()
    assert walk.navigator.moved is None


def test_after_a_lift_the_next_marker_tells_where_it_was_put_down(walk: Walk) -> None:
    leave_and_lift(walk)
    sees_and_rolls(walk, "post5")
    assert (walk.navigator.moved, walk.navigator.at, walk.missions.held.grants) == ("post5", "post5", ())


def test_lifted_and_put_back_onto_its_way_it_just_goes_on(walk: Walk) -> None:
    leave_and_lift(walk)
    assert walk.missions.held.grants == (LEG,), "until a marker tells it may still be there"
    sees_and_rolls(walk, "post2")
    assert (walk.navigator.moved, walk.navigator.at) == (None, "post2")
    walk.navigator.destination = "post4"
    assert walk.navigator.way() == "left"


def test_put_back_the_wrong_way_round_it_comes_to_where_it_was_and_looks_away(walk: Walk) -> None:
    leave_and_lift(walk)
    sees_and_rolls(walk, "post1")
    assert (walk.navigator.moved, walk.navigator.at) == (None, "post1")
    walk.navigator.destination = "post2"
    assert walk.navigator.way() == "behind"


def test_put_down_before_a_crossing_it_asks_for_every_corridor_that_it_may_get_into(walk: Walk) -> None:
    leave_and_lift(walk)
    sees_and_rolls(walk, "post3")
    ways = {Leg(from_post="post3", to_post=post.name) for post, _ in TRACK.neighbours("post3")}
    assert (walk.navigator.at, len(ways)) == ("post3", 3)
    assert set(walk.navigator.first_legs("post4")) == ways, "all its markers look the same"
    walk.navigator.leave()
    walk.navigator.reached("post4")
    assert walk.navigator.first_legs("post3") == (Leg(from_post="post4", to_post="post3"),)


def test_what_the_post_itself_says_when_the_body_stands_there_counts(walk: Walk) -> None:
    walk.navigator.leave()
    walk.body.rolls(1650.0)
    walk.body.sees("post2")
    walk.look()
    walk.body.rolls(250.0)
    walk.look()
    assert walk.navigator.at is None, "by its own sighting there are 50 mm left"
    walk.navigator.reached("post2")
    assert (walk.navigator.at, walk.missions.held.grants) == ("post2", ())
    walk.look()
    assert walk.navigator.at == "post2"


def test_the_way_left_in_the_corridor_is_known_from_map_and_wheels(walk: Walk) -> None:
    assert walk.navigator.way_left_mm is None
    walk.navigator.leave()
    assert walk.navigator.way_left_mm == pytest.approx(2000.0)
    walk.body.rolls(700.0)
    walk.look()
    assert walk.navigator.way_left_mm == pytest.approx(1300.0)
    walk.navigator.begin_turn()
    walk.body.turns(math.pi)
    walk.look()
    walk.navigator.turned()
    assert walk.navigator.way_left_mm == pytest.approx(700.0)


def test_a_marker_across_the_room_moves_nobody():
    assert hangs_beside_this_line(TRACK, Sighting("post4", 1.0, 0.0, 350.0))
    assert not hangs_beside_this_line(TRACK, Sighting("post4", 1.0, 0.0, 1200.0))


def test_at_a_post_with_three_ways_in_the_marker_needs_odometry_to_tell_the_heading():
    assert facing_by(TRACK, "post3", None) is None
    assert facing_by(TRACK, "post3", 0.2) == pytest.approx(0.0)
