"""A corridor that a robot found closed is known by its name on the map, from what the robot itself says."""

import pytest

from app.robots.corridors.closed_corridors import closed_corridor, open_corridor
from maps import corridor_name
from protocol.parts import Leg
from robot.agent.actions.corridors import CLOSED_BY, WAY_BLOCKED, tried_again, turned_back

TO_POST2 = Leg(from_post="post4", to_post="post2")


@pytest.mark.parametrize("why", CLOSED_BY)
def test_the_service_reads_from_a_robots_words_which_corridor_is_closed(why: str) -> None:
    told = turned_back(TO_POST2, why)
    assert closed_corridor(WAY_BLOCKED, told) == corridor_name("post2", "post4")
    assert open_corridor(WAY_BLOCKED, told) is None


def test_and_which_one_is_open_again() -> None:
    assert open_corridor(WAY_BLOCKED, tried_again("post2-post4")) == "post2-post4"
    assert closed_corridor(WAY_BLOCKED, tried_again("post2-post4")) is None


def test_other_faults_close_nothing() -> None:
    told = turned_back(TO_POST2, "blocked")
    assert closed_corridor("stall", told) is None
    assert closed_corridor(WAY_BLOCKED, "The robot tries that way again.") is None
