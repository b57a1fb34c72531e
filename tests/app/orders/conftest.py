from collections.abc import AsyncIterator
from pathlib import Path

import pytest

from tests.app.orders.lives import World


@pytest.fixture
async def world(sqlite_at_head: Path, tmp_path: Path) -> AsyncIterator[World]:
    """With one robot that can be reached; the other is at home."""
    world = World(sqlite_at_head, tmp_path / "data")
    await world.begin()
    await world.set_online("r2", False)
    yield world
    await world.end()
