"""The follower on the benchmark's tracks, and what it does where the line or a marker is not as the map says."""

import math
from collections.abc import Callable
from dataclasses import replace
from statistics import mean

import pytest

from benchmarks.body.line import ride
from benchmarks.body.turns import ON_THE_LINE, cross, small_map
from maps import CampusMap
from robot.skills import Done, Failed, FindLine, FollowLine, Turn
from tests.plain_maps import PLAIN_TUNNELS, plain_map
from tests.robot.skills.track import Drive

Make = Callable[..., Drive]
TRACK = plain_map("test_track")


def without_marker(post: str) -> CampusMap:
    """A person has torn it off."""
    return replace(TRACK, posts=TRACK.posts | {post: replace(TRACK.post(post), markers=())})


@pytest.mark.parametrize("track", ["straight", "s_600_400", "s_250_200"])
@pytest.mark.nightly
def test_with_the_sensor_ahead_it_follows_tight_bends_at_speed(track: str):
    one = ride(track, lead_mm=60.0, seed=7)
    assert one.completed, one.outcome
    assert one.speed_mm_s > 145
    assert one.lost_share < 0.05
    assert (one.searching, one.slow_commands) == (0, 0)


@pytest.mark.nightly
def test_on_a_straight_line_it_loses_little_time_to_corrections():
    rides = [ride("straight", lead_mm=60.0, seed=seed) for seed in (7, 8)]
    assert mean(one.speed_mm_s for one in rides) > 188


@pytest.mark.parametrize("track", ["straight", "s_600_400"])
@pytest.mark.nightly
def test_with_the_sensor_on_the_axle_it_follows_slowly(track: str):
    one = ride(track, lead_mm=0.0, seed=7)
    assert one.completed, one.outcome
    assert 80 <= one.speed_mm_s <= 120
    assert one.slow_commands == 0


@pytest.mark.parametrize("came_from", ["post2", "post4", "post5"])
@pytest.mark.parametrize("towards", ["post2", "post4", "post5"])
@pytest.mark.nightly
def test_at_a_t_junction_no_turn_slips_onto_a_branch(came_from: str, towards: str):
    crossing = cross(TRACK, came_from, "post3", towards, seed=7)
    assert (crossing.outcome, crossing.searches) == (ON_THE_LINE, 0)
    assert crossing.stopped_off_m < 0.03
    assert crossing.turn_s < 5


def test_a_half_turn_takes_little_longer_than_the_wheels_need():
    crossing = cross(TRACK, "post2", "post3", "post2", seed=7)
    assert crossing.outcome == ON_THE_LINE
    assert crossing.turn_s < 2.25, "1.85 s at 200 mm/s"


@pytest.mark.parametrize(
    "turn", [("canal", "uc", "azrieli"), ("azrieli", "uc", "canal"), ("nicol", "mackenzie", "nicol")]
)
@pytest.mark.nightly
def test_in_the_tunnels_neither(turn: tuple[str, str, str]):
    crossing = cross(small_map(PLAIN_TUNNELS), *turn, seed=7)
    assert (crossing.outcome, crossing.searches) == (ON_THE_LINE, 0)


@pytest.mark.nightly
def test_a_post_in_sight_is_not_forgotten_when_the_line_is_lost(drive: Make):
    robot = drive("post1:post2")
    job = robot.loop.start(FollowLine(TRACK, "post1", shape=robot.shape), robot.now)
    robot.until(lambda: robot.loop.view.post is not None)
    robot.steps(0.4)
    pose = robot.robot.pose
    robot.robot.place(replace(pose, x_m=pose.x_m + 0.1))
    robot.robot.set_fault("darkness", 1.0)  # what it has not seen by now it does not see any more
    robot.until(lambda: robot.loop.view.searching)
    assert robot.end_of(job, 200) == Done("post2")
    assert robot.distance_to_m("post2") < 0.15


@pytest.mark.parametrize("way", [("post1", "post2", 1), ("post5", "post3", -1)])
def test_a_post_without_its_marker_is_reached_by_map_and_wheels_and_said_to_be(drive: Make, way: tuple[str, str, int]):
    leaving, post, side = way
    robot = drive(f"{leaving}:{post}", campus=without_marker(post))
    follow = FollowLine(robot.campus, leaving, shape=robot.shape, way_left_mm=2000.0, ahead=post)
    assert robot.do(follow, 60) == Done(post, unread=True)
    assert robot.distance_to_m(post) < 0.08
    assert robot.loop.view.find_line_episodes == 0
    assert robot.do(Turn(side * math.pi / 2, robot.shape)) == Done(), "the line that branches off there is met"


def test_past_the_length_of_its_way_it_stops_where_no_post_is_known(drive: Make):
    robot = drive("post5:post3", campus=without_marker("post3"))
    follow = FollowLine(robot.campus, "post5", shape=robot.shape, way_left_mm=2000.0)
    assert robot.do(follow, 60) == Failed("post_missed")
    assert robot.distance_to_m("post3") < 0.25


def test_turned_round_between_posts_it_comes_back_to_the_post_behind(drive: Make):
    robot = drive("post1:post2")
    job = robot.loop.start(FollowLine(TRACK, "post1", shape=robot.shape), robot.now)
    robot.until(lambda: robot.robot.pose.y_m < 3.3)
    robot.loop.cancel(job)
    robot.steps(0.5)
    assert robot.do(Turn(math.pi, robot.shape)) == Done()
    assert robot.do(FollowLine(TRACK, "post2", shape=robot.shape)) == Done("post1")
    assert robot.distance_to_m("post1") < 0.03


@pytest.mark.slow
def test_bumped_in_the_middle_of_a_turn_it_goes_back_to_the_post_and_finds_its_line(drive: Make):
    robot = drive("post3:post4")
    job = robot.loop.start(Turn(math.pi, robot.shape), robot.now)
    robot.steps(0.8)
    robot.robot.bump("both")
    assert robot.end_of(job) == Done()
    assert robot.distance_to_m("post3") < 0.04
    assert robot.do(FollowLine(TRACK, "post3", shape=robot.shape)) == Done("post5")


@pytest.mark.parametrize("turned_deg", [-160, -100, 60, 150])
def test_who_does_not_know_which_way_it_looks_finds_the_line_without_leaving_its_post(drive: Make, turned_deg: int):
    robot = drive("post1:post2")
    pose = robot.robot.pose
    robot.robot.place(replace(pose, heading_rad=pose.heading_rad + math.radians(turned_deg)))
    robot.steps(0.1)
    began = robot.now
    assert robot.do(FindLine(robot.shape, looks_anywhere=True)) == Done()
    assert robot.now - began < 12
    assert robot.distance_to_m("post1") < 0.03
    assert math.cos(robot.robot.pose.heading_rad - pose.heading_rad) > 0.9


@pytest.mark.slow
def test_a_line_that_was_met_across_is_followed_the_way_it_looked_before(drive: Make):
    robot = drive("post1:post2")
    pose = robot.robot.pose
    robot.robot.place(replace(pose, x_m=pose.x_m + 0.25, y_m=pose.y_m - 0.8, heading_rad=pose.heading_rad + 0.6))
    robot.steps(0.1)
    assert robot.do(FindLine(robot.shape, side=-1.0), limit_s=190) == Done()
    assert abs(robot.robot.pose.x_m) < 0.06
    assert math.cos(robot.robot.pose.heading_rad - pose.heading_rad) > 0.5
