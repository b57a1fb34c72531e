from collections.abc import AsyncIterator
from pathlib import Path

import pytest
from fastapi import FastAPI

from app.accounts.sign_in.service import find_person, set_roles
from app.models import Role
from tests.app.conftest import STRANGER, Browser, Mailroom, SignedIn
from tests.app.orders.lives import World


@pytest.fixture
def dispatcher(app: FastAPI, signed_in: SignedIn, mailroom: Mailroom) -> Browser:
    browser = signed_in(STRANGER)
    mailroom.call(make_dispatcher, app, STRANGER)
    return browser


@pytest.fixture
async def world(sqlite_at_head: Path, tmp_path: Path) -> AsyncIterator[World]:
    """With one robot that can be reached; the other is at home."""
    world = World(sqlite_at_head, tmp_path / "data")
    await world.begin()
    await world.set_online("r2", False)
    yield world
    await world.end()


async def make_dispatcher(app: FastAPI, email: str) -> None:
    async with app.state.parts.database.transaction() as session:
        person = await find_person(session, email)
        assert person
        set_roles(person, {Role.DISPATCHER}, set())
