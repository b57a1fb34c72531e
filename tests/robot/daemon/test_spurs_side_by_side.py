"""Two bays of a post lie to both sides of the way that a robot comes: it turns to its own, and enters no other."""

import math
from pathlib import Path

import pytest

from tests.robot.daemon.played_service import PlayedService
from tests.robot.daemon.simulated_run import SimulatedRun
from tests.robot.fork import fork


@pytest.mark.parametrize("its_deg, other_deg", [(32.0, -28.0), (-38.0, 25.0)])
def test_it_enters_the_bay_that_it_was_granted(tmp_path: Path, its_deg: float, other_deg: float) -> None:
    """Where it is comes from its true pose: on the other bay's side of the crossing it never is."""
    run = SimulatedRun(tmp_path, map=str(fork(tmp_path, its_deg, other_deg)))
    run.missions.join(PlayedService(run.missions))
    run.asks("", "visit(b)")
    beside_m: list[float] = []

    def is_in_its_bay() -> bool:
        here = run.robot.pose
        if here.x_m > 2.15:
            beside_m.append(math.copysign(1.0, other_deg) * here.y_m)
        return run.bays[-1:] == ["b_bay1"] and run.visited[-1:] == ["b_bay1"]

    run.until(is_in_its_bay, 120)
    assert max(beside_m) < 0.05
    run.close()
