"""A robot that wakes up in front of its dock and has seen no marker."""

from robot.drivers.create2.dock_infrared import DockSight, Side, dock_fix
from robot.drivers.interfaces import Odometry
from robot.localization.by_fixes import near_dock
from robot.localization.place import AtPost, Leaving, Unknown
from tests.plain_maps import plain_map

TRACK, TUNNELS = plain_map("test_track"), plain_map("carleton")
SEES_DOCK = ((dock_fix(DockSight(Side.LEFT, near=True), 10.0), Odometry()),)


def test_the_only_dock_of_a_map_tells_the_post():
    assert near_dock(TRACK, Unknown(), SEES_DOCK, None, 10.5) == Leaving("post5")


def test_where_there_are_several_it_is_the_robots_own():
    assert near_dock(TUNNELS, Unknown(), SEES_DOCK, "canal", 10.5) == Leaving("canal")
    assert near_dock(TUNNELS, Unknown(), SEES_DOCK, None, 10.5) == Unknown()


def test_a_robot_that_knows_a_place_or_saw_the_dock_long_ago_learns_nothing():
    known = AtPost("post1", 0.0, 0.0)
    assert near_dock(TRACK, known, SEES_DOCK, None, 10.5) == known
    assert near_dock(TRACK, Unknown(), SEES_DOCK, None, 20.0) == Unknown()
    assert near_dock(TRACK, Unknown(), (), None, 10.5) == Unknown()
