"""Work that waits for dispatch: orders without a robot, and what robots have to be told."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, Final

from sqlalchemy import (
    ColumnElement,
    CompoundSelect,
    and_,
    bindparam,
    exists,
    func,
    literal,
    or_,
    select,
    union_all,
)
from sqlalchemy.ext.asyncio import AsyncConnection
from sqlmodel import col

from app.models import MissionRow, MissionState, Order, OrderState, Priority
from app.orders.transitions import MAIL_ABOARD

HEAD_START_S: Final = 1800.0
"""High priority counts like so much longer waiting, low like so much less."""
HEAD_STARTS: Final = {Priority.LOW: -1, Priority.NORMAL: 0, Priority.HIGH: 1}
WAITING_AT_A_STOP: Final = (OrderState.AT_SENDER, OrderState.AT_RECIPIENT, OrderState.AT_RETURN)


@dataclass(frozen=True)
class PendingWork:
    """Work to do for dispatch: orders that a robot is to drop, missions to tell, and if orders wait."""

    dropped: Sequence[str]
    changed: Sequence[str]
    waits: bool


def counts_since(created_at: datetime, priority: Priority) -> datetime:
    """Since when an order counts as waiting: so the important go first, and none waits for ever."""
    return created_at - timedelta(seconds=HEAD_STARTS[priority] * HEAD_START_S)


async def read_pending_work(connection: AsyncConnection, now: datetime) -> PendingWork:
    """One question, since it is asked after every change."""
    rows = (await connection.execute(_PENDING, {"now": now})).all()
    return PendingWork(
        [row.id for row in rows if row.what == "drop"],
        [row.id for row in rows if row.what == "tell"],
        any(row.what == "give" for row in rows),
    )


def is_waiting() -> ColumnElement[bool]:
    """Queued, and not left for later than `now`."""
    due = or_(col(Order.not_before).is_(None), col(Order.not_before) <= bindparam("now"))
    return and_(col(Order.state) == OrderState.QUEUED, due)


def is_aboard() -> ColumnElement[bool]:
    """The mail of an order is in its robot, as far as is known."""
    return or_(
        col(Order.state).in_(MAIL_ABOARD),
        and_(col(Order.state) == OrderState.ATTENTION, col(Order.state_before_attention).in_(MAIL_ABOARD)),
    )


# Put together once: that takes several times as long as asking.
LOAD_POST: Final = func.coalesce(col(Order.passed_on_at_post), col(Order.from_post)).label("from_post")
"""As `Order.load_post`."""
_PENDING: Final[CompoundSelect[Any]] = union_all(
    select(literal("drop").label("what"), col(Order.id).label("id")).where(col(Order.let_go_by).is_not(None)),
    select(literal("tell"), col(MissionRow.id)).where(
        col(MissionRow.state) == MissionState.ACTIVE, col(MissionRow.told_update) < col(MissionRow.update_number)
    ),
    select(literal("give"), literal("")).where(exists().where(is_waiting())),
)
