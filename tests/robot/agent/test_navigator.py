"""Where the robot believes to be, which way to go, and what it still knows after a power cut."""

import math
from dataclasses import replace
from datetime import UTC, datetime

import pytest

from protocol.envelope import Envelope
from protocol.parts import Leg
from protocol.to_robot import Detour
from robot.agent.tracking import KEPT_POSTS
from robot.drivers.interfaces import Sighting
from robot.localization.closed import CLOSED_S
from robot.localization.directions import kept_from
from robot.mission.store import Store
from tests.plain_maps import plain_map
from tests.robot.agent.walk import Walk


def test_of_months_of_posts_the_newest_are_kept_and_each_is_told_once() -> None:
    with Store(None) as store:
        walk, told = Walk(store), list[str]()
        for number in range(KEPT_POSTS + 3):
            walk.navigator.place(f"post{number % 2 + 1}", None)
            told += walk.navigator.reached_after(len(told))
        assert told[-3:] == walk.navigator.visited[-3:] == ["post1", "post2", "post1"]
        assert (len(told), len(walk.navigator.visited)) == (KEPT_POSTS + 3, KEPT_POSTS)


def test_the_turns_of_the_papers_track_come_from_its_geometry(walk: Walk) -> None:
    walk.navigator.place("post1", "post2")
    walk.drives_to("post2")
    walk.navigator.destination = "post4"
    assert walk.navigator.way() == "left"
    assert walk.navigator.turn_rad("left") == pytest.approx(math.pi / 2)
    walk.turns("left")
    assert walk.navigator.way() == "forward"
    walk.drives_to("post3")
    assert walk.navigator.way() == "right"
    walk.turns("right")
    walk.drives_to("post4")
    assert walk.navigator.way() == "arrived"
    assert walk.navigator.visited == ["post1", "post2", "post3", "post4"]


def test_what_lies_behind_is_reached_by_half_a_turn_to_the_side_that_was_asked(walk: Walk) -> None:
    walk.navigator.place("post2", "post1")
    walk.drives_to("post1")
    walk.navigator.destination = "post4"
    assert walk.navigator.way() == "behind"
    assert walk.navigator.turn_rad("left") == pytest.approx(math.pi)
    assert walk.navigator.turn_rad("right") == pytest.approx(-math.pi)


def test_who_is_sent_aside_to_where_it_goes_anyway_takes_the_corridor_that_it_was_granted(store: Store) -> None:
    walk = Walk(store, home="uc", campus=plain_map("carleton"))
    walk.look()
    walk.navigator.place("uc", "azrieli")
    walk.drives_to("azrieli")
    walk.navigator.destination = "library"
    assert walk.navigator.way() == "forward", "by the junction it is as far, and no turn"
    straight = Leg(from_post="azrieli", to_post="library")
    sent = Detour(claim_id="c", legs=(straight,), reason="Others have to pass.")
    walk.missions.memory.resume("j", 1)
    walk.missions.memory.receive(
        Envelope(type="detour", robot="r1", journal="j", seq=1, at=datetime(2026, 1, 5, tzinfo=UTC), body=sent)
    )
    walk.missions.seen("azrieli")
    assert walk.navigator.way() == "right"
    walk.turns("right")
    walk.navigator.leave()
    assert walk.navigator.corridor == straight


def test_who_knows_the_corridor_to_be_closed_into_which_it_is_sent_keeps_to_its_own_way() -> None:
    campus, aside = plain_map("carleton"), Leg(from_post="azrieli", to_post="library")
    assert kept_from(campus, aside, "azrieli", "library", frozenset()) == {"azrieli-junction", "azrieli-uc"}
    closed = frozenset({"azrieli-library"})
    assert kept_from(campus, aside, "azrieli", "library", closed) == closed
    assert kept_from(campus, aside, "azrieli", "loeb", frozenset()) == frozenset(), "and so does who goes elsewhere"


def test_between_posts_it_is_nowhere_and_the_post_ahead_is_known(walk: Walk) -> None:
    walk.navigator.place("post3", "post4")
    assert walk.navigator.at == "post3"
    walk.navigator.leave()
    assert (walk.navigator.at, walk.navigator.way(), walk.navigator.towards) == (None, None, "post4")


def test_a_post_is_perceived_until_the_robot_rolls_on(walk: Walk) -> None:
    walk.navigator.place("post3", "post4")
    walk.body.rolls(20.0)
    walk.look()
    assert walk.navigator.rests_at == "post3"
    walk.body.rolls(10.0)
    walk.look()
    assert (walk.navigator.rests_at, walk.navigator.at) == (None, "post3")


def test_a_corridor_is_given_back_when_its_far_end_is_reached(walk: Walk) -> None:
    leg = Leg(from_post="post2", to_post="post3")
    walk.missions.memory.grant([leg])
    walk.missions.seen("post2")
    walk.navigator.place("post2", "post3")
    walk.drives_to("post3")
    assert walk.missions.held.grants == ()


def test_the_other_ways_out_of_the_post_before_are_given_back_with_it_and_what_lies_ahead_is_kept(walk: Walk) -> None:
    legs = [Leg(from_post=a, to_post=b) for a, b in (("post2", "post3"), ("post2", "post1"), ("post3", "post4"))]
    walk.missions.memory.grant(legs)
    walk.missions.seen("post2")
    walk.navigator.place("post2", "post3")
    walk.drives_to("post3")
    assert walk.missions.held.grants == (legs[2],)


def test_the_nearest_dock_is_by_the_map_and_its_own_while_it_is_lost(store: Store) -> None:
    walk = Walk(store, home="post5")
    assert walk.navigator.nearest_dock() == "post5"


def test_a_robot_that_stood_at_a_post_still_stands_there_after_a_power_cut(walk: Walk, store: Store) -> None:
    walk.navigator.place("post1", "post2")
    walk.drives_to("post2")
    again = Walk(store)
    again.look()
    again.navigator.destination = "post4"
    assert (again.navigator.at, again.navigator.way()) == ("post2", "left")


def test_a_robot_that_was_on_its_way_is_nowhere_until_the_next_marker(walk: Walk, store: Store) -> None:
    walk.navigator.place("post2", "post3")
    walk.navigator.leave()
    again = Walk(store)
    again.look()
    assert (again.navigator.at, again.navigator.towards, again.navigator.here) == (None, "post3", "post2")
    again.body.sees("post3")
    again.look()
    again.body.rolls(300.0)
    again.look()
    again.navigator.destination = "post5"
    assert (again.navigator.at, again.navigator.way()) == ("post3", "left")


@pytest.mark.parametrize(
    ("left_mm", "has_read", "doubted"),
    [(310.0, False, None), (500.0, True, "post4"), (290.0, False, "post4")],
)
def test_a_power_cut_before_a_post_leaves_doubt_from_its_marker_on_or_from_where_that_should_have_been_read(
    walk: Walk, store: Store, left_mm: float, has_read: bool, doubted: str | None
) -> None:
    walk.navigator.place("post3", "post4")
    walk.navigator.leave()
    walk.body.rolls(1000 * walk.navigator.ahead_m - left_mm)
    if has_read:
        walk.body.sees("post4")
    walk.look()
    again = Walk(store)
    again.look()
    assert again.navigator.doubted == doubted


def test_a_power_cut_between_dock_and_post_leaves_it_beside_the_line_until_it_is_in_the_dock_or_away(
    walk: Walk, store: Store
) -> None:
    walk.navigator.place("post3", "post5")
    walk.drives_to("post5")
    walk.navigator.begin_docking()
    again = Walk(store)
    again.look()
    assert (again.navigator.at, again.navigator.beside_dock, again.navigator.looks_anywhere) == ("post5", True, True)
    again.body.does("undock")
    again.body.battery(0.5, docked=True)
    again.look()
    assert Walk(store).navigator.beside_dock, "contacts bounce on the way out"
    again = Walk(store)
    again.look()
    again.body.battery(0.5, docked=True)
    again.look()
    assert not again.navigator.beside_dock
    assert not Walk(store).navigator.beside_dock


def test_a_robot_that_came_out_of_its_dock_and_lost_power_at_the_post_may_look_anywhere(
    walk: Walk, store: Store
) -> None:
    walk.navigator.place("post3", "post5")
    walk.drives_to("post5")
    walk.navigator.begin_docking()
    walk.navigator.undocked()
    again = Walk(store)
    assert (again.navigator.at, again.navigator.beside_dock, again.navigator.looks_anywhere) == ("post5", False, True)


def test_a_blocked_corridor_is_avoided_until_its_time_is_over(walk: Walk) -> None:
    walk.navigator.place("post2", "post3")
    walk.navigator.destination = "post5"
    walk.navigator.closed.close(Leg(from_post="post2", to_post="post3"), walk.now)
    assert (walk.navigator.way(), walk.navigator.nearest_dock()) == (None, None), "the only dock lies behind it"
    walk.now += CLOSED_S
    walk.look()
    assert (walk.navigator.way(), walk.navigator.nearest_dock()) == ("forward", "post5")


@pytest.mark.parametrize(("away_s", "left_s"), [(240.0, 360.0), (CLOSED_S, 0.0), (-86_400.0, CLOSED_S)])
def test_a_corridor_stays_closed_through_a_restart_for_as_long_as_it_had_left(
    walk: Walk, store: Store, away_s: float, left_s: float
) -> None:
    walk.navigator.closed.close(Leg(from_post="post2", to_post="post3"), walk.now)
    again = Walk(store, since_midnight_s=away_s)
    for after_s, closed in ((left_s - 1, left_s > 0), (left_s, False)):
        again.now = after_s
        again.look()
        assert bool(again.navigator.closed.names) == closed, f"{after_s:g} s after the restart"


def test_a_corridor_that_was_opened_again_is_not_closed_by_a_restart(walk: Walk, store: Store) -> None:
    walk.navigator.closed.close(Leg(from_post="post2", to_post="post3"), walk.now)
    walk.navigator.closed.open_all()
    assert not Walk(store).navigator.closed.names


def test_a_robot_that_turns_round_between_posts_comes_back_to_where_it_was(walk: Walk) -> None:
    leg = Leg(from_post="post2", to_post="post3")
    walk.missions.memory.grant([leg])
    walk.missions.seen("post2")
    walk.navigator.place("post2", "post3")
    walk.navigator.leave()
    walk.body.rolls(700.0)
    walk.look()
    walk.turns_round()
    assert (walk.navigator.towards, walk.navigator.came_from, walk.navigator.corridor) == ("post2", "post3", leg)
    assert walk.missions.held.grants == (leg,), "it is still in there"
    walk.body.rolls(690.0)
    walk.look()
    assert (walk.navigator.at, walk.navigator.corridor) == ("post2", None)
    assert walk.missions.held.grants == (leg,), "it may wish to go in again, perhaps where no service can grant it"
    walk.navigator.destination = "post3"
    assert walk.navigator.way() == "behind"


def test_a_turn_between_posts_does_not_forget_the_way_it_took(walk: Walk, store: Store) -> None:
    walk.navigator.place("post2", "post3")
    walk.navigator.leave()
    walk.body.rolls(700.0)
    walk.look()
    walk.navigator.begin_turn()
    assert Walk(store).navigator.at is None


def test_the_way_out_of_a_dock_is_known_by_the_map(walk: Walk) -> None:
    walk.navigator.place("post5", "post3")
    assert walk.navigator.undock_way() == (pytest.approx(500.0), True)
    walk.navigator.place("post1", "post2")
    assert walk.navigator.undock_way() == (None, True), "no dock is there"


def test_a_marker_seen_from_aslant_does_not_make_a_standing_robot_believe_that_it_has_left(walk: Walk) -> None:
    walk.navigator.place("post1", "post2")
    walk.drives_to("post2")
    aslant = Sighting("post2", walk.now, 150.0, 390.0, turned_rad=math.radians(60))
    walk.body.view = replace(walk.body.view, post=aslant)
    walk.look()
    assert walk.navigator.at == "post2"


@pytest.mark.parametrize(("turned_rad", "at"), [(0.0, "post2"), (math.radians(-80), None)])
def test_a_marker_seen_in_a_search_counts_only_for_who_looks_along_its_way(
    walk: Walk, turned_rad: float, at: str | None
) -> None:
    """Turned across, it saw the marker of a post that lay ahead where it sees that of a post under its axle."""
    walk.navigator.place("post1", "post2")
    walk.navigator.leave()
    walk.body.rolls(1750.0)
    walk.look()
    walk.body.turns(turned_rad)
    behind = Sighting("post2", walk.now + 0.1, -290.0, 350.0)
    seen = {"post": behind, "post_odometry": walk.body.view.odometry}
    walk.body.view = replace(walk.body.view, motion="follow_line", searching=True, **seen)
    walk.look()
    assert walk.navigator.at == at


def test_who_has_stopped_short_of_a_post_by_its_marker_drives_on_to_it(walk: Walk) -> None:
    walk.navigator.place("post1", "post2")
    walk.navigator.leave()
    walk.body.rolls(1700.0)
    walk.look()
    walk.navigator.reached("post2")
    walk.body.sees("post2")
    walk.look()
    assert (walk.navigator.at, walk.navigator.here, walk.navigator.towards) == (None, "post1", "post2")
    walk.body.rolls(300.0)
    walk.look()
    assert walk.navigator.at == "post2"
