"""Consequences of a receipt: mail has changed hands. It is written down whatever the order's state says: only the
robot writes custody, and what it proves has happened. Refused is only what no chain of custody could contain.

What a robot only claims is written down as claimed. Mail that is said to be aboard goes its way; mail that is said to
be out waits for a person who asks the one who should have it."""

from collections.abc import Mapping
from typing import Final

from sqlmodel import select

from app.core.database.database import savepoint
from app.models import Evidence, Handover, MissionRow, Order, OrderState, StopRow
from app.orders.custody.codes import Holder, codes_of, delegates_of
from app.orders.custody.unproven import last_handover, settle_as_aboard
from app.orders.errors import TransitionRefused
from app.orders.service import Actor
from app.orders.stops import stops_of_order
from app.orders.transitions import ENDED, MAIL_ABOARD, TURNED_BACK
from app.robots.alarms import CONTRADICTION, clear_alarms, raise_alarm
from app.robots.errors import UnknownStop
from app.robots.progress.missions import end_if_nothing_is_left
from app.robots.progress.receipts import judged
from app.robots.progress.reports import Report
from protocol.parts import Purpose
from protocol.to_server import HandoverReceipt

HANDED_OVER: Final[Mapping[Purpose, tuple[OrderState, ...]]] = {
    Purpose.LOAD: (OrderState.TO_SENDER, OrderState.AT_SENDER, OrderState.CARRYING),
    Purpose.RECEIVE: (OrderState.AT_RECIPIENT, OrderState.DELIVERED),
    Purpose.RETURN: (OrderState.RETURNING, OrderState.AT_RETURN),
}
"""Custody is proved by the receipt alone; steps before it that were not reported are caught up with."""

TAKEN_BACK_BY: Final[Mapping[Holder, OrderState]] = {
    Holder.SENDER: OrderState.RETURNED,
    Holder.MAILROOM: OrderState.HELD,
    Holder.RECIPIENT: OrderState.DELIVERED,
}


NOT_PROVED: Final = "The robot says that the mail is out, and nothing proves it. Please ask the recipient."


async def follow_receipt(report: Report, receipt: HandoverReceipt) -> None:
    """Raises UnknownStop, and TransitionRefused for what would break the chain of custody."""
    stop, mission = await _stop(report, receipt)
    if await _is_receipted(report, receipt):
        return
    order = await report.orders.ledger.order(report.session, receipt.order_id)
    handover = await judged(report, order, mission, receipt)
    if handover is None:
        return  # it counts for nothing: custody does not move
    await _check_chain(report, receipt)
    stop.done_at = stop.done_at or receipt.happened_at
    await _settle(report, receipt, handover)
    report.session.add(handover)
    if handover.evidence == Evidence.CLAIMED and receipt.purpose != Purpose.LOAD:
        await _let_somebody_ask(report, receipt)
    else:
        await _move(report, receipt, quietly=handover.evidence == Evidence.CLAIMED)
    await _drop_the_rest(report, receipt)
    await end_if_nothing_is_left(report, mission)


async def _settle(report: Report, receipt: HandoverReceipt, handover: Handover) -> None:
    """Mail that is proved to have come out was aboard, and had not come out before."""
    if receipt.purpose != Purpose.LOAD and handover.evidence != Evidence.CLAIMED:
        await settle_as_aboard(report.session, receipt.order_id, report.now)


async def _let_somebody_ask(report: Report, receipt: HandoverReceipt) -> None:
    """No person is told that they have it. An order that has ended or was given to another stays as it is: the alarm
    rings all the same."""
    order = await report.orders.ledger.order(report.session, receipt.order_id)
    if order.robot == report.robot and order.state in MAIL_ABOARD:
        actor = report.actor(receipt.happened_at, receipt.post, NOT_PROVED)
        await report.orders.ledger.move(report.session, order.id, OrderState.ATTENTION, actor)


async def _drop_the_rest(report: Report, receipt: HandoverReceipt) -> None:
    """Mail that is out has nowhere to go any more, whatever was wished of it while the robot could not be told."""
    if receipt.purpose != Purpose.LOAD:
        for stop in await stops_of_order(report.session, receipt.order_id, report.robot):
            stop.dropped_at = report.now
            await end_if_nothing_is_left(report, await report.session.get_one(MissionRow, stop.mission_id))


async def _check_chain(report: Report, receipt: HandoverReceipt) -> None:
    """A robot gives what it was given, and mail comes aboard once, unless it was given back: a robot that was given up
    on and heard nothing of it may get it again."""
    last = await last_handover(report.session, receipt.order_id)
    has_it = last is not None and (last.purpose, last.robot) == (Purpose.LOAD, report.robot)
    if receipt.purpose == Purpose.LOAD and last is not None and last.purpose != Purpose.RETURN:
        raise TransitionRefused(f"The mail of order {receipt.order_id} has been loaded before.")
    if receipt.purpose != Purpose.LOAD and not has_it:
        raise TransitionRefused(f"Robot {report.robot} does not have the mail of order {receipt.order_id}.")


async def _stop(report: Report, receipt: HandoverReceipt) -> tuple[StopRow, MissionRow]:
    stop = await report.session.get(StopRow, receipt.stop_id)
    mission = await report.session.get(MissionRow, stop.mission_id) if stop else None
    if stop is None or mission is None or mission.robot != report.robot:
        raise UnknownStop(f"{report.robot} was given no stop {receipt.stop_id}")
    if (stop.order_id, stop.action) != (receipt.order_id, receipt.purpose):
        raise UnknownStop(f"stop {stop.id} is not to {receipt.purpose} order {receipt.order_id}")
    return stop, mission


async def _move(report: Report, receipt: HandoverReceipt, *, quietly: bool) -> None:
    """The order follows its mail. An order that has ended otherwise stays ended, and a person has to look. `quietly`:
    people are told nothing that is not known."""
    order = await report.orders.ledger.order(report.session, receipt.order_id)
    if order.robot not in (None, report.robot):
        order.let_go_by = order.robot  # it was given to another, but this one had the mail already
    actor = report.actor(receipt.happened_at, receipt.post)
    if receipt.purpose == Purpose.LOAD and order.state in ENDED:
        await _loaded_too_late(report, order, receipt, actor)
        return
    states, state = await _states(report, order, receipt), order.state
    try:
        async with savepoint(report.session):
            await report.along(order.id, states, actor, quietly=quietly)
    except TransitionRefused:
        await _contradiction(report, receipt, state)


async def _loaded_too_late(report: Report, order: Order, receipt: HandoverReceipt, actor: Actor) -> None:
    """It is carried for nothing: a person has to know, and the robot brings it back."""
    await _contradiction(report, receipt, order.state)
    order.robot = report.robot
    if order.let_go_by == report.robot:
        order.let_go_by = None  # it cannot drop what it has
    await report.orders.returning.ask_back(report.session, order, actor)


async def _contradiction(report: Report, receipt: HandoverReceipt, state: OrderState) -> None:
    """When such mail is out again, no person has to look any more."""
    if receipt.purpose != Purpose.LOAD:
        await clear_alarms(report.session, report.robot, CONTRADICTION, report.now, about=receipt.order_id)
        return
    order_id, purpose, post = receipt.order_id, receipt.purpose, receipt.post
    sentence = f"Order {order_id} is {state}. But its mail changed hands ({purpose}) at {post}."
    await raise_alarm(report.session, report.robot, CONTRADICTION, sentence, now=report.now, post=receipt.post)


async def _states(report: Report, order: Order, receipt: HandoverReceipt) -> tuple[OrderState, ...]:
    purpose = Purpose(receipt.purpose)
    if purpose is Purpose.LOAD and order.state is OrderState.QUEUED:
        return (OrderState.CARRYING,)
    if purpose is Purpose.RECEIVE and (order.state_before_attention or order.state) in TURNED_BACK:
        return (OrderState.DELIVERED,)  # tried once more, by a robot that was told of it before it gave up
    if purpose is not Purpose.RETURN:
        return HANDED_OVER[purpose]
    return (*HANDED_OVER[purpose], await _taken_back(report, order, receipt))


async def _taken_back(report: Report, order: Order, receipt: HandoverReceipt) -> OrderState:
    """Find out who took it: the code tells; with none, the place."""
    for code in codes_of(order, await delegates_of(report.session, [order])):
        if code.sha256(report.orders.key) == receipt.code_sha256:
            of_delegate = Holder.RECIPIENT if code.purpose is Purpose.RECEIVE else Holder.SENDER
            return TAKEN_BACK_BY[of_delegate if code.holder is Holder.DELEGATE else code.holder]
    return OrderState.RETURNED if receipt.post == order.from_post else OrderState.HELD


async def _is_receipted(report: Report, receipt: HandoverReceipt) -> bool:
    same = select(Handover.id).where(
        Handover.order_id == receipt.order_id,
        Handover.stop_id == receipt.stop_id,
        Handover.purpose == receipt.purpose,
    )
    return (await report.session.exec(same)).first() is not None
