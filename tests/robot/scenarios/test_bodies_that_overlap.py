"""Bodies that overlap fail a scenario, unless a person has put them there."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from robot.scenarios.scenario import Scenario
from robot.scenarios.stage import Stage
from robot.simulated import Pose, SimulatedRobot

SCENARIO = {
    "map": {"name": "carleton"},
    "limit_s": 2,
    "robot": [{"name": "r1", "start": "dock:uc"}, {"name": "r2", "start": "dock:commons"}],
    "order": [{"id": "o1", "from": "canal", "to": "uc"}],
}


def violations(folder: Path, move: Callable[[SimulatedRobot, Pose], None]) -> list[str]:
    """r2 is moved into r1 after a second."""
    with Stage(Scenario.model_validate(SCENARIO), folder) as stage:
        r1, r2 = (actor.body for actor in stage.actors)

        def look(now: float) -> None:
            if now == pytest.approx(1.0):
                move(r2, Pose(r1.pose.x_m + 0.1, r1.pose.y_m, 0.0))

        stage.watchers.append(look)
        return stage.run().violations


def test_two_bodies_in_one_place_fail_the_run(tmp_path: Path) -> None:
    said = violations(tmp_path, lambda robot, pose: robot.body.place(pose.x_m, pose.y_m, pose.heading_rad))
    assert len(said) == 1
    assert re.match(r"r1 and r2 overlap by 2\d\d mm at ", said[0])


def test_where_a_person_put_one_into_the_other_it_does_not(tmp_path: Path) -> None:
    assert violations(tmp_path, SimulatedRobot.place) == []
