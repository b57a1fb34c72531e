"""Consequences of a robot's progress: stops and missions come on, and orders with them."""

from collections.abc import Awaitable, Callable, Mapping
from typing import Final

from app.models import MissionRow, MissionState, Order, OrderState, StopRow
from app.orders.stops import OWN_PREFIX, is_own, orders_to_return
from app.orders.transitions import ENDED, MAIL_ABOARD
from app.robots.errors import UnknownStop
from app.robots.progress.missions import (
    drop_stops,
    end_if_nothing_is_left,
    finish,
    mission_of,
    own_stop,
    start_returning,
)
from app.robots.progress.reports import Report
from protocol.parts import StopAction
from protocol.to_server import Progress, Step

AT_STOP: Final[Mapping[tuple[Step, StopAction], tuple[OrderState, ...]]] = {
    (Step.DEPARTED, StopAction.LOAD): (OrderState.TO_SENDER,),
    # A robot that stood at the sender's post already arrives without having set out.
    (Step.ARRIVED, StopAction.LOAD): (OrderState.TO_SENDER, OrderState.AT_SENDER),
    (Step.ARRIVED, StopAction.RECEIVE): (OrderState.AT_RECIPIENT,),
    (Step.DEPARTED, StopAction.RETURN): (OrderState.RETURNING,),
    (Step.ARRIVED, StopAction.RETURN): (OrderState.RETURNING, OrderState.AT_RETURN),
}
"""What the order of a stop goes through when its robot reports a step there."""

TIME_OF_STEP: Final[Mapping[Step, str]] = {
    Step.DEPARTED: "departed_at",
    Step.ARRIVED: "arrived_at",
    Step.DONE: "done_at",
    Step.GAVE_UP: "gave_up_at",
}
_END_OF_MISSION: Final = {Step.DONE: MissionState.DONE, Step.GAVE_UP: MissionState.GAVE_UP}


async def follow_progress(report: Report, progress: Progress) -> None:
    """Raises UnknownMission, UnknownStop, TransitionRefused."""
    mission = await mission_of(report, progress)
    if progress.step is Step.ACCEPTED:
        await _accepted(report, mission, progress)
    elif progress.stop_id is not None:
        stop = await _stop(report, mission, progress)
        if stop is not None:
            await _at_stop(report, progress, mission, stop)
    elif progress.step in _END_OF_MISSION and mission.state is MissionState.ACTIVE:
        await finish(report, mission, progress, _END_OF_MISSION[progress.step])


async def _accepted(report: Report, mission: MissionRow, progress: Progress) -> None:
    """The robot holds the mission now; mail that this update sends back is on its way back from here on."""
    mission.accepted_at = mission.accepted_at or report.now
    mission.accepted_update = max(mission.accepted_update, getattr(progress, "update", None) or 1)
    for order_id in await orders_to_return(report.session, mission.id, mission.accepted_update):
        order = await report.orders.ledger.order(report.session, order_id)
        if order.robot == report.robot and order.state in MAIL_ABOARD:
            await start_returning(report, order, progress)


async def _stop(report: Report, mission: MissionRow, progress: Progress) -> StopRow | None:
    """The stop that is spoken of; None if a later mission of the robot's own has taken it over. Raises UnknownStop."""
    stop = await report.session.get(StopRow, progress.stop_id)
    if stop is not None and stop.mission_id == mission.id:
        return stop
    order = await report.session.get(Order, progress.order_id) if progress.order_id else None
    if order is None or not is_own(mission.id) or progress.stop_id != f"{OWN_PREFIX}{order.id}"[:64]:
        raise UnknownStop(f"mission {mission.id} has no stop {progress.stop_id}")
    is_taken_over = stop is not None and mission.state is not MissionState.ACTIVE
    return None if is_taken_over else await own_stop(report, mission, order)


async def _at_stop(report: Report, progress: Progress, mission: MissionRow, stop: StopRow) -> None:
    is_over = stop.done_at is not None or stop.gave_up_at is not None
    name = TIME_OF_STEP.get(progress.step)
    was_told = name is not None and getattr(stop, name) is not None
    if name is not None and not was_told:
        setattr(stop, name, progress.happened_at)
    if is_over or was_told or stop.order_id is None or not await _is_theirs(report, stop):
        pass  # what was reported before, or what concerns no order any more
    elif progress.step is Step.GAVE_UP:
        await _GIVEN_UP[StopAction(stop.action)](report, progress, mission, stop.order_id)
    else:
        await _come_along(report, progress, stop, stop.order_id)
    await end_if_nothing_is_left(report, mission)


async def _is_theirs(report: Report, stop: StopRow) -> bool:
    """A stop to load at that was dropped belongs to an order that has gone on without this robot."""
    order = await report.session.get(Order, stop.order_id)
    was_let_go = stop.dropped_at is not None and stop.action == StopAction.LOAD
    return order is not None and order.robot == report.robot and not was_let_go


async def _come_along(report: Report, progress: Progress, stop: StopRow, order_id: str) -> None:
    action, until = StopAction(stop.action), None
    if progress.step is Step.ARRIVED:
        until = report.until(progress.happened_at, stop.wait_limit_s)
        if action is StopAction.RETURN and progress.post:
            stop.post = progress.post
    if action is StopAction.RETURN:
        order = await report.orders.ledger.order(report.session, order_id)
        order.return_post = stop.post
    actor = report.actor(progress.happened_at, progress.post, progress.reason)
    await report.along(order_id, AT_STOP.get((progress.step, action), ()), actor, until)
    if (progress.step, action) == (Step.PASSED, StopAction.LOAD):
        await report.orders.ledger.notify_when_near(report.session, order_id, progress.post)


async def _not_loaded(report: Report, progress: Progress, mission: MissionRow, order_id: str) -> None:
    """The sender did not come, or (which is no person's delay, but a fault) the robot cannot get there.

    Nothing came aboard, so nothing is left to do for this order.
    """
    order = await report.orders.ledger.order(report.session, order_id)
    to, reason = OrderState.EXPIRED, progress.reason
    if order.cancel_requested_at is not None:  # as wished, whatever the robot answers later
        to = OrderState.CANCELLED
    elif order.state is not OrderState.AT_SENDER and order.state_before_attention is not OrderState.AT_SENDER:
        to, reason = OrderState.ATTENTION, f"The robot cannot get to the sender: {progress.reason}."
        if order.reassign_requested_at is not None:
            to = OrderState.QUEUED
    await drop_stops(report, order_id)
    await report.along(order_id, (to,), report.actor(progress.happened_at, progress.post, reason))


async def _not_taken(report: Report, progress: Progress, mission: MissionRow, order_id: str) -> None:
    """The robot brings the mail back by itself, when it has done what else it was to do."""
    order = await report.orders.ledger.order(report.session, order_id)
    order.return_post = report.orders.returning.return_post(order)
    actor = report.actor(progress.happened_at, progress.post, progress.reason)
    await report.along(order_id, (OrderState.RETURNING,), actor)


async def _not_taken_back(report: Report, progress: Progress, mission: MissionRow, order_id: str) -> None:
    """After a stop of ours the robot tries once more by itself; after its own it goes home with the mail."""
    order = await report.orders.ledger.order(report.session, order_id)
    if is_own(mission.id) and order.state not in ENDED:  # of what has ended the robot's fault tells people
        sentence = f"Nobody took the mail back ({progress.reason}). It is still in robot {report.robot}."
        actor = report.actor(progress.happened_at, progress.post, sentence)
        await report.orders.ledger.move(report.session, order_id, OrderState.ATTENTION, actor)


_GiveUp = Callable[[Report, Progress, MissionRow, str], Awaitable[None]]
_GIVEN_UP: Final[Mapping[StopAction, _GiveUp]] = {
    StopAction.LOAD: _not_loaded,
    StopAction.RECEIVE: _not_taken,
    StopAction.RETURN: _not_taken_back,
}
"""Other stops have no order, so that no person waits there."""
