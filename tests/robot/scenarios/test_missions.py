"""Six of the benchmark's missions, three in each world: no letter lost, none claimed falsely, no corridor ungranted."""

import pytest

from benchmarks.body.missions import fly
from robot.scenarios.figures import Figures

FIRST_SEED = 9001


@pytest.mark.parametrize("world", ["track", "tunnels"])
@pytest.mark.parametrize("seed", range(FIRST_SEED, FIRST_SEED + 3))
def test_every_letter_is_delivered_or_honestly_handed_to_a_person(world, seed):
    mission = fly(world, seed)
    assert isinstance(mission, Figures), mission
    assert set(mission.fates.values()) <= {"delivered", "handed_over"}, mission.whys
    assert not [one for one in mission.violations if "without a grant" in one]
