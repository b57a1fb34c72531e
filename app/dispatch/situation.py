"""What dispatch looks at: who waits, who is free, who is under way and could take something along."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final

from sqlalchemy import ColumnElement, and_, exists, or_
from sqlalchemy import select as sa_select
from sqlmodel import col, func, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.dispatch.choice import IdleRobot, WaitingOrder, counts_since
from app.dispatch.insertion import Tour, Visit
from app.orders.stops import left_of
from app.orders.transitions import MAIL_ABOARD
from app.tables import MissionRow, MissionState, Order, OrderState, Priority, RobotCommand, RobotRow, StopRow
from protocol.parts import Activity, StopAction

LOOKED_AT: Final = 50
"""So many of the longest waiting, and so many of the important ones, are looked at at once."""
TOURS: Final = 20
WAITING_AT_A_STOP: Final = (OrderState.AT_SENDER, OrderState.AT_RECIPIENT, OrderState.AT_RETURN)


@dataclass(frozen=True)
class Situation:
    """Longest waiting first."""

    waiting: Sequence[WaitingOrder]
    idle: Sequence[IdleRobot]
    connected: int


def is_waiting(now: datetime) -> ColumnElement[bool]:
    """Queued, and not left for later."""
    due = or_(col(Order.not_before).is_(None), col(Order.not_before) <= now)
    return and_(col(Order.state) == OrderState.QUEUED, due)


async def anything_waits(session: AsyncSession, now: datetime) -> bool:
    return (await session.exec(select(Order.id).where(is_waiting(now)).limit(1))).first() is not None


async def look(session: AsyncSession, now: datetime, head_start_s: float) -> Situation:
    """Everything that the choice needs, as columns."""
    connected = select(func.count()).select_from(RobotRow).where(col(RobotRow.online))
    return Situation(
        await _waiting(session, now, head_start_s), await _idle(session), (await session.exec(connected)).one()
    )


async def _waiting(session: AsyncSession, now: datetime, head_start_s: float) -> list[WaitingOrder]:
    # As columns, not as orders: nothing of them is changed here, and there may be many.
    wanted = _columns().where(is_waiting(now)).order_by(col(Order.created_at), col(Order.id)).limit(LOOKED_AT)
    connection = await session.connection()
    rows = {row[0]: row for row in (await connection.execute(wanted)).all()}
    if len(rows) == LOOKED_AT:  # the important ones behind these must not be overlooked
        high = wanted.where(col(Order.priority) == Priority.HIGH)
        rows |= {row[0]: row for row in (await connection.execute(high)).all()}
    longest = sorted(rows.values(), key=lambda row: (counts_since(row[5], row[6], head_start_s), row[0]))
    dropping = await _dropping(session, list(rows))
    return [
        WaitingOrder(row[0], row[1], row[2], row[3], row[4], frozenset(dropping.get(row[0], ()))) for row in longest
    ]


async def _dropping(session: AsyncSession, order_ids: Sequence[str]) -> dict[str, set[str]]:
    """Robots that were told to drop one of these orders and have not answered: they would drop it again."""
    if not order_ids:
        return {}
    asked = select(RobotCommand.order_id, RobotCommand.robot).where(
        col(RobotCommand.order_id).in_(order_ids),
        RobotCommand.kind == "cancel",
        col(RobotCommand.answered_at).is_(None),
    )
    dropping: dict[str, set[str]] = {}
    for order_id, robot in (await session.exec(asked)).all():
        dropping.setdefault(order_id or "", set()).add(robot)
    return dropping


def _columns() -> Any:
    who = (col(Order.id), col(Order.from_post), col(Order.to_post), col(Order.wanted_robot), col(Order.avoided_robot))
    return sa_select(*who, col(Order.created_at), col(Order.priority))


async def _idle(session: AsyncSession) -> list[IdleRobot]:
    """A robot that has mail aboard and no mission any more is no free robot: its mail comes first."""
    on_mission = exists().where(
        col(MissionRow.robot) == col(RobotRow.name), col(MissionRow.state) == MissionState.ACTIVE
    )
    carries = exists().where(col(Order.robot) == col(RobotRow.name), is_aboard())
    wanted = select(RobotRow.name, RobotRow.post, RobotRow.battery_ratio).where(
        col(RobotRow.online), col(RobotRow.activity) != Activity.STOPPED, ~on_mission, ~carries, ~is_recalled()
    )
    return [IdleRobot(*row) for row in (await session.exec(wanted)).all()]


def is_recalled() -> ColumnElement[bool]:
    """Told to come home, and not heard of since: what it is told next would cross with that."""
    return exists().where(
        col(RobotCommand.robot) == col(RobotRow.name),
        col(RobotCommand.answered_at).is_(None),
        col(RobotCommand.kind) == "recall",
    )


def is_aboard() -> ColumnElement[bool]:
    """The mail of an order is in its robot, as far as is known."""
    return or_(
        col(Order.state).in_(MAIL_ABOARD),
        and_(col(Order.state) == OrderState.ATTENTION, col(Order.state_before_attention).in_(MAIL_ABOARD)),
    )


async def tours(session: AsyncSession) -> list[Tour]:
    """Missions under way that may get one more order: of robots that can be told, and wait for nobody just now."""
    stands = exists().where(col(Order.robot) == col(RobotRow.name), col(Order.state).in_(WAITING_AT_A_STOP))
    in_trouble = exists().where(col(Order.robot) == col(RobotRow.name), col(Order.state) == OrderState.ATTENTION)
    commanded = exists().where(
        col(RobotCommand.robot) == col(RobotRow.name),
        col(RobotCommand.answered_at).is_(None),
        col(RobotCommand.kind).in_(("recall", "cancel")),
    )
    wanted = select(MissionRow.id, RobotRow.name, func.coalesce(RobotRow.towards, RobotRow.post)).where(
        col(MissionRow.robot) == col(RobotRow.name),
        col(MissionRow.state) == MissionState.ACTIVE,
        ~col(MissionRow.id).startswith("return-"),
        col(RobotRow.online),
        col(RobotRow.activity) != Activity.STOPPED,
        ~stands,
        ~in_trouble,
        ~commanded,
    )
    rows = (await session.exec(wanted.order_by(col(MissionRow.created_at)).limit(TOURS))).all()
    return [await tour_of(session, mission_id, robot, post) for mission_id, robot, post in rows]


async def tour_of(session: AsyncSession, mission_id: str, robot: str, post: str | None) -> Tour:
    """What is left of a mission, as a way; it may turn aside wherever it comes to next."""
    stops = (await session.exec(left_of(mission_id))).all()
    aboard = select(func.count()).select_from(Order).where(Order.robot == robot, is_aboard())
    return Tour(
        robot=robot,
        start=post,
        visits=tuple(visit_of(stop) for stop in stops),
        aboard=(await session.exec(aboard)).one(),
    )


def visit_of(stop: StopRow) -> Visit:
    """A stop as a part of a way."""
    change = {StopAction.LOAD: 1, StopAction.RECEIVE: -1, StopAction.RETURN: -1}.get(StopAction(stop.action), 0)
    return Visit(stop.id, stop.post, change)
