"""No deadlock, looked at exhaustively: up to four posts here, five in `make bench-fleet ARGS="every_map"`."""

import pytest

from benchmarks.fleet.every_map import look_at
from benchmarks.fleet.small_maps import AT_HOME, Fleet, connected_maps, network_on


@pytest.mark.parametrize("crossing_s", [0.0, 3.0])
@pytest.mark.parametrize(("posts", "every_goal", "places"), [(2, True, 426), (3, False, 3360), (4, False, 30418)])
@pytest.mark.nightly
def test_from_everywhere_robots_come_home_and_take_on_more(
    posts: int, every_goal: bool, places: int, crossing_s: float
) -> None:
    seen = look_at(posts, every_goal=every_goal, crossing_s=crossing_s)
    assert (seen.stuck, seen.invalid, seen.refused) == (0, 0, 0)
    assert seen.goals >= seen.places == places


@pytest.mark.parametrize(("posts", "shapes"), [(2, 1), (3, 2), (4, 6), (5, 21)])
def test_every_connected_shape_is_looked_at_once(posts: int, shapes: int) -> None:
    """The numbers of connected graphs are known: OEIS A001349."""
    assert len(list(connected_maps(posts))) == shapes


def test_places_from_which_no_robot_comes_home_are_not_looked_at() -> None:
    """Four robots on a line of single bays, each in the way of those that must pass it: they never come about."""
    line = network_on(4, frozenset({(0, 1), (1, 2), (2, 3)}), (1, 1, 1, 1))
    known = Fleet(line, (3, 3, 0, 0)).places_that_come_home()
    assert (0, 1, 2, 3) not in known
    assert (AT_HOME,) * 4 in known
