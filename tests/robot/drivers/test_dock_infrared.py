"""The dock's infrared characters as a position."""

import math

import pytest

from robot.drivers.create2.dock_infrared import DockInfrared, DockSight, Side, dock_sight
from robot.drivers.interfaces import BaseState
from robot.simulated import Pose, SimulatedRobot
from tests.plain_maps import plain_map

TRACK = plain_map("test_track")
DOCK = next(post.dock for post in TRACK.docks() if post.dock)


@pytest.mark.parametrize(
    ("character", "expected"),
    [
        (161, DockSight(None, near=True)),
        (164, DockSight(Side.LEFT, near=False)),
        (165, DockSight(Side.LEFT, near=True)),
        (168, DockSight(Side.RIGHT, near=False)),
        (169, DockSight(Side.RIGHT, near=True)),
        (172, DockSight(Side.ON_AXIS, near=False)),
        (173, DockSight(Side.ON_AXIS, near=True)),
        (242, DockSight(None, near=True)),
        (244, DockSight(Side.LEFT, near=False)),
        (246, DockSight(Side.LEFT, near=True)),
        (248, DockSight(Side.RIGHT, near=False)),
        (250, DockSight(Side.RIGHT, near=True)),
        (252, DockSight(Side.ON_AXIS, near=False)),
        (254, DockSight(Side.ON_AXIS, near=True)),
    ],
)
def test_every_character_of_both_docks_says_where_the_robot_stands(character: int, expected: DockSight):
    assert dock_sight((character,)) == expected


def test_no_other_character_is_taken_for_a_dock():
    docks = {161, 164, 165, 168, 169, 172, 173, 242, 244, 246, 248, 250, 252, 254}
    assert {character for character in range(256) if dock_sight((character,))} == docks
    assert dock_sight(()) is None


class Told:
    """A base that says one state after the other."""

    def __init__(self) -> None:
        self.state: BaseState | None = None


def test_a_change_is_told_at_once_and_what_stays_once_a_second():
    base = Told()
    source = DockInfrared(base)  # type: ignore[arg-type]
    assert source.fixes(0.0) == ()
    told = []
    for tick in range(100):
        now = 10 + tick * 0.02
        base.state = BaseState(at_s=now, ir_omni=164 if tick < 60 else 172)
        told += [(round(now, 2), fix.left_mm < 0) for fix in source.fixes(now)]
    assert told == [(10.0, True), (11.0, True), (11.2, False)]


@pytest.mark.parametrize(("left_mm", "side"), [(250, -1), (0, 0), (-250, 1)])
@pytest.mark.parametrize(("before_mm", "near"), [(350, True), (1200, False)])
def test_in_the_simulated_beams_the_axis_lies_on_the_side_that_the_fix_says(left_mm, side, before_mm, near):
    along, across = math.cos(DOCK.heading_rad), math.sin(DOCK.heading_rad)
    if near:
        left_mm = left_mm * 0.6
    x_m = DOCK.x_m - before_mm / 1000 * along - left_mm / 1000 * across
    y_m = DOCK.y_m - before_mm / 1000 * across + left_mm / 1000 * along
    robot = SimulatedRobot(TRACK, 0.0, "post1", in_memory=True)
    robot.place(Pose(x_m, y_m, DOCK.heading_rad))
    base = Told()
    base.state = BaseState(at_s=0.0, ir_omni=robot.body.readings.ir_omni)
    robot.close()
    (fix,) = DockInfrared(base).fixes(5.0)  # type: ignore[arg-type]
    assert (fix.source, fix.post, fix.turned_rad) == ("dock", None, None)
    assert (fix.left_mm > 0) - (fix.left_mm < 0) == side
    assert abs(fix.ahead_mm - before_mm) < 2 * fix.accuracy_mm
