"""The service ends soon and in order, whatever it is doing when it is told to."""

import asyncio
import time
from collections.abc import Sequence

import httpx
import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from sqlmodel import select
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from app.cli.serving import GRACEFUL_S
from app.composition import create_app
from app.core.database.database import Database
from app.core.settings import Settings
from app.dispatch.service import LONGEST_REST_S
from app.models import Order, OrderState, RobotRow
from app.robots.service import new_token
from protocol.clock import SteppedClock
from protocol.envelope import Envelope
from protocol.parts import Battery, Position
from protocol.to_server import Hello
from tests.app.conftest import HERE, SENDER, Browser, Mailroom, Mails, Served

GOING_AWAY = 1012
"""RFC 6455's registry: the service restarts, come back."""
HELLO = Envelope(
    type="hello",
    robot="r1",
    journal="j1",
    at=SteppedClock().utc(),
    body=Hello(position=Position(post="post5"), battery=Battery(ratio=0.9), software="t", map_version="m"),
).to_text()


def test_what_dispatch_has_begun_is_finished_before_the_end(
    clock: SteppedClock, mails: Mails, settings: Settings
) -> None:
    """Cut off in its transaction it would keep SQLite's write lock for a while, and others would wait for that."""
    app = create_app(settings, clock)
    with TestClient(app, base_url=HERE) as client:
        browser = Browser(app)
        browser.portal = client.portal
        browser.post("/api/v1/sign-in/codes", json={"email": SENDER})
        browser.post("/api/v1/sign-in", json={"email": SENDER, "code": mails.newest_code(SENDER)})
        order_id = browser.order().json()["id"]
        while not browser.get(f"/api/v1/orders/{order_id}").json()["why"]:  # until dispatch has looked for a robot
            time.sleep(0.02)
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
    """A robot is there at last, and another transaction is writing just when dispatch wants to."""
    await _put(app, online=False)
    while not (schedule := app.state.parts.traffic_service.schedule) or not schedule.known:
        app.state.parts.traffic_service.wake()
        await asyncio.sleep(0.02)
    await _put(app, online=True)
    has_begun = asyncio.Event()

    async def hold() -> None:
        async with app.state.parts.database.transaction():
            app.state.parts.dispatcher.wake()
            has_begun.set()
            await asyncio.sleep(LONGEST_REST_S + 1.0)

    holding = asyncio.create_task(hold())
    await has_begun.wait()
    # It takes a breath when no robot was free, a longer one where looking took long; then it begins, and waits for us.
    await asyncio.sleep(LONGEST_REST_S + 0.3)
    return holding


async def _put(app: FastAPI, *, online: bool) -> None:
    async with app.state.parts.database.transaction() as session:
        row = RobotRow(name="r1", enrolled_at=app.state.parts.clock.utc(), server_journal="j1", post="post5")
        row.battery_ratio, row.online = 1.0, online
        await session.merge(row)


def test_who_is_connected_is_told_at_once_and_nothing_is_cut_off(
    served: Served, sender: Browser, mailroom: Mailroom, mails: Mails, settings: Settings
) -> None:
    """The robot hears that the service goes away, the page's stream ends in order, what was to be mailed is mailed."""
    token = mailroom.call(_new_token, mailroom.app)
    headers = {"Authorization": f"Bearer {token}"}
    link = served.url.replace("http", "ws") + "/api/v1/robots/link"
    cookie = {"session": sender.cookies["session"]}
    with connect(link, additional_headers=headers, proxy=None) as robot:
        robot.send(HELLO)
        assert '"welcome"' in robot.recv(5)
        with httpx.stream("GET", f"{served.url}/api/v1/live", cookies=cookie, timeout=10) as stream:
            events = stream.iter_lines()
            assert "following" in next(events)
            sender.order()
            begun_s = time.monotonic()
            served.server.should_exit = True
            rest = list(events)  # ends, instead of breaking
        with pytest.raises(ConnectionClosed):
            while True:
                robot.recv(5)
        assert robot.close_code == GOING_AWAY
        assert time.monotonic() - begun_s < 2 * GRACEFUL_S
    assert rest is not None
    mailroom.send_mails()
    assert [mail["Subject"] for mail in mails.to(SENDER) if not mail["Message-ID"].startswith("<sign-in")]


async def _new_token(app: FastAPI) -> str:
    async with app.state.parts.database.transaction() as session:
        return await new_token(session, app.state.parts.clock, "r1")
