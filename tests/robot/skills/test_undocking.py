"""Out of docks at the end of a line and beside one, onto the post, whatever the map says."""

import math
from collections.abc import Callable

import pytest

from benchmarks.body.turns import small_map
from robot.skills import Done, FollowLine, Turn, Undock
from tests.plain_maps import PLAIN_TUNNELS, plain_map
from tests.robot.skills.track import Drive

Make = Callable[..., Drive]


@pytest.mark.parametrize("seed", [3, 4])
@pytest.mark.nightly
def test_from_a_dock_at_the_end_of_the_line_it_comes_onto_the_line(drive: Make, seed: int):
    robot = drive("dock", campus=plain_map("test_track"), seed=seed)
    began = robot.now
    assert robot.do(Undock(robot.shape, 500.0)) == Done()
    assert robot.now - began < 12
    assert robot.distance_to_m("post5") < 0.05
    assert robot.do(FollowLine(robot.campus, "post5", shape=robot.shape)) == Done("post3")


def test_straight_out_of_a_dock_it_is_on_the_line_within_six_seconds(drive: Make):
    robot = drive("dock", campus=plain_map("test_track"), seed=3)
    began = robot.now
    assert robot.do(Undock(robot.shape, 500.0)) == Done()
    assert robot.now - began < 5.9


@pytest.mark.parametrize(("turn_rad", "towards"), [(-math.pi / 2, "nicol"), (math.pi / 2, "uc")])
@pytest.mark.nightly
def test_from_a_dock_beside_the_line_it_comes_to_the_post_and_can_turn_there(
    drive: Make, turn_rad: float, towards: str
):
    robot = drive("dock:canal", campus=small_map(PLAIN_TUNNELS))
    assert robot.do(Undock(robot.shape, 600.0, line_ahead=False)) == Done()
    assert robot.distance_to_m("canal") < 0.03
    assert robot.do(Turn(turn_rad, robot.shape)) == Done()
    assert robot.do(FollowLine(robot.campus, "canal", shape=robot.shape)) == Done(towards)
