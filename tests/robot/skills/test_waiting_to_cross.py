"""Before a post with bays: a robot that may not cross stops where nothing that crosses can touch it."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from maps import find_map
from robot.skills import Done, Failed, FollowLine
from tests.robot.skills.track import Drive

Make = Callable[..., Drive]
CAMPUS = find_map(Path(__file__).parents[2] / "bays.toml")
TRACK = CAMPUS.track
BODIES_TOUCH_M = 0.348
"""Two robots, each 348 mm across (Create 2), with their axles so far apart."""


class Permission:
    """The service's word, as any thread may ask for it."""

    def __init__(self) -> None:
        self.given = False

    def __call__(self) -> bool:
        return self.given


def follow(may_cross: Callable[[], bool], **how: float | str | None) -> FollowLine:
    return FollowLine(TRACK, "post2", may_cross=may_cross, **how)


def away_from_post3_m(drive: Drive) -> float:
    return math.dist((drive.robot.pose.x_m, drive.robot.pose.y_m), TRACK.post("post3").point)


def test_it_stops_before_the_crossing_and_says_so(drive: Make):
    robot = drive("post2:post3", campus=CAMPUS)
    assert robot.do(follow(Permission())) == Failed("must_wait")
    assert BODIES_TOUCH_M + 0.05 < away_from_post3_m(robot) < 0.6
    assert robot.loop.view.sent.still


def test_it_drives_on_without_a_stop_when_it_is_permitted_in_time(drive: Make):
    robot, may_cross = drive("post2:post3", campus=CAMPUS), Permission()
    may_cross.given = True
    assert robot.do(follow(may_cross)) == Done("post3")
    assert away_from_post3_m(robot) < 0.03


def test_it_goes_on_to_the_post_from_where_it_waited(drive: Make):
    robot, may_cross = drive("post2:post3", campus=CAMPUS), Permission()
    robot.do(follow(may_cross))
    may_cross.given = True
    assert robot.do(follow(may_cross)) == Done("post3")
    assert away_from_post3_m(robot) < 0.03


def test_without_the_marker_it_stops_so_early_that_the_post_cannot_be_nearer(drive: Make):
    torn_off = replace(CAMPUS, posts=CAMPUS.posts | {"post3": replace(CAMPUS.post("post3"), markers=())})
    robot = drive("post2:post3", campus=torn_off)
    outcome = robot.do(follow(Permission(), way_left_mm=2000.0, ahead="post3"))
    assert outcome == Failed("must_wait")
    assert 0.5 < away_from_post3_m(robot) < 0.8


@pytest.mark.parametrize("bay", ["post3_bay1", "post4_bay1"])
def test_nothing_makes_it_wait_before_a_bay(drive: Make, bay: str):
    robot = drive(f"{TRACK.address_of(bay)}:{bay}", campus=CAMPUS)
    post = TRACK.address_of(bay)
    assert robot.do(FollowLine(TRACK, post)) == Done(bay)
    assert math.dist((robot.robot.pose.x_m, robot.robot.pose.y_m), TRACK.post(bay).point) < 0.03
