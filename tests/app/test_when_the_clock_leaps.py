"""A wall clock that leaps three days ahead for some seconds: nothing is done that cannot be undone."""

import asyncio
import signal
import sqlite3
import time
from collections.abc import Callable
from contextlib import closing
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from prometheus_client.parser import text_string_to_metric_families
from sqlmodel import col, select

from app.composition import create_app
from app.core.settings import Settings
from app.models import Order, OutgoingNotification, PersonSession, StandingOrder
from protocol.clock import SteppedClock
from tests.app.conftest import HERE, RECIPIENT, SENDER, Browser, Mailroom, sqlite_alone
from tests.app.notifications.test_killed_while_sending import free_port
from tests.app.service_process import said, serving
from tests.app.test_trusted_clock import DAY_S, NINE, Machine

STANDING = {"from_post": "post1", "to_post": "post4", "recipient": RECIPIENT, "weekdays": [1, 2, 3, 4, 5, 6]}


AWAY = {"smtp_host": "127.0.0.1", "smtp_port": 9, "smtp_tls": "none"}
"""A mail server that is not there."""


@pytest.fixture
def machine() -> Machine:
    return Machine()


@pytest.fixture
def app(settings: Settings, machine: Machine) -> FastAPI:
    return create_app(settings.model_copy(update=AWAY), machine.clock())


@pytest.fixture
def sender(app: FastAPI, anonymous: TestClient, mailroom: Mailroom) -> Browser:
    """Signed in without a mail."""
    browser = Browser(app)
    browser.portal = anonymous.portal
    browser.cookies["session"] = mailroom.call(_session_of, app, SENDER)
    return browser


async def _session_of(app: FastAPI, email: str) -> str:
    state = app.state.parts
    async with state.database.transaction() as session:
        person = await state.sign_in_service.person(session, email, state.clock.utc())
        return str(state.sign_in_service.open_session(session, person, "", state.clock.utc()))


@pytest.fixture
def column(mailroom: Mailroom) -> Callable[[Any], list[Any]]:
    """Read a column's values from the database."""

    async def read(which: Any) -> list[Any]:
        async with mailroom.app.state.parts.database.reading() as session:
            return list((await session.exec(select(which))).all())

    return lambda which: list(mailroom.call(read, which))


Column = Callable[[Any], list[Any]]


def time_acts(mailroom: Mailroom) -> None:
    """Everything that time alone decides looks once more than it does by itself."""
    state = mailroom.app.state.parts
    mailroom.call(state.timer.tick)
    mailroom.call(state.retention_job.keep_house)


def test_orders_outlive_a_leap_and_expire_in_their_time(
    sender: Browser, mailroom: Mailroom, machine: Machine, column: Column
) -> None:
    assert sender.order().status_code == 201
    machine.wall_s += 3 * DAY_S
    time.sleep(2.5)  # real seconds, in which the service's own timer looks twice
    time_acts(mailroom)
    assert column(Order.state) == ["queued"]
    assert sender.order().status_code == 201, "no person is signed out, and nothing stands still"
    machine.wall_s -= 3 * DAY_S
    machine.passes(DAY_S - 60)
    time_acts(mailroom)
    assert column(Order.state) == ["queued", "queued"], "also the one that was placed in the leap"
    machine.passes(120)
    time_acts(mailroom)
    assert column(Order.state) == ["expired", "expired"]


def test_an_order_that_is_placed_in_a_leap_backwards_lives_as_long(
    sender: Browser, mailroom: Mailroom, machine: Machine, column: Column
) -> None:
    machine.wall_s -= 3 * DAY_S
    assert sender.order().status_code == 201
    machine.wall_s += 3 * DAY_S
    time_acts(mailroom)
    assert column(Order.state) == ["queued"]


def test_a_leap_that_is_true_after_all_lets_orders_expire(
    sender: Browser, mailroom: Mailroom, machine: Machine, column: Column
) -> None:
    sender.order()
    machine.wall_s += 3 * DAY_S
    time_acts(mailroom)
    machine.passes(599)
    time_acts(mailroom)
    assert column(Order.state) == ["queued"]
    machine.passes(1)
    time_acts(mailroom)
    assert column(Order.state) == ["expired"]


def test_nothing_is_let_go_of_given_up_or_begun_in_a_leap(
    sender: Browser, mailroom: Mailroom, machine: Machine, column: Column, app: FastAPI
) -> None:
    wish = {**STANDING, "at": "09:30", "zone": "America/Toronto"}
    assert sender.post("/api/v1/standing-orders", json=wish, headers={"Idempotency-Key": "s"}).status_code == 201
    assert sender.order().status_code == 201
    planned = column(StandingOrder.next_at)
    mailroom.call(_wait_for_tries, app, 1)
    machine.wall_s += 500 * DAY_S
    mailroom.call(_try_again, app)
    mailroom.call(_wait_for_tries, app, 2)
    time_acts(mailroom)
    assert column(OutgoingNotification.gave_up_at) == [None], "its mail server has been away for a minute, not for days"
    assert column(StandingOrder.next_at) == planned
    assert len(column(Order.id)) == 1, "none of a standing order came round"
    assert len(column(PersonSession.id)) == 1, "whose lifetime is a month"


async def _try_again(app: FastAPI) -> None:
    """As a dispatcher does who taps: else it would be minutes until it is tried again."""
    async with app.state.parts.database.transaction() as session:
        for row in (await session.exec(select(OutgoingNotification))).all():
            row.next_try_at = app.state.parts.clock.utc()
    app.state.parts.outbox_worker.wake()


async def _wait_for_tries(app: FastAPI, tries: int) -> None:
    for _ in range(200):
        async with app.state.parts.database.reading() as session:
            wanted = select(OutgoingNotification.id).where(col(OutgoingNotification.tries) >= tries)
            if (await session.exec(wanted)).all():
                return
        await asyncio.sleep(0.05)
    raise AssertionError("it was not tried again")


def test_who_watches_sees_the_leap(anonymous: TestClient, app: FastAPI, machine: Machine) -> None:
    watcher = TestClient(app, base_url=HERE, client=("127.0.0.1", 50000))
    watcher.portal = anonymous.portal

    def figures() -> tuple[float, float]:
        families = text_string_to_metric_families(watcher.get("/metrics").text)
        found = {sample.name: sample.value for family in families for sample in family.samples}
        return found["campus_mail_clock_leapt_seconds"], found["campus_mail_clock_holds_on"]

    assert figures() == (0, 0)
    machine.wall_s -= 7200
    assert figures() == (-7200, 1)
    machine.wall_s += 7200
    assert figures() == (0, 0)


def test_after_a_start_far_from_the_newest_record_it_is_waited_and_seen(settings: Settings) -> None:
    """The clock may be a year ahead, or the service stood still for so long."""
    settings = settings.model_copy(update=AWAY)
    ordered(settings, NINE)
    machine = Machine(wall_s=NINE.timestamp() + 500 * DAY_S)
    app = create_app(settings, machine.clock())
    with TestClient(app, base_url=HERE) as client:
        mailroom = Mailroom(app, client)
        mailroom.call(_wait_for_tries, app, 2)
        time_acts(mailroom)
        assert mailroom.call(_found, app) == ("queued", False, 1)
        machine.passes(600)
        time_acts(mailroom)
        mailroom.call(_try_again, app)
        mailroom.call(_wait_for_tries, app, 3)
        assert mailroom.call(_found, app) == ("expired", True, 0)


async def _found(app: FastAPI) -> tuple[str, bool, int]:
    """The state of the order, whether the first notice of it was given up, and how many sessions are kept."""
    async with app.state.parts.database.reading() as session:
        gave_up = (
            await session.exec(select(OutgoingNotification.gave_up_at).order_by(col(OutgoingNotification.id)))
        ).first()
        sessions = (await session.exec(select(PersonSession.id))).all()
        return str((await session.exec(select(Order.state))).one()), gave_up is not None, len(sessions)


@sqlite_alone
@pytest.mark.nightly
def test_a_service_that_starts_so_waits_by_true_time(settings: Settings, tmp_path: Path) -> None:
    settings, settles_s = settings.model_copy(update=AWAY), 4.0
    ordered(settings, datetime.now(UTC) - timedelta(days=3))
    log = tmp_path / "log"
    with serving(settings.data, log, **AWAY, port=free_port(), clock_settles_s=settles_s) as process:
        until_s = time.monotonic() + 60
        while not (expired := asked(settings.data, "select at from order_events where state = 'expired'")):
            assert time.monotonic() < until_s, log.read_text()
            time.sleep(0.1)
        process.send_signal(signal.SIGTERM)
        process.wait(30)
    (line,) = said(log, "clock_not_confirmed_by_records")
    waited = datetime.fromisoformat(expired[0][0]).replace(tzinfo=UTC) - datetime.fromisoformat(line["timestamp"])
    assert waited.total_seconds() > settles_s - 0.5


def ordered(settings: Settings, at: datetime) -> None:
    """An order is placed, and its notice has not gone out."""
    app = create_app(settings, SteppedClock(started_at=at))
    with TestClient(app, base_url=HERE) as client:
        browser = Browser(app)
        browser.portal = client.portal
        assert client.portal is not None
        browser.cookies["session"] = client.portal.call(_session_of, app, SENDER)
        assert browser.order().status_code == 201
        client.portal.call(_wait_for_tries, app, 1)


def asked(data: Path, question: str) -> list[tuple[Any, ...]]:
    with closing(sqlite3.connect(data / "campus-mail.sqlite")) as database:
        return database.execute(question).fetchall()
