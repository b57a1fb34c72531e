from collections.abc import AsyncIterator
from pathlib import Path

import pytest

from app.administration import migrate
from app.settings import Settings
from tests.app.orders.lives import World


@pytest.fixture
async def template(tmp_path: Path) -> Path:
    """An empty database."""
    await migrate(Settings(data=tmp_path / "template"))
    return tmp_path / "template" / "campus-mail.sqlite"


@pytest.fixture
async def world(template: Path, tmp_path: Path) -> AsyncIterator[World]:
    """With one robot that can be reached. At once: what is asked here is not who fetches what, nor who goes first."""
    world = World(template, tmp_path / "data", traffic="at_once")
    await world.begin()
    await world.set_online("r2", False)
    yield world
    await world.end()
