"""A whole robot in stepped time."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.robot.daemon.simulated_run import SimulatedRun


@pytest.fixture
def run(tmp_path: Path) -> Iterator[SimulatedRun]:
    run = SimulatedRun(tmp_path)
    yield run
    run.close()
