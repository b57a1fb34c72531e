"""The bench of `bench.py`, for every test of this folder."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from robot.mission.store import Store
from tests.robot.agent.actions.bench import Bench


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Bench]:
    store = Store(tmp_path / "robot.db")
    yield Bench(store)
    store.close()
