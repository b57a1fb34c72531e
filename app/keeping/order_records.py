"""Orders as records: plain values with names and addresses, for whoever may see everything."""

import csv
import os
import sys
from collections.abc import AsyncIterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Final, TextIO

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.errors import StartError
from app.tables import Delegate, Handover, Order, OrderEvent, OrderState, Person

AT_ONCE: Final = 500
_LEFT_OUT: Final = {"sender_id", "recipient_id", "placed_by_id"}
CSV_COLUMNS: Final = (
    "id", "state", "priority", "created_at", "updated_at", "sender", "recipient", "placed_by",
    "from_post", "to_post", "description", "robot", "window_from", "window_to",
)  # fmt: skip


class NoSuchOrder(StartError):
    """There is no order with this id."""


async def orders_of(
    session: AsyncSession, states: Sequence[OrderState] = (), newest: int | None = None
) -> AsyncIterator[dict[str, Any]]:
    """All orders from the oldest on, or the newest ones first; fetched in portions, so that there may be many."""
    emails: dict[str, str] = {}
    wanted = select(Order).order_by(col(Order.created_at), col(Order.id))
    if states:
        wanted = wanted.where(col(Order.state).in_(states))
    if newest is not None:
        wanted = wanted.order_by(None).order_by(col(Order.created_at).desc(), col(Order.id)).limit(newest)
    offset = 0
    while orders := (await session.exec(wanted.offset(offset).limit(min(AT_ONCE, newest or AT_ONCE)))).all():
        for order in orders:
            yield await _record(session, order, emails)
        offset += len(orders)
        if newest is not None and offset >= newest:
            return
        session.expunge_all()


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
    """Write orders as CSV to a new file that nobody else may read, or to stdout; how many. Raises StartError."""
    with ExitStack() as closing:
        file = closing.enter_context(_new_file(to)) if to else sys.stdout
        table = csv.DictWriter(file, CSV_COLUMNS, extrasaction="ignore")
        table.writeheader()
        count = 0
        async for order in orders:
            table.writerow({name: _harmless(value) for name, value in order.items()})
            count += 1
    return count


def _new_file(path: Path) -> TextIO:
    try:
        return os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", newline="", encoding="utf-8")
    except OSError as error:
        raise StartError(f"{path} cannot be written: {error.strerror}. Choose another file: --to FILE.") from None


def _harmless(value: Any) -> Any:
    """Spreadsheets run what begins like a formula, and people write descriptions."""
    return f"'{value}" if isinstance(value, str) and value.startswith(("=", "+", "-", "@", "\t")) else value


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
