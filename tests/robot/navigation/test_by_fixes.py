"""A robot that wakes up in front of its dock and has seen no marker."""

from maps import builtin_map
from robot.drivers.dock_infrared import DockSight, Side, dock_fix
from robot.drivers.interfaces import Odometry
from robot.navigation.by_fixes import near_dock
from robot.navigation.position import Position

TRACK, TUNNELS = builtin_map("test_track"), builtin_map("carleton")
SEES_DOCK = ((dock_fix(DockSight(Side.LEFT, near=True), 10.0), Odometry()),)


def test_the_only_dock_of_a_map_tells_the_post():
    position = near_dock(TRACK, Position(), SEES_DOCK, None, 10.5)
    assert (position.current, position.at, position.facing_rad) == ("post5", None, None)


def test_where_there_are_several_it_is_the_robots_own():
    assert near_dock(TUNNELS, Position(), SEES_DOCK, "canal", 10.5).current == "canal"
    assert near_dock(TUNNELS, Position(), SEES_DOCK, None, 10.5).current is None


def test_whoever_knows_a_place_or_saw_the_dock_long_ago_learns_nothing():
    known = Position.placed(TRACK, "post1", "post2")
    assert near_dock(TRACK, known, SEES_DOCK, None, 10.5) == known
    assert near_dock(TRACK, Position(), SEES_DOCK, None, 20.0).current is None
    assert near_dock(TRACK, Position(), (), None, 10.5).current is None
