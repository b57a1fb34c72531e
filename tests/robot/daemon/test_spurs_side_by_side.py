"""Two bays of a post lie to both sides of the way that a robot comes: it turns to its own, and enters no other."""

import math
from pathlib import Path

import pytest

from tests.robot.daemon.played_service import PlayedService
from tests.robot.daemon.simulated_run import SimulatedRun

FORK = """
name = "fork"
title = "A post with two bays ahead"
[[post]]
name = "a"
x_m = 0.0
y_m = 0.0
[[post.bay]]
bearing_deg = 180.0
dock = true
home = true
[[post]]
name = "b"
x_m = 2.0
y_m = 0.0
[[post.bay]]
bearing_deg = {0}
[[post.bay]]
bearing_deg = {1}
[[corridor]]
ends = ["a", "b"]
"""


@pytest.mark.parametrize("its_deg, other_deg", [(32.0, -28.0), (-38.0, 25.0)])
def test_it_enters_the_bay_that_it_was_granted(tmp_path: Path, its_deg: float, other_deg: float) -> None:
    """Where it is comes from its true pose: on the other bay's side of the crossing it never is."""
    file = tmp_path / "fork.toml"
    file.write_text(FORK.format(its_deg, other_deg))
    run = SimulatedRun(tmp_path, map=str(file))
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
