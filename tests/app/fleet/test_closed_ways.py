"""A corridor that a robot found closed is known by its name on the map, from what the robot itself says."""

import pytest

from app.fleet.closed_ways import closed_corridor
from maps import corridor_name
from protocol.parts import Leg
from robot.action.corridors import CLOSED_BY, WAY_BLOCKED, turned_back


@pytest.mark.parametrize("why", CLOSED_BY)
def test_the_service_reads_from_a_robots_words_which_corridor_is_closed(why: str) -> None:
    told = turned_back(Leg(from_post="post4", to_post="post2"), why)
    assert closed_corridor(WAY_BLOCKED, told) == corridor_name("post2", "post4")


def test_other_faults_close_nothing() -> None:
    told = turned_back(Leg(from_post="post4", to_post="post2"), "blocked")
    assert closed_corridor("stall", told) is None
    assert closed_corridor(WAY_BLOCKED, "The robot tries that way again.") is None
