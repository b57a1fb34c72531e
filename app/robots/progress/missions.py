"""The missions that robots report on: which it is, how it ends, and those of a robot's own (decision 0017)."""

from collections.abc import Sequence
from typing import Final

from sqlalchemy import bindparam
from sqlmodel import col, select

from app.core.database.database import connection_of
from app.models import MissionRow, MissionState, Order, OrderState, StopRow
from app.orders.service import Actor
from app.orders.stops import OWN_PREFIX, is_anything_left, is_own, stops_left, stops_of_order
from app.orders.transitions import MAIL_ABOARD, ROBOT_COMING
from app.robots.errors import UnknownMission
from app.robots.progress.reports import Report
from protocol.parts import StopAction
from protocol.to_server import Progress, Step

UNLOADED: Final = "The robot brings back what it has aboard first."
NOT_REPORTED: Final = "The robot has ended its mission and did not say what became of the mail."


async def mission_of(report: Report, progress: Progress) -> MissionRow:
    """The mission that a robot speaks of; its own is taken over when first heard of. Raises UnknownMission."""
    mission = await report.session.get(MissionRow, progress.mission_id)
    if mission is None and is_own(progress.mission_id):
        return await _adopt(report, progress)
    if mission is None or mission.robot != report.robot:
        raise UnknownMission(f"{report.robot} was given no mission {progress.mission_id}")
    if (
        progress.step in (Step.ACCEPTED, Step.DEPARTED)
        and not is_own(mission.id)
        and mission.state is MissionState.ACTIVE
    ):
        await _end_own(report)  # a robot holds one mission at a time
    return mission


async def _adopt(report: Report, progress: Progress) -> MissionRow:
    """Adopt a mission of the robot's own: what is aboard goes back. The robot has let go of the mission before, and of
    what it had not loaded."""
    await _end_own(report)
    for before in await _active(report):
        if await _was_begun(report, before):
            await let_go_of(report, before, report.actor(progress.happened_at, progress.post, UNLOADED))
    mission = MissionRow(
        id=progress.mission_id, robot=report.robot, told_update=1, created_at=report.now, accepted_at=report.now
    )
    report.session.add(mission)
    await report.session.flush()
    for position, order in enumerate(await report.aboard(*MAIL_ABOARD, OrderState.ATTENTION)):
        if order.state is not OrderState.ATTENTION or order.state_before_attention in MAIL_ABOARD:
            await own_stop(report, mission, order, position)
            await start_returning(report, order, progress)
    return mission


async def _was_begun(report: Report, mission: MissionRow) -> bool:
    """Tell if the robot has held it: one that it has only been told of, or an update of it, is still to come."""
    if 0 < mission.accepted_update < mission.told_update:
        return False
    touched = select(StopRow.id).where(StopRow.mission_id == mission.id, col(StopRow.departed_at).is_not(None))
    return mission.accepted_at is not None or (await report.session.exec(touched.limit(1))).first() is not None


async def own_stop(report: Report, mission: MissionRow, order: Order, position: int = 0) -> StopRow:
    """The stop at which the robot's own mission gives back this order's mail; its name is the same in each mission."""
    stop_id = f"{OWN_PREFIX}{order.id}"[:64]
    stop = await report.session.get(StopRow, stop_id)
    if stop is None:
        stop = StopRow(id=stop_id, mission_id=mission.id, position=position, post="", action=StopAction.RETURN)
    stop.mission_id, stop.position, stop.order_id = mission.id, position, order.id
    stop.post = report.orders.returning.return_post(order)
    stop.departed_at = stop.arrived_at = stop.done_at = stop.gave_up_at = stop.dropped_at = None
    report.session.add(stop)
    await report.session.flush()
    return stop


async def start_returning(report: Report, order: Order, progress: Progress) -> None:
    """The robot says that the mail is on its way back."""
    order.return_post = report.orders.returning.return_post(order)
    actor = report.actor(progress.happened_at, progress.post, progress.reason)
    await report.along(order.id, (OrderState.RETURNING,), actor)


async def let_go_of(report: Report, mission: MissionRow, actor: Actor) -> None:
    """A mission that the robot does not hold any more: what it has not loaded is to be fetched by another."""
    end(report, mission, MissionState.CANCELLED)
    for stop in await stops_left(report.session, mission.id):
        stop.dropped_at = report.now
        order = await report.session.get(Order, stop.order_id) if stop.order_id else None
        if order and order.robot == report.robot and order.state in ROBOT_COMING:
            await drop_order(report, order, actor)


async def drop_order(report: Report, order: Order, actor: Actor) -> None:
    """The robot has let go of an order that it had not loaded: cancelled if that was requested, else it waits again."""
    requested = order.cancel_requested_at is not None
    to = OrderState.CANCELLED if requested else OrderState.QUEUED
    await report.orders.ledger.move(report.session, order.id, to, actor)


async def drop_stops(report: Report, order_id: str) -> None:
    """Nothing is left to do for this order; a mission in which nothing is left at all is over, whatever gave it."""
    for stop in await stops_of_order(report.session, order_id, report.robot):
        stop.dropped_at = report.now
    await end_what_is_empty(report)


async def end_what_is_empty(report: Report) -> None:
    """The robot has dropped what it held: a mission in which nothing is left is over, even if it never says so."""
    for mission in await _active(report):
        if mission.told_update > 0:
            await _end_if_empty(report, mission)


async def end_if_nothing_is_left(report: Report, mission: MissionRow) -> None:
    """A robot is free again with its last stop, whether or not it says so once more.

    Of a robot's own mission not every stop may be known: that one ends when the robot says so.
    """
    if not is_own(mission.id):
        await _end_if_empty(report, mission)


async def _end_if_empty(report: Report, mission: MissionRow) -> None:
    await report.session.flush()
    if await is_anything_left(report.session, mission.id):
        return
    done = select(StopRow.id).where(StopRow.mission_id == mission.id, col(StopRow.done_at).is_not(None))
    is_done = (await report.session.exec(done.limit(1))).first() is not None
    end(report, mission, MissionState.DONE if is_done else MissionState.GAVE_UP)


async def finish(report: Report, mission: MissionRow, progress: Progress, state: MissionState) -> None:
    """The robot says that it has ended. What a later update brings, of which it did not know, is still to come."""
    known = getattr(progress, "update", None) or mission.update_number
    left = await stops_left(report.session, mission.id)
    for stop in left:
        if stop.since_update <= known:
            stop.dropped_at = report.now
            await _left_undone(report, stop, progress)
    if all(stop.since_update <= known for stop in left):
        end(report, mission, state)


async def _left_undone(report: Report, stop: StopRow, progress: Progress) -> None:
    """Mail of which the robot has said nothing is looked for by a person; what it did not load waits again."""
    order = await report.session.get(Order, stop.order_id) if stop.order_id else None
    if order is None or order.robot != report.robot:
        return
    actor = report.actor(progress.happened_at, progress.post, NOT_REPORTED)
    if order.state in MAIL_ABOARD:
        await report.orders.ledger.move(report.session, order.id, OrderState.ATTENTION, actor)
    elif order.state in ROBOT_COMING:
        await drop_order(report, order, actor)


def end(report: Report, mission: MissionRow, state: MissionState) -> None:
    """Once; what has ended stays as it ended."""
    if mission.state is MissionState.ACTIVE:
        mission.state, mission.finished_at = state, report.now


async def _end_own(report: Report) -> None:
    """Asked with each mission that a robot takes on, and mostly there is none: so past the session, whose own changes
    need not be written for it. An own mission that it has just ended does not end twice."""
    connection = await connection_of(report.session)
    for mission_id in (await connection.execute(_OWN, {"robot": report.robot})).scalars().all():
        for stop in await stops_left(report.session, mission_id):
            stop.dropped_at = report.now
        end(report, await report.session.get_one(MissionRow, mission_id), MissionState.CANCELLED)


async def _active(report: Report) -> Sequence[MissionRow]:
    return (await report.session.exec(_ACTIVE, params={"robot": report.robot})).all()


_IS_ACTIVE: Final = (col(MissionRow.robot) == bindparam("robot"), col(MissionRow.state) == MissionState.ACTIVE)
_ACTIVE: Final = select(MissionRow).where(*_IS_ACTIVE).order_by(col(MissionRow.created_at))
_OWN: Final = select(col(MissionRow.id)).where(*_IS_ACTIVE, col(MissionRow.id).startswith(OWN_PREFIX))
