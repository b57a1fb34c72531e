from collections.abc import AsyncIterator
from pathlib import Path

import pytest

from tests.app.orders.lives import World


@pytest.fixture
async def world(sqlite_at_head: Path, tmp_path: Path) -> AsyncIterator[World]:
    """With one robot that can be reached. At once: what is asked here is not who fetches what, nor who goes first."""
    world = World(sqlite_at_head, tmp_path / "data", traffic="at_once")
    await world.begin()
    await world.set_online("r2", False)
    yield world
    await world.end()
