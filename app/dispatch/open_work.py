"""Open work for the planner, as the database has it: orders that are not delivered, robots, and the stops before
them. One look, in which everything is of one moment."""

from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from enum import StrEnum
from typing import Any, Final, NamedTuple

from sqlalchemy import bindparam, func, or_, select
from sqlmodel import col
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import connection_of
from app.dispatch.waiting_work import LOAD_POST, WAITING_AT_A_STOP, is_aboard, is_waiting
from app.models import MissionRow, MissionState, Order, OrderState, Priority, RobotCommand, RobotRow, StopRow
from app.orders.stops import is_own
from app.orders.transitions import MAIL_ABOARD, ROBOT_COMING
from app.robots.homes import WITHOUT_A_HOME
from protocol.parts import Activity

LOOKED_AT: Final = 200
"""So many of the longest waiting, and so many of the important ones."""


class OrderNow(NamedTuple):
    """`is_let_go`: its robot is being told to drop it. `is_aboard`: its mail is in its robot, as far as is known."""

    id: str
    state: OrderState
    robot: str | None
    from_post: str
    to_post: str
    wanted: str | None
    avoided: str | None
    created_at: datetime
    priority: Priority
    is_let_go: bool
    is_aboard: bool


class StopNow(NamedTuple):
    """A stop that is not over, of a mission that is not over."""

    id: str
    mission_id: str
    robot: str
    action: str
    post: str
    order_id: str | None
    departed: bool


class HeldUp(StrEnum):
    """Why a robot waits for a person, whatever there is to do."""

    STUCK_MAIL = "stuck_mail"
    STOPPED = "stopped"
    PAUSED = "paused"


class RobotNow(NamedTuple):
    """`takes_work`: it may be given orders. `gives_away`: others may fetch what it has not loaded (it is paused, its
    home is another's, or something keeps it where it is). One that does neither is left alone with what it has.
    `has_stopped`: it says so. `held_up`: until a person has done something about it."""

    name: str
    post: str | None
    battery_ratio: float | None
    charging: bool
    docked: bool | None
    home: str | None
    is_there: bool
    takes_work: bool
    gives_away: bool
    has_stopped: bool
    held_up: HeldUp | None


@dataclass(frozen=True)
class OpenWork:
    """`dropping`: robots that were told to drop an order and have not answered, by order; `missions`: of each robot."""

    orders: Mapping[str, OrderNow]
    robots: Mapping[str, RobotNow]
    stops: Mapping[str, Sequence[StopNow]]
    missions: Mapping[str, str]
    dropping: Mapping[str, frozenset[str]]
    connected: int
    of_orders: Mapping[str, Sequence[StopNow]] = field(default_factory=dict)

    @property
    def waiting(self) -> list[OrderNow]:
        return [order for order in self.orders.values() if order.state is OrderState.QUEUED]

    @property
    def able(self) -> list[str]:
        """The robots that may come for an order, now or after what they have."""
        return [name for name, robot in self.robots.items() if robot.is_there and robot.held_up is None]


async def read_open_work(session: AsyncSession, now: datetime) -> OpenWork:
    """Six questions, whatever the number of robots and orders."""
    return await _asked(session, _ALL, {"now": now})


async def read_part(session: AsyncSession, now: datetime, robots: Iterable[str], orders: Iterable[str]) -> OpenWork:
    """Read these robots, what each of them has before it, and these of the waiting orders: the same questions of less.

    The stops of `orders` are read whatever robot has them, so that these orders read as they do among all.
    """
    return await _asked(session, _PART, {"now": now, "robots": [*robots], "orders": [*orders]})


async def _asked(session: AsyncSession, questions: "_Questions", named: Mapping[str, Any]) -> OpenWork:
    connection = await connection_of(session)

    async def rows(question: Any) -> Sequence[Any]:
        return (await connection.execute(question, named)).all()

    waiting = await rows(questions.waiting)
    if len(waiting) == LOOKED_AT:  # the important ones behind these must not be overlooked
        waiting = [*waiting, *await rows(_IMPORTANT)]
    orders = [*waiting, *await rows(questions.with_a_robot)]
    robots, stops = await rows(questions.robots), [StopNow(*row) for row in await rows(questions.stops)]
    return _put_together(orders, robots, stops, await rows(questions.missions), await rows(questions.commands))


async def read_held_up(session: AsyncSession) -> set[HeldUp | None]:
    """Why connected robots wait for a person, None for those that do not; three short questions."""
    connection = await connection_of(session)
    stuck = set((await connection.execute(_STUCK)).scalars())
    paused = _paused((await connection.execute(_COMMANDS)).all())
    return {_held_up(row, stuck, paused) for row in (await connection.execute(_CONNECTED)).all()}


def _put_together(
    rows: Iterable[Any],
    robots: Sequence[Any],
    stops: Iterable[StopNow],
    missions: Iterable[Any],
    commands: Sequence[Any],
) -> OpenWork:
    by_robot, by_order = _grouped(stops)
    orders = {row.id: OrderNow(*row) for row in rows if not _only_a_person_can(row, by_order)}
    its_missions: dict[str, list[str]] = {}
    for mission_id, robot in missions:
        its_missions.setdefault(robot, []).append(mission_id)
    busy = _not_to_be_disturbed(orders.values(), by_robot, its_missions, commands)
    stuck = {order.robot for order in orders.values() if order.state is OrderState.ATTENTION and order.is_aboard}
    paused = _paused(commands)
    dropping: dict[str, frozenset[str]] = {}
    for one in commands:
        if one.kind == "cancel" and one.answered_at is None:
            dropping[one.order_id] = dropping.get(one.order_id, frozenset()) | {one.robot}
    return OpenWork(
        orders,
        {row.name: _robot(row, is_busy=row.name in busy, held_up=_held_up(row, stuck, paused)) for row in robots},
        by_robot,
        {robot: ids[0] for robot, ids in its_missions.items()},
        dropping,
        sum(1 for row in robots if row.online),
        by_order,
    )


def _only_a_person_can(row: Any, by_order: Container[str]) -> bool:
    """A dispatcher decides about it, and its robot has nothing more to do with it: that one is free for other work."""
    return row.state is OrderState.ATTENTION and not row.is_aboard and row.id not in by_order


def _grouped(stops: Iterable[StopNow]) -> tuple[dict[str, list[StopNow]], dict[str, list[StopNow]]]:
    by_robot: dict[str, list[StopNow]] = {}
    by_order: dict[str, list[StopNow]] = {}
    for stop in stops:
        by_robot.setdefault(stop.robot, []).append(stop)
        by_order.setdefault(stop.order_id or "", []).append(stop)
    return by_robot, by_order


def _held_up(row: Any, stuck: Container[str | None], paused: Container[str]) -> HeldUp | None:
    if row.name in stuck:
        return HeldUp.STUCK_MAIL
    if row.activity == Activity.STOPPED or row.taken_out_at is not None:
        return HeldUp.STOPPED
    return HeldUp.PAUSED if row.name in paused else None


def _robot(row: Any, *, is_busy: bool, held_up: HeldUp | None) -> RobotNow:
    is_paused = held_up is HeldUp.PAUSED or row.is_without_a_home
    is_there = row.online and row.taken_out_at is None and not is_busy
    has_stopped = row.activity == Activity.STOPPED
    takes_work, gives_away = is_there and not is_paused and not has_stopped, is_there and (is_paused or has_stopped)
    says = row.name, row.post, row.battery_ratio, row.charging, row.docked, row.home
    return RobotNow(*says, row.online, takes_work, gives_away, has_stopped, held_up)


def _not_to_be_disturbed(
    orders: Iterable[OrderNow],
    stops: Mapping[str, Sequence[StopNow]],
    missions: Mapping[str, Sequence[str]],
    commands: Iterable[Any],
) -> set[str]:
    """Robots at which a person stands, or that are in trouble; that were told something and have not answered, which
    would cross with what they are told next; that do work of their own, or have mail that is in no mission."""
    standing = {order.robot for order in orders if order.state in (*WAITING_AT_A_STOP, OrderState.ATTENTION)}
    asked = {one.robot for one in commands if one.answered_at is None and one.kind in ("recall", "cancel")}
    unclear = {robot for robot, ids in missions.items() if len(ids) > 1 or is_own(ids[0]) or not stops.get(robot)}
    brought = {stop.order_id for theirs in stops.values() for stop in theirs}
    lost = {order.robot for order in orders if order.state in MAIL_ABOARD and order.id not in brought}
    return {robot for robot in standing | asked | unclear | lost if robot}


def _paused(commands: Iterable[Any]) -> set[str]:
    """By the last word about it that a robot has not refused."""
    last = {one.robot: one.kind for one in commands if one.kind in ("pause", "resume") and one.accepted is not False}
    return {robot for robot, kind in last.items() if kind == "pause"}


def _orders() -> Any:
    is_let_go = or_(
        col(Order.let_go_by).is_not(None),
        col(Order.cancel_requested_at).is_not(None),
        col(Order.reassign_requested_at).is_not(None),
    )
    return select(
        *(col(Order.id), col(Order.state), col(Order.robot), LOAD_POST, col(Order.to_post)),
        *(col(Order.wanted_robot), col(Order.avoided_robot), col(Order.created_at), col(Order.priority)),
        *(is_let_go.label("is_let_go"), is_aboard().label("is_aboard")),
    )


# Put together once: that takes several times as long as asking.
_WITH_A_ROBOT: Final = _orders().where(col(Order.state).in_((*ROBOT_COMING, *MAIL_ABOARD, OrderState.ATTENTION)))
_WAITING: Final = _orders().where(is_waiting()).order_by(col(Order.created_at), col(Order.id))
_IMPORTANT: Final = _WAITING.where(col(Order.priority) == Priority.HIGH).limit(LOOKED_AT)
_ROBOTS: Final = select(
    *(col(RobotRow.name), col(RobotRow.post), col(RobotRow.battery_ratio), col(RobotRow.charging)),
    *(col(RobotRow.docked), col(RobotRow.home)),
    *(col(RobotRow.online), col(RobotRow.activity), col(RobotRow.taken_out_at)),
    col(RobotRow.name).in_(WITHOUT_A_HOME).label("is_without_a_home"),
)
_CONNECTED: Final = select(col(RobotRow.name), col(RobotRow.activity), col(RobotRow.taken_out_at)).where(
    col(RobotRow.online)
)
_STUCK: Final = select(col(Order.robot)).where(col(Order.state) == OrderState.ATTENTION, is_aboard())
_MISSIONS: Final = (
    select(col(MissionRow.id), col(MissionRow.robot))
    .where(col(MissionRow.state) == MissionState.ACTIVE)
    .order_by(col(MissionRow.created_at))
)
_STOPS: Final = (
    select(
        *(col(StopRow.id), col(StopRow.mission_id), col(MissionRow.robot), col(StopRow.action), col(StopRow.post)),
        *(col(StopRow.order_id), col(StopRow.departed_at).is_not(None).label("departed")),
    )
    .where(col(StopRow.mission_id) == col(MissionRow.id), col(MissionRow.state) == MissionState.ACTIVE)
    .where(col(StopRow.done_at).is_(None), col(StopRow.gave_up_at).is_(None), col(StopRow.dropped_at).is_(None))
    .order_by(col(MissionRow.created_at), col(StopRow.position))
)


def _commands() -> Any:
    """Those without an answer, and what was said last about going on."""
    newest = (
        select(col(RobotCommand.robot), func.max(col(RobotCommand.asked_at)).label("at"))
        .where(col(RobotCommand.kind).in_(("pause", "resume")))
        .group_by(col(RobotCommand.robot))
    ).subquery()
    is_newest = (col(RobotCommand.robot) == newest.c.robot) & (col(RobotCommand.asked_at) == newest.c.at)
    is_last = is_newest & col(RobotCommand.kind).in_(("pause", "resume"))
    return (
        select(
            *(col(RobotCommand.robot), col(RobotCommand.kind), col(RobotCommand.order_id)),
            *(col(RobotCommand.answered_at), col(RobotCommand.accepted)),
        )
        .outerjoin(newest, col(RobotCommand.robot) == newest.c.robot)
        .where(or_(col(RobotCommand.answered_at).is_(None), is_last))
        .order_by(col(RobotCommand.asked_at), col(RobotCommand.command_id))
    )


_COMMANDS: Final = _commands()


class _Questions(NamedTuple):
    waiting: Any
    with_a_robot: Any
    robots: Any
    stops: Any
    missions: Any
    commands: Any


def _named(column: Any, names: str) -> Any:
    return col(column).in_(bindparam(names, expanding=True))


_ALL: Final = _Questions(_WAITING.limit(LOOKED_AT), _WITH_A_ROBOT, _ROBOTS, _STOPS, _MISSIONS, _COMMANDS)
_PART: Final = _Questions(
    _WAITING.where(_named(Order.id, "orders")),
    _WITH_A_ROBOT.where(_named(Order.robot, "robots")),
    _ROBOTS.where(_named(RobotRow.name, "robots")),
    _STOPS.where(or_(_named(MissionRow.robot, "robots"), _named(StopRow.order_id, "orders"))),
    _MISSIONS.where(_named(MissionRow.robot, "robots")),
    _COMMANDS.where(_named(RobotCommand.robot, "robots")),
)
