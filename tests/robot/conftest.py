"""Fixtures that several packages of the robot's tests share."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from robot.mission.store import Store
from tests.robot.reflexes.moving import Moving


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    """A robot's database on the disk."""
    with Store(tmp_path / "robot.db") as store:
        yield store


@pytest.fixture
def moving() -> Iterator[Moving]:
    """A robot on the line in the simulated world, its drive loop alive."""
    robot = Moving("post3:post2", battery_ratio=0.6)
    yield robot
    robot.close()
