"""Posts with an unreadable marker: what the tape shows tells where they are, better than the map and worn wheels."""

from collections.abc import Callable
from dataclasses import replace

import pytest

from robot.drivers.interfaces import BodyShape, LineReading, Odometry
from robot.localization.directions import turn_at_rad
from robot.skills import Done, FollowLine, Turn
from robot.skills.unread_post import UnreadPost
from tests.plain_maps import plain_map
from tests.robot.skills.track import Drive

TRACK = plain_map("test_track")
ON_LINE, WITH_RIGHT, ALL = (
    LineReading(False, True, False),
    LineReading(False, True, True),
    LineReading(True, True, True),
)
LEAD_MM, WAY_MM = 60.0, 2000.0


def driven(post: UnreadPost, dark: Callable[[float], bool], reading: LineReading = WITH_RIGHT) -> UnreadPost:
    """From 150 mm before the post to 120 mm beyond; `dark` tells for a place under the diodes what lies there."""
    for axle_mm in range(round(WAY_MM) - 150, round(WAY_MM) + 120, 2):
        here = Odometry(ahead_mm=axle_mm, travelled_mm=axle_mm)
        post.look(reading if dark(axle_mm + LEAD_MM) else ON_LINE, here)
    return post


def coming(leaving: str, ahead: str) -> UnreadPost:
    return UnreadPost(TRACK, leaving, ahead, Odometry(), WAY_MM, BodyShape(sensor_lead_mm=LEAD_MM))


def test_a_branch_is_where_the_outer_diode_is_dark_for_a_width_of_tape():
    post = driven(coming("post5", "post3"), lambda mm: abs(mm - 1960) < 12)
    assert post.place_mm(None) == pytest.approx(1960, abs=4)


def test_a_line_that_sways_under_the_outer_diode_is_no_branch():
    post = driven(coming("post5", "post3"), lambda mm: abs(mm - 1960) < 45)
    assert post.branch_mm is None
    assert post.place_mm(None) == WAY_MM, "the map says"


def test_a_diode_on_the_side_without_a_branch_tells_nothing():
    post = driven(coming("post4", "post3"), lambda mm: abs(mm - 1960) < 12)
    assert post.place_mm(None) == WAY_MM


def test_a_bar_across_is_the_post():
    post = driven(coming("post2", "post3"), lambda mm: abs(mm - 1970) < 12, ALL)
    assert post.place_mm(None) == pytest.approx(1970, abs=4)


def test_a_line_that_ends_is_over_at_the_post_where_none_leads_on():
    assert coming("post2", "post1").place_mm(1950.0) == 1950.0
    assert coming("post5", "post3").place_mm(1950.0) == WAY_MM, (
        "a worn piece of tape before a post with a way straight on"
    )


def test_where_it_is_not_known_which_post_comes_there_is_no_place():
    post = UnreadPost(TRACK, None, None, Odometry(), None, BodyShape())
    assert (post.place_mm(None), post.may_be_here(Odometry(ahead_mm=5000))) == (None, False)


@pytest.mark.parametrize("error", [-0.03, 0.03])
@pytest.mark.parametrize(("leaving", "post", "towards"), [("post5", "post3", "post2"), ("post3", "post2", "post1")])
@pytest.mark.nightly
def test_wheels_that_err_by_three_per_cent_do_not_miss_it(
    drive: Callable[..., Drive], error: float, leaving: str, post: str, towards: str
):
    torn = replace(TRACK, posts=TRACK.posts | {post: replace(TRACK.post(post), markers=())})
    robot = drive(f"{leaving}:{post}", campus=torn)
    follow = FollowLine(torn, leaving, shape=robot.shape, way_left_mm=WAY_MM * (1 + error), ahead=post)
    assert robot.do(follow, 60) == Done(post, unread=True)
    assert robot.distance_to_m(post) < 0.04
    began_s = robot.now
    assert robot.do(Turn(turn_at_rad(TRACK, leaving, post, towards), robot.shape)) == Done()
    assert robot.now - began_s < 6


@pytest.mark.parametrize("slip", [0.1, 0.25])
@pytest.mark.parametrize(("leaving", "post"), [("post3", "post4"), ("post1", "post2"), ("post2", "post3")])
@pytest.mark.nightly
def test_wheels_that_slip_do_not_stop_short_of_a_post_where_the_line_ends(
    drive: Callable[..., Drive], slip: float, leaving: str, post: str
):
    torn = replace(TRACK, posts=TRACK.posts | {post: replace(TRACK.post(post), markers=())})
    robot = drive(f"{leaving}:{post}", campus=torn)
    robot.robot.set_fault("slip", slip)
    follow = FollowLine(torn, leaving, shape=robot.shape, way_left_mm=WAY_MM, ahead=post)
    assert robot.do(follow, 90) == Done(post, unread=True)
    assert robot.distance_to_m(post) < 0.1
