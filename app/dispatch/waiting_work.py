"""The situation of dispatch: orders that wait, robots that are free, robots under way that could take something
along."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, Final

from sqlalchemy import (
    ColumnElement,
    CompoundSelect,
    Integer,
    Select,
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
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import connection_of
from app.dispatch.choice import ENOUGH_CHARGE, IdleRobot, WaitingOrder
from app.dispatch.insertion import Tour, Visit
from app.models import MissionRow, MissionState, Order, OrderState, Priority, RobotCommand, RobotRow, StopRow
from app.orders.stops import stops_left
from app.orders.transitions import MAIL_ABOARD
from app.robots.homes import WITHOUT_A_HOME
from protocol.parts import Activity, StopAction

LOOKED_AT: Final = 50
"""So many of the longest waiting, and so many of the important ones, are looked at at once."""
TOURS: Final = 20
HEAD_START_S: Final = 1800.0
"""High priority counts like so much longer waiting, low like so much less."""
HEAD_STARTS: Final = {Priority.LOW: -1, Priority.NORMAL: 0, Priority.HIGH: 1}
WAITING_AT_A_STOP: Final = (OrderState.AT_SENDER, OrderState.AT_RECIPIENT, OrderState.AT_RETURN)


@dataclass(frozen=True)
class WaitingAndIdle:
    """Longest waiting first, and of the robots that could fetch it as many at each post as could be chosen."""

    waiting: Sequence[WaitingOrder]
    idle: Sequence[IdleRobot]


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


async def look(session: AsyncSession, now: datetime) -> WaitingAndIdle:
    """Everything that the choice needs, as columns."""
    waiting = await _waiting(session, now)
    return WaitingAndIdle(waiting, await _nearby(session, waiting))


async def _waiting(session: AsyncSession, now: datetime) -> list[WaitingOrder]:
    # As columns, not as orders: nothing of them is changed here, and there may be many.
    connection = await connection_of(session)
    rows = {row.id: row for row in (await connection.execute(_WAITING, {"now": now})).all()}
    if len(rows) == LOOKED_AT:  # the important ones behind these must not be overlooked
        rows |= {row.id: row for row in (await connection.execute(_IMPORTANT, {"now": now})).all()}
    longest = sorted(rows.values(), key=lambda row: (counts_since(row.created_at, row.priority), row.id))
    dropping = await _dropping(session, [row.id for row in rows.values() if row.is_dropped])
    return [WaitingOrder(*row[:5], frozenset(dropping.get(row.id, ()))) for row in longest]


async def _dropping(session: AsyncSession, order_ids: Sequence[str]) -> dict[str, set[str]]:
    """Robots that were told to drop one of these orders and have not answered: they would drop it again."""
    if not order_ids:
        return {}
    asked = await (await connection_of(session)).execute(_DROPPING, {"order_ids": order_ids})
    dropping: dict[str, set[str]] = {}
    for order_id, robot in asked.all():
        dropping.setdefault(str(order_id), set()).add(robot)
    return dropping


async def _nearby(session: AsyncSession, waiting: Sequence[WaitingOrder]) -> list[IdleRobot]:
    """Each order takes the first at some post that it may go with: more than that there need not be of any post."""
    if not waiting:
        return []
    not_with = {robot for order in waiting for robot in (*order.dropping, order.avoided) if robot}
    wanted = {order.wanted for order in waiting if order.wanted}
    asked = {"at_each_post": len(waiting) + len(not_with), "wanted": list(wanted)}
    return [IdleRobot(*row) for row in (await (await connection_of(session)).execute(_NEARBY, asked)).all()]


async def idle_robots(session: AsyncSession) -> list[IdleRobot]:
    """Connected and with nothing to do, charged or not."""
    return [IdleRobot(*row) for row in (await (await connection_of(session)).execute(_IDLE)).all()]


async def connected_robots(session: AsyncSession) -> int:
    return int((await (await connection_of(session)).execute(_CONNECTED)).scalar_one())


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


def _is_idle() -> ColumnElement[bool]:
    """A robot that has mail aboard and no mission any more is no free robot: its mail comes first. Nor is one that was
    told to come home and not heard of since: what it is told next would cross with that."""
    on_mission = exists().where(
        col(MissionRow.robot) == col(RobotRow.name), col(MissionRow.state) == MissionState.ACTIVE
    )
    carries = exists().where(col(Order.robot) == col(RobotRow.name), is_aboard())
    is_recalled = exists().where(
        col(RobotCommand.robot) == col(RobotRow.name),
        col(RobotCommand.answered_at).is_(None),
        col(RobotCommand.kind) == "recall",
    )
    can_drive = and_(col(RobotRow.activity) != Activity.STOPPED, col(RobotRow.taken_out_at).is_(None))
    is_there = and_(col(RobotRow.online), can_drive, col(RobotRow.name).not_in(WITHOUT_A_HOME))
    return and_(is_there, ~on_mission, ~carries, ~is_recalled)


def _nearby_robots() -> Select[Any]:
    fullest_first = (col(RobotRow.battery_ratio).desc(), col(RobotRow.name))
    place = func.row_number().over(partition_by=col(RobotRow.post), order_by=fullest_first)
    able = select(*_OF_ROBOT, place.label("place")).where(_is_idle(), col(RobotRow.battery_ratio) >= ENOUGH_CHARGE)
    ranked = able.subquery()
    is_near = ranked.c.place <= bindparam("at_each_post", type_=Integer)
    is_wanted = ranked.c.name.in_(bindparam("wanted", expanding=True))
    return select(*(ranked.c[name] for name in _COLUMNS)).where(or_(is_near, is_wanted))


# Put together once: that takes several times as long as asking.
_COLUMNS: Final = ("name", "post", "battery_ratio", "charging", "docked", "home")
"""Of `RobotRow`, as `IdleRobot` has them."""
_OF_ROBOT: Final = tuple(col(getattr(RobotRow, name)) for name in _COLUMNS)
_NEARBY: Final = _nearby_robots()
_IDLE: Final = select(*_OF_ROBOT).where(_is_idle())
_CONNECTED: Final = select(func.count()).select_from(RobotRow).where(col(RobotRow.online))
_IS_DROPPED: Final = and_(col(RobotCommand.kind) == "cancel", col(RobotCommand.answered_at).is_(None))
LOAD_POST: Final = func.coalesce(col(Order.passed_on_at_post), col(Order.from_post)).label("from_post")
"""As `Order.load_post`."""
_WAITING: Final = (
    select(
        *(col(Order.id), LOAD_POST, col(Order.to_post), col(Order.wanted_robot), col(Order.avoided_robot)),
        *(col(Order.created_at), col(Order.priority)),
        exists().where(col(RobotCommand.order_id) == col(Order.id), _IS_DROPPED).label("is_dropped"),
    )
    .where(is_waiting())
    .order_by(col(Order.created_at), col(Order.id))
    .limit(LOOKED_AT)
)
_IMPORTANT: Final = _WAITING.where(col(Order.priority) == Priority.HIGH)
_DROPPING: Final = select(col(RobotCommand.order_id), col(RobotCommand.robot)).where(
    col(RobotCommand.order_id).in_(bindparam("order_ids", expanding=True)), _IS_DROPPED
)
_PENDING: Final[CompoundSelect[Any]] = union_all(
    select(literal("drop").label("what"), col(Order.id).label("id")).where(col(Order.let_go_by).is_not(None)),
    select(literal("tell"), col(MissionRow.id)).where(
        col(MissionRow.state) == MissionState.ACTIVE, col(MissionRow.told_update) < col(MissionRow.update_number)
    ),
    select(literal("give"), literal("")).where(exists().where(is_waiting())),
)


async def tours(session: AsyncSession) -> list[Tour]:
    """Missions under way that may get one more order: of robots that can be told, and do not wait for a person just
    now."""
    rows = (await (await connection_of(session)).execute(_UNDER_WAY)).all()
    return [await tour_of(session, *row) for row in rows]


def _under_way() -> Select[str, str, str]:
    stands = exists().where(col(Order.robot) == col(RobotRow.name), col(Order.state).in_(WAITING_AT_A_STOP))
    in_trouble = exists().where(col(Order.robot) == col(RobotRow.name), col(Order.state) == OrderState.ATTENTION)
    commanded = exists().where(
        col(RobotCommand.robot) == col(RobotRow.name),
        col(RobotCommand.answered_at).is_(None),
        col(RobotCommand.kind).in_(("recall", "cancel")),
    )
    comes_to = func.coalesce(col(RobotRow.towards), col(RobotRow.post))
    wanted = select(col(MissionRow.id), col(RobotRow.name), comes_to).where(
        col(MissionRow.robot) == col(RobotRow.name),
        col(MissionRow.state) == MissionState.ACTIVE,
        ~col(MissionRow.id).startswith("return-"),
        col(RobotRow.online),
        col(RobotRow.activity) != Activity.STOPPED,
        col(RobotRow.name).not_in(WITHOUT_A_HOME),
        ~stands,
        ~in_trouble,
        ~commanded,
    )
    return wanted.order_by(col(MissionRow.created_at)).limit(TOURS)


_UNDER_WAY: Final = _under_way()
_ABOARD: Final = select(func.count()).select_from(Order).where(col(Order.robot) == bindparam("of"), is_aboard())


async def tour_of(session: AsyncSession, mission_id: str, robot: str, post: str | None) -> Tour:
    """Return the rest of a mission, as a way; it may turn aside wherever it comes to next."""
    stops = await stops_left(session, mission_id)
    aboard = (await (await connection_of(session)).execute(_ABOARD, {"of": robot})).scalar_one()
    return Tour(robot=robot, start=post, visits=tuple(visit_of(stop) for stop in stops), aboard=aboard)


def visit_of(stop: StopRow) -> Visit:
    """A stop as a part of a way."""
    change = {StopAction.LOAD: 1, StopAction.RECEIVE: -1, StopAction.RETURN: -1}.get(StopAction(stop.action), 0)
    return Visit(stop.id, stop.post, change)
