"""Orders as records: plain values with names and addresses, for those who may see everything."""

import csv
import io
import os
import sys
from collections.abc import AsyncIterator, Iterable, Sequence
from contextlib import ExitStack
from datetime import datetime
from pathlib import Path
from typing import Any, Final, TextIO

from sqlalchemy import tuple_
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.errors import StartError
from app.models import Delegate, Handover, Order, OrderEvent, OrderState, Person
from app.models.orders.order_events import MOVED
from app.orders.transitions import ENDED

AT_ONCE: Final = 500
_LEFT_OUT: Final = {"sender_id", "recipient_id", "placed_by_id"}
CSV_COLUMNS: Final = (
    "id", "state", "priority", "created_at", "updated_at", "sender", "recipient", "placed_by",
    "from_post", "to_post", "description", "robot", "window_from", "window_to", "loaded_at", "ended_at",
)  # fmt: skip
FORMULAS: Final = ("=", "+", "-", "@", "\t", "\r")
Place = tuple[datetime, str]
"""Of an order among all: when it was made, and its id."""


class NoSuchOrder(StartError):
    """There is no order with this id."""


async def orders_of(
    session: AsyncSession, states: Sequence[OrderState] = (), newest: int | None = None
) -> AsyncIterator[dict[str, Any]]:
    """Return all orders from the oldest on, or the newest ones first; fetched in portions, so that there may be
    many."""
    emails: dict[str, str] = {}
    wanted = select(Order).order_by(col(Order.created_at), col(Order.id))
    if states:
        wanted = wanted.where(col(Order.state).in_(states))
    if newest is not None:
        wanted = wanted.order_by(None).order_by(col(Order.created_at).desc(), col(Order.id)).limit(newest)
    offset = 0
    while orders := (await session.exec(wanted.offset(offset).limit(min(AT_ONCE, newest or AT_ONCE)))).all():
        times = await _times(session, orders)
        for order in orders:
            yield {**await _record(session, order, emails), **times[order.id]}
        offset += len(orders)
        if newest is not None and offset >= newest:
            return
        session.expunge_all()


async def portion(
    session: AsyncSession,
    begin: datetime,
    end: datetime,
    after: Place | None,
    emails: dict[str, str],
    at_once: int = AT_ONCE,
) -> tuple[list[dict[str, Any]], Place | None]:
    """Some of the orders made from `begin` on and before `end`, from the oldest on, and the place of the last one; None
    if that was all. `emails` remembers people from one portion to the next."""
    place = (col(Order.created_at), col(Order.id))
    wanted = select(Order).where(place[0] >= begin, place[0] < end).order_by(*place).limit(at_once)
    if after is not None:
        wanted = wanted.where(tuple_(*place) > after)
    orders = (await session.exec(wanted)).all()
    times = await _times(session, orders)
    records = [{**await _record(session, order, emails), **times[order.id]} for order in orders]
    return records, (orders[-1].created_at, orders[-1].id) if len(orders) == at_once else None


async def _times(session: AsyncSession, orders: Sequence[Order]) -> dict[str, dict[str, str | None]]:
    """When each was first loaded and when it ended, by the robot's clock where a robot said so."""
    times = {order.id: dict[str, str | None](loaded_at=None, ended_at=None) for order in orders}
    wanted = (
        select(OrderEvent.order_id, OrderEvent.state, OrderEvent.robot_at, OrderEvent.at)
        .where(col(OrderEvent.order_id).in_(list(times)), OrderEvent.kind == MOVED)
        .where(col(OrderEvent.state).in_([OrderState.CARRYING, *ENDED]))
        .order_by(col(OrderEvent.seq).desc())
    )
    for order_id, state, robot_at, at in (await session.exec(wanted)).all():
        moment = (robot_at or at).isoformat().replace("+00:00", "Z")
        times[order_id]["loaded_at" if state is OrderState.CARRYING else "ended_at"] = moment
    return times


async def one_order(session: AsyncSession, order_id: str) -> dict[str, Any]:
    """One order with the events of its life and the chain of custody. Raises NoSuchOrder."""
    order = await session.get(Order, order_id)
    if order is None:
        raise NoSuchOrder(f"There is no order {order_id}. Their ids: orders list.")
    emails: dict[str, str] = {}
    events = (await session.exec(select(OrderEvent).filter_by(order_id=order_id).order_by(col(OrderEvent.seq)))).all()
    handovers = (await session.exec(select(Handover).filter_by(order_id=order_id).order_by(col(Handover.id)))).all()
    return {
        **await _record(session, order, emails),
        "events": [await _with_person(session, event, emails) for event in events],
        "custody": [
            {**await _with_person(session, row, emails), "delegate": await _delegate(session, row)} for row in handovers
        ],
    }


async def write_csv(orders: AsyncIterator[dict[str, Any]], to: Path | None) -> int:
    """Write orders as CSV to a new file that other users may not read, or to stdout; how many. Raises StartError."""
    with ExitStack() as closing:
        file = closing.enter_context(_new_file(to)) if to else sys.stdout
        file.write(csv_head())
        count = 0
        async for order in orders:
            file.write(csv_lines([order]))
            count += 1
    return count


def csv_head() -> str:
    """The names of the columns."""
    return ",".join(CSV_COLUMNS) + "\r\n"


def csv_lines(orders: Iterable[dict[str, Any]]) -> str:
    """A line for each order (RFC 4180)."""
    lines = io.StringIO(newline="")
    table = csv.DictWriter(lines, CSV_COLUMNS, extrasaction="ignore")
    table.writerows({name: _harmless(value) for name, value in order.items()} for order in orders)
    return lines.getvalue()


def _new_file(path: Path) -> TextIO:
    try:
        return os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", newline="", encoding="utf-8")
    except OSError as error:
        raise StartError(f"{path} cannot be written: {error.strerror}. Choose another file: --to FILE.") from None


def _harmless(value: Any) -> Any:
    """Spreadsheets run what begins like a formula, and people write descriptions."""
    return f"'{value}" if isinstance(value, str) and value.lstrip(" ").startswith(FORMULAS) else value


async def _record(session: AsyncSession, order: Order, emails: dict[str, str]) -> dict[str, Any]:
    return {
        **order.model_dump(mode="json", exclude=_LEFT_OUT),
        "sender": await _email(session, order.sender_id, emails),
        "recipient": await _email(session, order.recipient_id, emails),
        "placed_by": await _email(session, order.placed_by_id, emails),
    }


async def _with_person(session: AsyncSession, row: OrderEvent | Handover, emails: dict[str, str]) -> dict[str, Any]:
    fields = row.model_dump(mode="json", exclude={"order_id", "person_id", "code_sha256"})
    return {**fields, "person": await _email(session, row.person_id, emails)}


async def _delegate(session: AsyncSession, row: Handover) -> str | None:
    return (await session.get_one(Delegate, row.delegate_id)).name if row.delegate_id else None


async def _email(session: AsyncSession, person_id: str | None, emails: dict[str, str]) -> str | None:
    if person_id is None:
        return None
    if person_id not in emails:
        emails[person_id] = (await session.get_one(Person, person_id)).email
    return emails[person_id]
