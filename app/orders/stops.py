"""The stops of orders on the missions of robots, as far as the life of an order changes them.

Only rows are changed here. A mission whose `update_number` is ahead of what its robot was told is sent by dispatch, so
that whatever changes stops need know nothing of robots and their sockets.
"""

from collections.abc import Sequence
from datetime import datetime
from typing import Final, TypeVar

from sqlalchemy import bindparam
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession
from sqlmodel.sql.expression import SelectOfScalar

from app.core.database.database import connection_of
from app.models import MissionRow, MissionState, Order, StopRow
from protocol.ids import new_id
from protocol.parts import StopAction

OWN_PREFIX: Final = "return-"
Wanted = TypeVar("Wanted")


def is_own(mission_id: str) -> bool:
    """Return whether the robot gave this mission to itself, to bring mail back (decision 0017)."""
    return mission_id.startswith(OWN_PREFIX)


def _not_over(stops: SelectOfScalar[Wanted]) -> SelectOfScalar[Wanted]:
    over = (StopRow.done_at, StopRow.gave_up_at, StopRow.dropped_at)
    return stops.where(*(col(at).is_(None) for at in over))


_LEFT: Final = (
    _not_over(select(StopRow)).where(col(StopRow.mission_id) == bindparam("mission_id")).order_by(col(StopRow.position))
)
_ANY_LEFT: Final = _not_over(select(col(StopRow.id))).where(col(StopRow.mission_id) == bindparam("mission_id")).limit(1)
_TO_RETURN: Final = _not_over(select(col(StopRow.order_id))).where(
    col(StopRow.mission_id) == bindparam("mission_id"),
    col(StopRow.action) == StopAction.RETURN,
    col(StopRow.since_update) <= bindparam("up_to"),
)


async def stops_left(session: AsyncSession, mission_id: str) -> Sequence[StopRow]:
    """The stops of a mission that are not over, in their order."""
    return (await session.exec(_LEFT, params={"mission_id": mission_id})).all()


async def is_anything_left(session: AsyncSession, mission_id: str) -> bool:
    """Return whether a mission has stops that are not over."""
    return (await session.exec(_ANY_LEFT, params={"mission_id": mission_id})).first() is not None


async def orders_to_return(session: AsyncSession, mission_id: str, up_to: int) -> Sequence[str]:
    """Return the orders whose mail a mission brings back, as of its update number `up_to`."""
    if any(isinstance(row, StopRow) for row in (*session.dirty, *session.new)):
        await session.flush()
    rows = await (await connection_of(session)).execute(_TO_RETURN, {"mission_id": mission_id, "up_to": up_to})
    return [order_id for order_id in rows.scalars() if order_id]


async def active_mission(session: AsyncSession, robot: str) -> MissionRow | None:
    """Return the robot's active mission, if any."""
    wanted = select(MissionRow).where(MissionRow.robot == robot, MissionRow.state == MissionState.ACTIVE)
    return (await session.exec(wanted.order_by(col(MissionRow.created_at).desc()))).first()


async def stops_of_order(session: AsyncSession, order_id: str, robot: str) -> Sequence[StopRow]:
    """Return the robot's open stops for an order, in their sequence."""
    active = select(StopRow).join(MissionRow).where(MissionRow.state == MissionState.ACTIVE, MissionRow.robot == robot)
    theirs = _not_over(active.where(StopRow.order_id == order_id)).order_by(col(StopRow.position))
    return (await session.exec(theirs)).all()


async def bring(
    session: AsyncSession, order: Order, action: StopAction, post: str, wait_limit_s: float, now: datetime
) -> None:
    """The mail that `order.robot` has aboard goes to `post` now, instead of wherever it was to go."""
    assert order.robot is not None  # noqa: S101  # mail aboard is aboard of a robot
    before = await stops_of_order(session, order.id, order.robot)
    for stop in before:
        stop.dropped_at = now
    mission = await active_mission(session, order.robot) or await _new_mission(session, order.robot, now)
    if before:
        position, mission.update_number = before[0].position, mission.update_number + 1
    else:
        position = await _end_of(session, mission)
    stop = StopRow(
        id=new_id(),
        mission_id=mission.id,
        position=position,
        post=post,
        action=action,
        order_id=order.id,
        wait_limit_s=wait_limit_s,
        since_update=mission.update_number,
    )
    session.add(stop)
    await session.flush()


async def _new_mission(session: AsyncSession, robot: str, now: datetime) -> MissionRow:
    mission = MissionRow(id=new_id(), robot=robot, created_at=now)
    session.add(mission)
    await session.flush()
    return mission


async def _end_of(session: AsyncSession, mission: MissionRow) -> int:
    """The place behind the last stop; a mission that was told of already gets its next number."""
    last = select(StopRow.position).where(StopRow.mission_id == mission.id).order_by(col(StopRow.position).desc())
    position = (await session.exec(last.limit(1))).first()
    if position is not None:
        mission.update_number += 1
    return 0 if position is None else position + 1


async def restart_wait(session: AsyncSession, stop: StopRow, wait_limit_s: float) -> None:
    """Let the robot wait this long at a stop, from when it takes the update on."""
    mission = await session.get_one(MissionRow, stop.mission_id, with_for_update=True)
    stop.wait_limit_s = wait_limit_s
    mission.update_number += 1
