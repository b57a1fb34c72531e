"""Telling people why their orders wait, and until when: reason and time are written together."""

from collections.abc import Iterable
from datetime import datetime, timedelta
from typing import Any, Final

from sqlalchemy import bindparam, select
from sqlmodel import col

from app.core.errors import ServiceError
from app.dispatch.why_orders_wait import Answer
from app.models import Order, OrderState
from app.orders.ledger import Expected
from app.robots.service import Fleet
from fleet.eta.intervals import around

SOON_OVER: Final = timedelta(seconds=45)
"""An interval is renewed before it is over: dispatch looks again after 30 seconds at the latest."""


async def explain(fleet: Fleet, answers: Iterable[Answer]) -> None:
    """Each answer to its order, if it was told something else so far. It waits for no disk: what is lost is said
    again."""
    told = {answer.order_id: answer for answer in answers}
    if not told:
        return
    now = fleet.clock.utc()
    async with fleet.database.asking() as connection:
        rows = (await connection.execute(_TOLD, {"order_ids": list(told)})).all()
    expected = {row.id: _expected(fleet, row, told[row.id]) for row in rows}
    news = {row.id: told[row.id] for row in rows if _is_news(row, told[row.id], expected[row.id], now)}
    if not news:
        return
    async with fleet.database.transaction(durable=False) as session:
        for order_id, answer in sorted(news.items()):
            order = await fleet.orders.ledger.order(session, order_id)
            if order.state is OrderState.QUEUED:
                await fleet.orders.ledger.explain(session, order, answer.why, expected[order_id])


def _expected(fleet: Fleet, order: Any, answer: Answer) -> Expected | None:
    """From what was planned, else from what such orders have lately taken."""
    if not answer.has_time:
        return None
    if answer.comes_in_s is not None:
        now, interval = fleet.clock.utc(), around(answer.comes_in_s)
        return now + timedelta(seconds=interval.p10_s), now + timedelta(seconds=interval.p90_s)
    try:
        window = fleet.orders.placing.window(order.passed_on_at_post or order.from_post, order.to_post)
    except ServiceError:  # a post that the map has lost since
        return None
    return window.begins_at, window.ends_at


def _is_news(row: Any, answer: Answer, expected: Expected | None, now: datetime) -> bool:
    """A time that still holds is left as it is: people are to see an interval, not a countdown."""
    if row.why != answer.why:
        return True
    if expected is None or row.expected_from is None or row.expected_to is None:
        return (expected is None) != (row.expected_to is None)
    middle = expected[0] + (expected[1] - expected[0]) / 2
    return row.expected_to <= now + SOON_OVER or not row.expected_from <= middle <= row.expected_to


_TOLD: Final = select(
    *(col(Order.id), col(Order.why), col(Order.from_post), col(Order.to_post), col(Order.passed_on_at_post)),
    *(col(Order.expected_from), col(Order.expected_to)),
).where(col(Order.id).in_(bindparam("order_ids", expanding=True)), col(Order.state) == OrderState.QUEUED)
