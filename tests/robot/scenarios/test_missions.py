"""Missions as the benchmark draws them: no letter lost, none claimed falsely, no corridor ungranted."""

import pytest

from benchmarks.body.missions import fly
from robot.scenarios.figures import Figures

FIRST_SEED = 9001
WENT_WRONG = (
    ("track", 21000),  # bumped on its way out of the dock, searched in curves, and did not know which way it looked
    ("track", 21039),  # gave back every corridor where there is no network, and could not leave
    ("tunnels", 20616),  # no person came where there is no network, and the way back was not granted
    ("tunnels", 20617),  # searched for the line in a turn, and took itself for one that comes back along it
    ("tunnels", 20623),  # rolled on beyond a post while its base did not answer, and backed up
)
MISSIONS = (*((world, FIRST_SEED + more) for world in ("track", "tunnels") for more in range(3)), *WENT_WRONG)


@pytest.mark.nightly
@pytest.mark.parametrize(("world", "seed"), MISSIONS)
def test_every_letter_is_delivered_or_honestly_handed_to_a_person(world, seed):
    mission = fly(world, seed)
    assert isinstance(mission, Figures), mission
    assert set(mission.fates.values()) <= {"delivered", "handed_over"}, mission.whys
    assert not [one for one in mission.violations if "without a grant" in one]
