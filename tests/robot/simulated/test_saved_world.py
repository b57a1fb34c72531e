"""A simulated world's memory of a robot whose computer was killed."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from robot.ops.simulated_world import SAVE_EVERY_S, SavedWorld
from robot.simulated import SimulatedRobot
from tests.plain_maps import plain_map

STEP_S = 0.02
AS_WRITTEN_M = 1e-9


@pytest.fixture
def robots() -> Iterator[list[SimulatedRobot]]:
    """One that lives, and the one that is there after its computer was killed."""
    campus = plain_map("test_track")
    both = [SimulatedRobot(campus, 0.0, "post1:post2", in_memory=True) for _ in range(2)]
    yield both
    for robot in both:
        robot.close()


@pytest.fixture
def writes(monkeypatch: pytest.MonkeyPatch) -> list[bytes]:
    written: list[bytes] = []
    real = os.pwrite

    def pwrite(file: int, text: bytes, at: int) -> int:
        written.append(text)
        return real(file, text, at)

    monkeypatch.setattr(os, "pwrite", pwrite)
    return written


def wheel_counts(robot: SimulatedRobot) -> tuple[int, int]:
    return robot.body.base.left.encoder, robot.body.base.right.encoder


def test_a_robot_killed_right_after_a_step_is_where_that_step_ended(
    robots: list[SimulatedRobot], tmp_path: Path
) -> None:
    alive, again = robots
    world = SavedWorld(alive, tmp_path / "world.json")
    alive.push(35)
    world.step_until(STEP_S)
    found = SavedWorld(again, tmp_path / "world.json")  # the other was never closed
    assert found.restored
    assert again.pose.x_m == pytest.approx(alive.pose.x_m, abs=AS_WRITTEN_M)
    assert again.pose.y_m == pytest.approx(alive.pose.y_m, abs=AS_WRITTEN_M)
    assert again.pose.heading_rad == pytest.approx(alive.pose.heading_rad)
    assert wheel_counts(again) == wheel_counts(alive) != (0, 0), "its base has not been switched off"
    world.close()
    found.close()


def test_of_one_that_stands_still_only_the_charge_is_written_now_and_then(
    robots: list[SimulatedRobot], tmp_path: Path, writes: list[bytes]
) -> None:
    world = SavedWorld(robots[0], tmp_path / "world.json")
    steps = round(2 * SAVE_EVERY_S / STEP_S)
    for step in range(1, steps + 1):
        world.step_until(step * STEP_S)
    assert 1 <= len(writes) <= 3
    world.close()
