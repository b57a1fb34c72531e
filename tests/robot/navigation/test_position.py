"""Where the robot believes to be, from markers seen, way driven and turns made."""

import math
from dataclasses import replace

import pytest

from maps import UnknownPost, builtin_map
from robot.drivers.interfaces import Odometry, Sighting
from robot.navigation.directions import Way
from robot.navigation.position import Position

TRACK = builtin_map("test_track")
ABREAST_MM = 300.0
"""From a marker of the track to its post."""


class Walk:
    """A robot that moves in thought: drives, turns and sees markers."""

    def __init__(self, position: Position | None = None) -> None:
        self.position = position or Position()
        self.odometry = Odometry()
        self.seen: tuple[Sighting, Odometry] | None = None
        self._looks = 0

    def ahead(self, distance_mm: float) -> "Walk":
        odometry = self.odometry
        self.odometry = replace(
            odometry, ahead_mm=odometry.ahead_mm + distance_mm, travelled_mm=odometry.travelled_mm + abs(distance_mm)
        )
        return self.look()

    def turn(self, angle_rad: float) -> "Walk":
        self.odometry = replace(self.odometry, spot_turn_rad=self.odometry.spot_turn_rad + angle_rad)
        return self.look()

    def see(self, post: str, ahead_mm: float = 0.0, docked: bool = False) -> "Walk":
        self._looks += 1
        self.seen = Sighting(post, float(self._looks), ahead_mm, 350.0), self.odometry
        return self.look(docked)

    def look(self, docked: bool = False) -> "Walk":
        sighting, at = self.seen or (None, Odometry())
        self.position = self.position.after(TRACK, self.odometry, sighting, at, docked)
        return self

    def drive_to(self, post: str) -> "Walk":
        return self.ahead(1700 - ABREAST_MM).see(post, ahead_mm=300.0).ahead(300).see(post).ahead(ABREAST_MM)

    def way_to(self, post: str) -> Way | None:
        return self.position.way_to(TRACK, post, self.odometry)


def at_post2() -> Walk:
    return Walk(Position.placed(TRACK, "post1", "post2")).drive_to("post2")


def test_without_a_post_seen_nothing_is_claimed():
    walk = Walk().ahead(500)
    assert walk.position.at is None
    assert walk.way_to("post4") is None


def test_a_marker_in_view_is_not_yet_the_post():
    walk = Walk(Position.placed(TRACK, "post1", "post2")).ahead(1400).see("post2", ahead_mm=300.0)
    assert walk.position.current == "post1"
    assert walk.position.approaching == "post2"
    assert walk.position.post_at_mm == pytest.approx(walk.odometry.ahead_mm + 600.0)
    walk.ahead(590)
    assert (walk.position.current, walk.position.previous, walk.position.at) == ("post2", "post1", "post2")


def test_at_post2_from_post1_the_way_to_post4_is_left_and_after_the_turn_forward():
    walk = at_post2()
    assert walk.way_to("post4") is Way.LEFT
    assert walk.position.turn_rad(TRACK, "post3", walk.odometry) == pytest.approx(math.pi / 2)
    walk.turn(math.pi / 2 + 0.1)
    assert walk.way_to("post4") is Way.FORWARD
    assert walk.way_to("post1") is Way.LEFT


def test_behind_turned_half_round_is_forward():
    walk = at_post2()
    assert walk.way_to("post1") is Way.BEHIND
    assert walk.turn(math.pi).way_to("post1") is Way.FORWARD


def test_the_way_on_is_known_all_along_the_track():
    walk = at_post2().turn(math.pi / 2).drive_to("post3")
    assert walk.position.previous == "post2"
    assert walk.way_to("post4") is Way.RIGHT
    walk.turn(-math.pi / 2).drive_to("post4")
    assert walk.position.current == "post4"
    assert walk.way_to("post4") is Way.ARRIVED


def test_after_a_turn_in_mid_corridor_the_way_back_is_forward_and_the_same_post_comes_again():
    walk = at_post2().turn(math.pi / 2).ahead(800).turn(math.pi)
    assert walk.position.at is None
    assert walk.way_to("post1") is Way.RIGHT, "at post2, coming back from the east, post1 lies to the right"
    walk.ahead(500).see("post2").ahead(ABREAST_MM)
    assert (walk.position.current, walk.position.previous, walk.position.at) == ("post2", "post1", "post2")
    assert walk.way_to("post1") is Way.RIGHT
    assert walk.way_to("post4") is Way.BEHIND


def test_a_robot_that_wakes_up_in_the_dock_knows_where_it_looks():
    walk = Walk().see("post5", docked=True)
    assert walk.position.at == "post5"
    assert walk.way_to("post4") is Way.BEHIND
    assert walk.turn(math.pi).way_to("post4") is Way.FORWARD


def test_with_an_unknown_heading_the_word_is_forward_until_the_next_post_tells():
    walk = Walk().see("post2").ahead(ABREAST_MM)
    assert walk.position.facing_rad is None
    assert walk.way_to("post1") is Way.FORWARD
    walk.drive_to("post3")
    assert walk.way_to("post5") is Way.LEFT


def test_a_post_that_was_missed_is_made_up_for_at_the_next():
    walk = Walk(Position.placed(TRACK, "post4", "post3")).ahead(3700).see("post5").ahead(ABREAST_MM)
    assert (walk.position.current, walk.position.previous) == ("post5", "post4")
    assert walk.way_to("post3") is Way.BEHIND


def test_an_unknown_destination_is_an_error():
    with pytest.raises(UnknownPost):
        at_post2().way_to("post9")
