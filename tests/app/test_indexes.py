"""Frequent queries walk along an index, so that they take no longer with a long history than with none."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from fastapi import FastAPI
from sqlalchemy import event
from sqlmodel import col, select, update

from app.models import Alarm, GrantRow, MissionRow, MissionState, Order, Person
from app.orders.idempotency import earlier_answers
from app.robots.link import outbox
from tests.app.conftest import ON_POSTGRESQL, SENDER, Browser, Mailroom

pytestmark = pytest.mark.skipif(ON_POSTGRESQL, reason="the plans that are read here are SQLite's")


@contextmanager
def asked(app: FastAPI) -> Iterator[list[tuple[str, Any]]]:
    """Every question to the database meanwhile."""
    questions: list[tuple[str, Any]] = []

    def note(_connection: Any, _cursor: Any, statement: str, values: Any, *_: Any) -> None:
        questions.append((statement, values))

    engine = app.state.parts.database.engine.sync_engine
    event.listen(engine, "before_cursor_execute", note)
    try:
        yield questions
    finally:
        event.remove(engine, "before_cursor_execute", note)


async def plan_of(app: FastAPI, statement: str, values: Any) -> str:
    async with app.state.parts.database.reading() as session:
        connection = await session.connection()
        rows = (await connection.exec_driver_sql(f"EXPLAIN QUERY PLAN {statement}", values)).all()
    return "; ".join(row[-1] for row in rows)


@pytest.mark.parametrize(
    ("role", "indexes"),
    [("sent", ["ix_orders_sent"]), ("coming", ["ix_orders_coming"]), ("all", ["ix_orders_sent", "ix_orders_coming"])],
)
def test_a_page_of_my_mail_walks_along_its_index(
    app: FastAPI, sender: Browser, mailroom: Mailroom, role: str, indexes: list[str]
) -> None:
    for _ in range(3):
        sender.order(recipient=SENDER)
    with asked(app) as questions:
        first = sender.get(f"/api/v1/orders?role={role}&limit=2").json()
        rest = sender.get(f"/api/v1/orders?role={role}&limit=2&cursor={first['next']}").json()
    assert [len(first["items"]), len(rest["items"])] == [2, 1], "an order from me to me is one order"
    walks = [one for one in questions if re.search(r"WHERE orders\.(sender|recipient)_id = ", one[0])]
    plans = [mailroom.call(plan_of, app, *walk) for walk in walks]
    assert len(plans) == 2 * len(indexes), "two pages"
    for index, plan in zip(indexes * 2, plans, strict=True):
        assert f"USING INDEX {index}" in plan
        assert "TEMP B-TREE" not in plan


@pytest.mark.parametrize(
    ("question", "index"),
    [
        ("role=sent&state=open", "ix_orders_state"),
        ("role=sent&state=ended&search=keys", "ix_orders_sent"),
        ("role=coming&search=keys", "ix_orders_coming"),
    ],
)
def test_what_goes_on_is_found_by_its_state_and_the_rest_along_its_index(
    app: FastAPI, sender: Browser, mailroom: Mailroom, question: str, index: str
) -> None:
    with asked(app) as questions:
        sender.get(f"/api/v1/orders?{question}")
    walk = next(one for one in questions if "FROM orders" in one[0] and "LIMIT" in one[0])
    assert f"USING INDEX {index}" in mailroom.call(plan_of, app, *walk)


def test_whom_i_have_named_is_found_by_the_orders_that_go_on(app: FastAPI, sender: Browser, mailroom: Mailroom) -> None:
    order_id = sender.order().json()["id"]
    sender.post(f"/api/v1/orders/{order_id}/delegates", json={"name": "The porter"})
    with asked(app) as questions:
        assert len(sender.get("/api/v1/me/delegates").json()["items"]) == 1
    # What the service asks of itself meanwhile is among them, but not for what one person has named.
    walks = [one for one in questions if "FROM delegates" in one[0] and "delegates.named_by_id = " in one[0]]
    plans = [mailroom.call(plan_of, app, *walk) for walk in walks]
    assert len(plans) == 2
    for plan in plans:
        assert "ix_delegates_order_id" in plan
        assert "ix_orders_state" in plan
        assert "SCAN" not in plan


NOT_OVER = {
    "what a robot is to be told": "ix_server_outbox_waiting",
    "robots that are to let go": "ix_orders_let_go",
    "missions that have changed": "ix_missions_untold",
    "corridors that are held": "ix_grants_held",
    "alarms that ring": "ix_alarms_ringing",
}


@pytest.mark.parametrize("what", NOT_OVER)
def test_what_is_not_over_is_found_without_what_is(app: FastAPI, mailroom: Mailroom, what: str) -> None:
    with asked(app) as questions:
        mailroom.call(ask, app, what)
    # What the service asks of itself meanwhile is among them.
    asked_for = [(one, values) for one, values in questions if one.startswith(("SELECT", "UPDATE"))]
    once = [(one, values[0] if isinstance(values, list) else values) for one, values in asked_for]
    plans = [mailroom.call(plan_of, app, *one) for one in once]
    assert any(NOT_OVER[what] in plan for plan in plans)


async def ask(app: FastAPI, what: str) -> None:
    now = app.state.parts.clock.utc()
    async with app.state.parts.database.transaction() as session:
        match what:
            case "what a robot is to be told":
                await outbox.acknowledged_by(session, {"r1": (0, 500)}, now)
            case "robots that are to let go":
                await session.exec(select(Order.id).where(col(Order.let_go_by).is_not(None)))
            case "missions that have changed":
                untold = col(MissionRow.told_update) < col(MissionRow.update_number)
                await session.exec(select(MissionRow.id).where(MissionRow.state == MissionState.ACTIVE, untold))
            case "corridors that are held":
                held = select(GrantRow).where(GrantRow.robot == "r1", col(GrantRow.cleared_at).is_(None))
                await session.exec(held.order_by(col(GrantRow.id)))
            case "alarms that ring":
                over = update(Alarm).where(col(Alarm.robot) == "r1", col(Alarm.cleared_at).is_(None))
                await session.exec(over.values(cleared_at=now))


def test_every_person_is_found_by_address_without_reading_all(app: FastAPI, mailroom: Mailroom) -> None:
    async def find() -> str:
        statement = select(Person).where(Person.email == SENDER)
        compiled = statement.compile(app.state.parts.database.engine.sync_engine)
        return await plan_of(app, str(compiled), (SENDER,))

    assert "USING INDEX" in mailroom.call(find)


def test_whether_requests_were_answered_before_is_found_by_their_keys_without_reading_all(
    app: FastAPI, sender: Browser, mailroom: Mailroom
) -> None:
    keys = [("one person", "a key"), ("another", "a key"), ("another", "another key")]

    async def look_up() -> list[str]:
        with asked(app) as questions:
            async with app.state.parts.database.transaction() as session:
                assert await earlier_answers(session, keys, app.state.parts.clock.utc()) == {}
        return [await plan_of(app, *one) for one in questions if "FROM idempotency_keys" in one[0]]

    (plan,) = mailroom.call(look_up)
    assert plan.startswith("SEARCH idempotency_keys USING INDEX")
