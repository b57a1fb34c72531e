"""Ordinary driving on worn tape with noisy diodes and uneven wheels: no row of the table fires.

Five simulated minutes here; `CALM_MINUTES=20` drives longer.
"""

import math
import os

import pytest

from robot.simulated import Options
from robot.skills.follow_line import FollowLine
from robot.skills.interfaces import Done
from robot.skills.turn import Turn
from tests.robot.reflexes.moving import Moving

MINUTES, SEEDS = float(os.environ.get("CALM_MINUTES", "5")), (1, 2, 3, 4)


class Watched(Moving):
    """Fails at the tick at which any fault is noticed."""

    def tick(self) -> None:
        super().tick()
        assert not self.loop.view.faults, f"{set(self.loop.view.faults)} at {self.now:.2f} s"


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.nightly
def test_ordinary_driving_raises_no_alarm(seed: int) -> None:
    robot = Watched("post3:post2", seed=seed, options=Options(gap_m=0.02))
    robot.robot.set_fault("floor_flip", 0.01)
    robot.robot.set_fault("floor_edge_mm", 2.0)
    here, there = "post3", "post2"
    until_s = robot.now + 60 * MINUTES / len(SEEDS)
    while robot.now < until_s:
        assert robot.do(FollowLine(robot.campus, here, 180.0, robot.shape)) == Done(there)
        assert robot.do(Turn(math.pi, robot.shape)) == Done()
        here, there = there, here
    robot.close()
