"""What follows from what robots report: stops and missions come on, orders change their state, people look at faults.

One function per kind of report, in a table. Each runs in the transaction that writes the report down, and does nothing
the second time, so that a robot may repeat itself.
"""

from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.fleet.alarms import clear_alarms, raise_alarm
from app.fleet.commands import answered
from app.fleet.errors import UnknownMission, UnknownStop
from app.orders.service import Orders, Word
from app.orders.transitions import ENDED, By
from app.tables import Handover, MissionRow, MissionState, Order, OrderState, StopRow
from protocol.parts import Part, Purpose, StopAction
from protocol.to_server import Charge, CommandAnswer, Event, Fault, HandoverReceipt, Progress, Step


@dataclass(frozen=True)
class Report:
    """One event of one robot, and the time of the service."""

    session: AsyncSession
    orders: Orders
    robot: str
    now: datetime

    def word(self, robot_at: datetime, post: str | None, reason: str | None = None) -> Word:
        return Word(By.ROBOT, robot=self.robot, robot_at=robot_at, post=post, reason=reason)


AT_STOP: Final[Mapping[tuple[Step, StopAction], tuple[OrderState, ...]]] = {
    (Step.DEPARTED, StopAction.LOAD): (OrderState.TO_SENDER,),
    # A robot that stood at the sender's post already arrives without having set out.
    (Step.ARRIVED, StopAction.LOAD): (OrderState.TO_SENDER, OrderState.AT_SENDER),
    (Step.ARRIVED, StopAction.RECEIVE): (OrderState.AT_RECIPIENT,),
}
"""What the order of a stop goes through when its robot reports a step there."""

HANDED_OVER: Final[Mapping[Purpose, tuple[OrderState, ...]]] = {
    Purpose.LOAD: (OrderState.TO_SENDER, OrderState.AT_SENDER, OrderState.CARRYING),
    Purpose.RECEIVE: (OrderState.AT_RECIPIENT, OrderState.DELIVERED),
}
"""Custody is proved by the receipt alone; steps before it that were not reported are caught up with."""

TIME_OF_STEP: Final[Mapping[Step, str]] = {
    Step.DEPARTED: "departed_at",
    Step.ARRIVED: "arrived_at",
    Step.DONE: "done_at",
    Step.GAVE_UP: "gave_up_at",
}


async def follow(report: Report, event: Event) -> None:
    """Do what follows. Raises FleetError or an order's TransitionRefused; nothing of it has happened then."""
    await _FOLLOW[type(event.happened)](report, event.happened)


async def _progress(report: Report, progress: Progress) -> None:
    mission = await _mission(report, progress.mission_id)
    if progress.step is Step.ACCEPTED:
        mission.accepted_at = mission.accepted_at or report.now
    elif progress.stop_id is not None:
        await _progress_at_stop(report, progress, mission, await _stop(report, mission, progress.stop_id))
    elif progress.step in _END_OF_MISSION:
        _end(mission, _END_OF_MISSION[progress.step], report.now)


_END_OF_MISSION: Final = {Step.DONE: MissionState.DONE, Step.GAVE_UP: MissionState.GAVE_UP}


async def _progress_at_stop(report: Report, progress: Progress, mission: MissionRow, stop: StopRow) -> None:
    action = StopAction(stop.action)
    if (name := TIME_OF_STEP.get(progress.step)) and getattr(stop, name) is None:
        setattr(stop, name, progress.happened_at)
    if stop.order_id is not None and progress.step is Step.GAVE_UP:
        await _GIVEN_UP[action](report, progress, mission, stop.order_id)
    elif stop.order_id is not None:
        word = report.word(progress.happened_at, progress.post, progress.reason)
        await _move(report, stop.order_id, AT_STOP.get((progress.step, action), ()), word)
    await _end_when_all_is_done(report, mission)


async def _not_loaded(report: Report, progress: Progress, mission: MissionRow, order_id: str) -> None:
    """The sender did not come, or (which is nobody's delay, but a fault) the robot cannot get there.

    Nothing came aboard, so nothing is left to do. Thin: a mission serves one order.
    """
    order = await report.session.get_one(Order, order_id)
    to, reason = OrderState.EXPIRED, progress.reason
    if order.cancel_requested_at is not None:  # as wished, whatever the robot answers later
        to = OrderState.CANCELLED
    elif order.state in (OrderState.ASSIGNED, OrderState.TO_SENDER):
        to, reason = OrderState.ATTENTION, f"The robot cannot get to the sender: {progress.reason}."
    await _move(report, order_id, (to,), report.word(progress.happened_at, progress.post, reason))
    _end(mission, MissionState.GAVE_UP, report.now)


NOT_TAKEN: Final = "mail_not_taken"


async def _not_taken(report: Report, progress: Progress, mission: MissionRow, order_id: str) -> None:
    """The mail stays aboard, and its robot gets nothing else to do, until a person has fetched it.

    Thin: bringing it back, or to the mailroom, is a later issue; until then the alarm and the order say where it is.
    """
    word = report.word(progress.happened_at, progress.post, progress.reason)
    await _move(report, order_id, (OrderState.RETURNING,), word)
    await report.orders.explain(report.session, order_id, f"Nobody took the mail. It is still in robot {report.robot}.")
    reason = f"the mail of order {order_id} was not taken ({progress.reason}) and is still aboard: fetch it"
    await raise_alarm(report.session, report.robot, NOT_TAKEN, reason, now=report.now, post=progress.post)


_GIVEN_UP: Final = {StopAction.LOAD: _not_loaded, StopAction.RECEIVE: _not_taken}
"""Other stops have no order, so that nobody waits there."""


async def _handover(report: Report, receipt: HandoverReceipt) -> None:
    stop = await report.session.get(StopRow, receipt.stop_id)
    if stop is None or (stop.order_id, stop.action) != (receipt.order_id, receipt.purpose):
        what = f"to {receipt.purpose} order {receipt.order_id}"
        raise UnknownStop(f"{report.robot} was given no stop {receipt.stop_id} {what}")
    stop.done_at = stop.done_at or receipt.happened_at
    if not await _is_receipted(report.session, receipt):
        report.session.add(
            Handover(
                order_id=receipt.order_id,
                stop_id=receipt.stop_id,
                purpose=receipt.purpose,
                robot=report.robot,
                post=receipt.post,
                code_sha256=receipt.code_sha256,
                robot_at=receipt.happened_at,
                at=report.now,
            )
        )
    word = report.word(receipt.happened_at, receipt.post)
    await _move(report, receipt.order_id, HANDED_OVER[receipt.purpose], word)
    await _end_when_all_is_done(report, await _mission(report, stop.mission_id))


async def _end_when_all_is_done(report: Report, mission: MissionRow) -> None:
    """A robot is free again with its last stop, whether or not it says so once more."""
    await report.session.flush()
    undone = select(StopRow.id).where(StopRow.mission_id == mission.id, col(StopRow.done_at).is_(None))
    if (await report.session.exec(undone)).first() is None:
        _end(mission, MissionState.DONE, report.now)


async def _is_receipted(session: AsyncSession, receipt: HandoverReceipt) -> bool:
    same = select(Handover.id).where(
        Handover.order_id == receipt.order_id,
        Handover.stop_id == receipt.stop_id,
        Handover.purpose == receipt.purpose,
    )
    return (await session.exec(same)).first() is not None


async def _charge(report: Report, charge: Charge) -> None:
    """Written down with the message itself; nothing else depends on it (snapshots tell the present state)."""


async def _fault(report: Report, fault: Fault) -> None:
    if fault.cleared:
        await clear_alarms(report.session, report.robot, fault.name, report.now)
    else:
        await raise_alarm(report.session, report.robot, fault.name, fault.reason, now=report.now, post=fault.post)


async def _answer(report: Report, answer: CommandAnswer) -> None:
    command = await answered(report.session, report.robot, answer, report.now)
    if not answer.accepted:
        reason = answer.reason or f"the robot refused {answer.command_id}"
        await raise_alarm(report.session, report.robot, "command_refused", reason, now=report.now)
    elif command.kind == "cancel" and command.order_id is not None:
        await _let_go(report, command.order_id, answer)


async def _let_go(report: Report, order_id: str, answer: CommandAnswer) -> None:
    order = await report.session.get_one(Order, order_id)
    if order.state not in ENDED:  # else it ended while the wish was on its way
        await _move(report, order_id, (OrderState.CANCELLED,), report.word(answer.happened_at, None, answer.reason))
    await _end_missions_without_orders(report, order_id)


async def _end_missions_without_orders(report: Report, order_id: str) -> None:
    """The mission that was for this order is over. Thin: a mission serves one order."""
    missions = select(MissionRow).join(StopRow).where(StopRow.order_id == order_id).distinct()
    for mission in (await report.session.exec(missions)).all():
        _end(mission, MissionState.CANCELLED, report.now)


def _end(mission: MissionRow, state: MissionState, now: datetime) -> None:
    if mission.state is MissionState.ACTIVE:
        mission.state, mission.finished_at = state, now


async def _move(report: Report, order_id: str, states: tuple[OrderState, ...], word: Word) -> None:
    """Go through `states` in order, from wherever the order is among them."""
    order = await report.session.get(Order, order_id)
    if order is not None and order.state in states:
        states = states[states.index(order.state) :]
    for state in states:
        await report.orders.move(report.session, order_id, state, word)


async def _mission(report: Report, mission_id: str) -> MissionRow:
    mission = await report.session.get(MissionRow, mission_id)
    if mission is None or mission.robot != report.robot:
        raise UnknownMission(f"{report.robot} was given no mission {mission_id}")
    return mission


async def _stop(report: Report, mission: MissionRow, stop_id: str) -> StopRow:
    stop = await report.session.get(StopRow, stop_id)
    if stop is None or stop.mission_id != mission.id:
        raise UnknownStop(f"mission {mission.id} has no stop {stop_id}")
    return stop


async def active_mission(session: AsyncSession, robot: str) -> MissionRow | None:
    """What this robot is to do now, if anything."""
    wanted = select(MissionRow).where(MissionRow.robot == robot, MissionRow.state == MissionState.ACTIVE)
    return (await session.exec(wanted.order_by(col(MissionRow.created_at).desc()))).first()


_Follow = Callable[[Report, Any], Awaitable[None]]
_FOLLOW: Final[Mapping[type[Part], _Follow]] = {
    Progress: _progress,
    HandoverReceipt: _handover,
    Charge: _charge,
    Fault: _fault,
    CommandAnswer: _answer,
}
