"""Data that may not be kept is deleted at its time, not before, and no request waits for that."""

import asyncio
import os
import time
from collections.abc import Mapping
from datetime import timedelta
from typing import Any

import pytest
from sqlmodel import SQLModel, select

from app.models import (
    Alarm,
    BatterySample,
    ClaimRow,
    Delegate,
    DurationRow,
    EnrolmentCode,
    ForecastUnderWayRow,
    GrantRow,
    Handover,
    IdempotencyKey,
    MessageToRobot,
    Notification,
    NotificationKind,
    Order,
    OrderEvent,
    OrderLink,
    OutgoingNotification,
    Person,
    PersonSession,
    PersonToken,
    RefusedReceipt,
    RobotCommand,
    RobotMessage,
    SignInCode,
    StandingOrder,
)
from app.retention import retention
from app.retention.database_checks import problems_of
from app.retention.retention import RULES, retain
from app.retention.retention_job import RetentionJob
from protocol.clock import SteppedClock
from tests.app.conftest import RECIPIENT, SENDER, Browser, Mailroom

DAY_S = 86400.0
NO_TIME = {f"{whose}_{share}_s": 0.0 for whose in ("raw", "told", "map") for share in ("p10", "p50", "p90")}

pytestmark = pytest.mark.mailed_codes


class Kept:
    """The database, day by day."""

    def __init__(self, mailroom: Mailroom, clock: SteppedClock) -> None:
        self._mailroom, self._clock = mailroom, clock
        self._state = mailroom.app.state.parts

    def retain_after(self, days: float) -> Mapping[str, int]:
        self._clock.advance(days * DAY_S)
        done: Mapping[str, int] = self._mailroom.call(
            retain, self._state.database, self._state.settings, self._clock.utc(), time.time()
        )
        return done

    def add(self, *rows: SQLModel) -> None:
        async def write() -> None:
            async with self._state.database.transaction() as session:
                for row in rows:
                    session.add(row)
                    await session.flush()

        self._mailroom.call(write)

    def rows(self, table: type[SQLModel]) -> list[Any]:
        async def read() -> list[Any]:
            async with self._state.database.reading() as session:
                return list((await session.exec(select(table))).all())

        found: list[Any] = self._mailroom.call(read)
        return found

    def problems(self) -> list[str]:
        async def look() -> list[str]:
            async with self._state.database.engine.connect() as connection:
                return list(await connection.run_sync(problems_of))

        found: list[str] = self._mailroom.call(look)
        return found


@pytest.fixture
def kept(mailroom: Mailroom, clock: SteppedClock) -> Kept:
    return Kept(mailroom, clock)


def delivered(sender: Browser, mailroom: Mailroom) -> str:
    order_id: str = sender.order(description="For Ada").json()["id"]
    mailroom.move(order_id, "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered")
    return order_id


def test_an_order_keeps_its_names_for_400_days_and_its_life_for_ever(
    kept: Kept, sender: Browser, mailroom: Mailroom, clock: SteppedClock
) -> None:
    order_id = sender.order(description="For Ada").json()["id"]
    assert sender.post(f"/api/v1/orders/{order_id}/delegates", json={"name": "Eve"}).status_code == 201
    mailroom.move(order_id, "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered")
    now, ada = clock.utc(), kept.rows(Order)[0].sender_id
    stop = {"order_id": order_id, "stop_id": "s1", "purpose": "load", "robot": "r1", "post": "post1"}
    kept.add(Handover(**stop, robot_at=now, at=now, person_id=ada, how="tap"))
    assert "orders" not in kept.retain_after(399.0)
    assert kept.rows(Order)[0].description == "For Ada"
    assert kept.retain_after(1.5)["orders"] == 1
    (order,) = kept.rows(Order)
    assert (order.sender_id, order.recipient_id, order.description) == ("nobody", "nobody", None)
    assert order.state == "delivered"
    assert len(kept.rows(OrderEvent)) == 8
    assert {event.person_id for event in kept.rows(OrderEvent)} == {None}
    assert [event.reason for event in kept.rows(OrderEvent) if event.kind == "delegate_named"] == ["Erased"]
    assert [(row.purpose, row.robot, row.person_id) for row in kept.rows(Handover)] == [("load", "r1", None)]
    assert [(row.name, row.named_by_id) for row in kept.rows(Delegate)] == [("Erased", "nobody")]
    assert kept.rows(Notification) == kept.rows(OutgoingNotification) == []
    assert kept.problems() == []
    assert "orders" not in kept.retain_after(1)


def test_who_has_no_order_left_and_is_signed_in_nowhere_is_forgotten(
    kept: Kept, sender: Browser, mailroom: Mailroom
) -> None:
    delivered(sender, mailroom)
    kept.retain_after(401)
    assert {person.email for person in kept.rows(Person)} & {SENDER, RECIPIENT} == set()


def test_an_order_that_has_not_ended_keeps_everything(kept: Kept, sender: Browser, mailroom: Mailroom) -> None:
    mailroom.move(sender.order(description="Lost").json()["id"], "assigned", "to_sender", "at_sender", "carrying")
    kept.retain_after(500)
    (order,) = kept.rows(Order)
    assert (order.description, order.state) == ("Lost", "carrying")
    assert {person.email for person in kept.rows(Person)} >= {SENDER, RECIPIENT}


def alarm_notice(person: str, clock: SteppedClock) -> Notification:
    facts = {"robot": "r1", "reason": "It stands.", "post": ""}
    return Notification(key="alarm.1", kind=NotificationKind.ALARM, person_id=person, at=clock.utc(), facts=facts)


def technical_rows(clock: SteppedClock, order_id: str, ada: str, notice: int) -> list[SQLModel]:
    """One of everything that is over now."""
    now = clock.utc()
    robot: dict[str, Any] = {"robot": "r1"}
    place = {"stop_id": "s1", "purpose": "load", "post": "post1"}
    life: dict[str, Any] = {"created_at": now, "expires_at": now}
    legs = {"corridor": "a-b", "from_post": "a", "to_post": "b"}
    given_up: dict[str, Any] = {"created_at": now, "next_try_at": None, "gave_up_at": now}
    return [
        Alarm(**robot, name="bumped", reason="…", at=now, cleared_at=now),
        RefusedReceipt(**robot, **place, order_id=order_id, how="code", robot_at=now, at=now, problem="bad_signature"),
        RobotCommand(**robot, command_id="c1", kind="pause", asked_by_id=ada, asked_at=now),
        BatterySample(**robot, at=now, ratio=0.5, charging=False),
        DurationRow(kind="corridor", name="post1 post2", assumed_s=20.0, seconds=30.0, at=now),
        ForecastUnderWayRow(order_id="o1", is_aboard=False, told_at=now, **NO_TIME),
        RobotMessage(**robot, journal="j", seq=1, type="event", body={}, sent_at=now, received_at=now),
        MessageToRobot(**robot, seq=90, type="mission", body={}, created_at=now, acked_at=now),
        GrantRow(**robot, **legs, claim_id="c1", granted_at=now, cleared_at=now),
        ClaimRow(**robot, claim_id="c1", legs=[], at=now, granted=False),
        alarm_notice(ada, clock),
        OutgoingNotification(key="k1", channel="webhook", notice_id=notice, **given_up),
        SignInCode(email=SENDER, code_hash="h", **life),
        EnrolmentCode(robot="r2", code_hash="h", **life),
        PersonSession(token_hash="h1", person_id=ada, **life),
        PersonToken(prefix="p", secret_hash="h", person_id=ada, name="script", scopes=[], **life),
        OrderLink(nonce="n", order_id=order_id, person_id=ada, token_hash="h", **life),
        IdempotencyKey(person_id=ada, key="k", body_hash="h", status=201, headers={}, answer={}, created_at=now),
        StandingOrder(id="w1", sender_id=ada, recipient_id=ada, from_post="a", to_post="b", weekdays=[0], at="09:00",
                      zone="UTC", created_at=now, ended_at=now, description="Weekly"),
    ]  # fmt: skip


def test_everything_technical_goes_when_its_days_are_over_and_not_a_day_before(
    kept: Kept, sender: Browser, mailroom: Mailroom, clock: SteppedClock
) -> None:
    mailroom.robot_connects()
    order_id = sender.order().json()["id"]
    ada, notice = kept.rows(Order)[0].sender_id, kept.rows(Notification)[0].id
    rows = technical_rows(clock, order_id, ada, notice)
    kept.add(*rows)
    names = {rule.name: rule.days for rule in RULES}
    days = {"keep_traces_days": 7, "keep_telemetry_days": 30, "keep_orders_days": 400}
    day = 0.0
    for setting, limit in days.items():
        before = kept.retain_after(limit - 0.5 - day)
        day = limit + 0.5
        done = kept.retain_after(1)
        due = {name for name, wanted in names.items() if wanted == setting} - {"orders", "people"}
        assert due <= set(done), due - set(done)
        assert not due & set(before), before
    tables = {type(row) for row in rows} - {StandingOrder, Notification, OutgoingNotification}
    assert {table.__name__: kept.rows(table) for table in tables} == {table.__name__: [] for table in tables}
    (standing,) = kept.rows(StandingOrder)
    assert (standing.sender_id, standing.description) == ("nobody", None)


def test_what_dispatchers_were_told_of_an_alarm_goes_400_days_after_it(
    kept: Kept, sender: Browser, mailroom: Mailroom, clock: SteppedClock
) -> None:
    sender.order()
    now, ada = clock.utc(), kept.rows(Order)[0].sender_id
    of_alarm = alarm_notice(ada, clock)
    kept.add(of_alarm)
    of_order = {notice.key for notice in kept.rows(Notification)} - {of_alarm.key}
    assert of_order
    sending = {"channel": "webhook", "created_at": now, "next_try_at": None, "gave_up_at": now}
    kept.add(OutgoingNotification(key="k1", notice_id=of_alarm.id, **sending))
    assert "notices of alarms" not in kept.retain_after(399.5)
    assert kept.retain_after(1)["notices of alarms"] == 1
    left = {notice.key for notice in kept.rows(Notification)}
    assert of_alarm.key not in left
    assert of_order <= left, "those of orders stay as long as their order has names"
    assert kept.problems() == []


def test_what_a_robot_still_has_to_hear_or_to_clear_stays_however_old(kept: Kept, clock: SteppedClock) -> None:
    now = clock.utc()
    legs = {"corridor": "a-b", "from_post": "a", "to_post": "b"}
    kept.add(
        MessageToRobot(robot="r1", seq=90, type="mission", body={}, created_at=now),
        GrantRow(robot="r1", claim_id="c1", granted_at=now, **legs),
        ClaimRow(robot="r1", claim_id="c1", legs=[], at=now),
        Alarm(robot="r1", name="bumped", reason="…", at=now),
    )
    kept.retain_after(1000)
    assert [len(kept.rows(table)) for table in (MessageToRobot, GrantRow, ClaimRow, Alarm)] == [1, 1, 1, 1]


def test_much_goes_in_portions_and_another_writer_comes_in_between(
    kept: Kept, mailroom: Mailroom, clock: SteppedClock, monkeypatch: pytest.MonkeyPatch
) -> None:
    now, state = clock.utc(), mailroom.app.state.parts
    message = {"robot": "r1", "journal": "j", "type": "event", "body": {}, "sent_at": now, "received_at": now}
    kept.add(*(RobotMessage(seq=seq, **message) for seq in range(1, 2 * retention.PORTION + 51)))

    async def retain_and_write() -> tuple[Mapping[str, int], int]:
        retaining = asyncio.create_task(retain(state.database, state.settings, now + timedelta(days=31), time.time()))
        left = 2 * retention.PORTION + 50
        while left == 2 * retention.PORTION + 50:
            async with state.database.transaction() as session:
                session.add(Person(id=os.urandom(8).hex(), email=f"{time.monotonic_ns()}@x", name="n", created_at=now))
                left = len((await session.exec(select(RobotMessage.seq))).all())
        return await retaining, left

    done, left = mailroom.call(retain_and_write)
    assert done["robot messages"] == 2 * retention.PORTION + 50
    assert left in (retention.PORTION + 50, 50)


def test_mails_in_the_spool_go_by_the_files_age(kept: Kept, sender: Browser, mailroom: Mailroom) -> None:
    folder = mailroom.app.state.parts.settings.spool_folder
    (old, *_) = folder.glob("*.eml")
    new = folder / "new.eml"
    new.write_text("To: ada\n\n")
    os.utime(old, (0, time.time() - 31 * DAY_S))
    assert kept.retain_after(0)["mails in the spool"] == 1
    assert (old.exists(), new.exists()) == (False, True)


async def test_the_housekeeper_ends_at_once_when_told_to(mailroom: Mailroom, clock: SteppedClock) -> None:
    state = mailroom.app.state.parts
    retention_job = RetentionJob(state.database, state.settings, clock)
    running = asyncio.create_task(retention_job.run())
    await asyncio.sleep(0)
    retention_job.stop()
    async with asyncio.timeout(10):  # it rests for hours
        await running
