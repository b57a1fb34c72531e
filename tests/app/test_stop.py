"""The service ends soon and in order, whatever it is doing when it is told to."""

import asyncio
from collections.abc import Sequence

from fastapi import FastAPI
from fastapi.testclient import TestClient
from sqlmodel import select

from app.database import Database
from app.settings import Settings
from app.tables import Order, OrderState, RobotRow
from tests.app.conftest import HERE, SENDER, Browser, Mails


def test_what_dispatch_has_begun_is_finished_before_the_end(app: FastAPI, mails: Mails, settings: Settings) -> None:
    """Cut off in its transaction it would keep SQLite's write lock for a while, and others would wait for that."""
    with TestClient(app, base_url=HERE) as client:
        browser = Browser(app)
        browser.portal = client.portal
        browser.post("/api/v1/sign-in/codes", json={"email": SENDER})
        browser.post("/api/v1/sign-in", json={"email": SENDER, "code": mails.newest_code(SENDER)})
        assert browser.order().json()["state"] == "queued"
        assert client.portal is not None
        holding = client.portal.call(_let_dispatch_wait_for_the_lock, app)
    assert holding.done()
    assert asyncio.run(_states(settings)) == [OrderState.ASSIGNED]


async def _states(settings: Settings) -> Sequence[OrderState]:
    database = Database(settings.url_of_database)
    async with database.reading() as session:
        states = (await session.exec(select(Order.state))).all()
    await database.close()
    return states


async def _let_dispatch_wait_for_the_lock(app: FastAPI) -> "asyncio.Task[None]":
    """A robot is there at last, but who says so has not committed yet."""
    has_begun = asyncio.Event()

    async def hold() -> None:
        async with app.state.database.transaction() as session:
            at = app.state.clock.utc()
            charged = RobotRow(name="r1", enrolled_at=at, server_journal="j1", post="post5", battery_ratio=1.0)
            charged.online = True
            session.add(charged)
            await session.flush()
            app.state.dispatcher.wake()
            has_begun.set()
            await asyncio.sleep(0.4)

    holding = asyncio.create_task(hold())
    await has_begun.wait()
    await asyncio.sleep(0.1)
    return holding
