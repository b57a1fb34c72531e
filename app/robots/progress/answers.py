"""Consequences of robots' answers to commands."""

from typing import Final

from sqlmodel import col, select

from app.models import MissionRow, MissionState, OrderState, RobotCommand, RobotRow
from app.orders.service import Actor
from app.orders.stops import is_own, stops_of_order
from app.orders.transitions import ROBOT_COMING, By
from app.robots.alarms import CONTRADICTION, clear_alarms, raise_alarm
from app.robots.commands import REVOKE, answered
from app.robots.progress.missions import drop_order, drop_stops, end_what_is_empty, let_go_of
from app.robots.progress.reports import Report
from protocol.to_server import CommandAnswer

RECALLED: Final = "The robot was recalled."


async def follow_answer(report: Report, answer: CommandAnswer) -> None:
    """Raises UnknownCommand."""
    known = await report.session.get(RobotCommand, answer.command_id)
    if known is not None and known.robot == report.robot and known.answered_at is not None:
        return  # answered before: what it asked for may be over, or be asked for again by now
    command = await answered(report.session, report.robot, answer, report.now)
    if command.kind == "cancel" and command.order_id is not None:
        await _let_go(report, answer, command.order_id)
    elif command.kind == "recall" and answer.accepted:
        await _recalled(report, answer, command)
    elif command.kind == REVOKE and answer.accepted:
        await _taken_out(report)
    elif command.kind == "confirm" and command.order_id is not None and not answer.accepted:
        # The person who tapped reads it on their page; no other has to look.
        actor = report.actor(answer.happened_at, None, answer.reason)
        await report.orders.ledger.note(report.session, command.order_id, "confirm_refused", actor)
    elif not answer.accepted:
        await _refused(report, answer)


async def _let_go(report: Report, answer: CommandAnswer, order_id: str) -> None:
    order = await report.orders.ledger.order(report.session, order_id)
    is_theirs = order.robot == report.robot
    if answer.accepted:
        await drop_stops(report, order_id)
        # It has nothing of this order any more: what came aboard too late was taken out by hand.
        await clear_alarms(report.session, report.robot, CONTRADICTION, report.now, about=order_id)
        requested = order.cancel_requested_at or order.reassign_requested_at
        if is_theirs and order.state in ROBOT_COMING and requested:
            await drop_order(report, order, report.actor(answer.happened_at, None, answer.reason))
    elif is_theirs and order.cancel_requested_at is not None and order.state in CARRIED:
        # The request came too late to leave the mail where it was: now it is brought back.
        await report.orders.returning.ask_back(
            report.session, order, Actor(By.ROBOT, robot=report.robot, reason=answer.reason)
        )
    else:
        order.reassign_requested_at = None
        for stop in await stops_of_order(report.session, order_id, report.robot):
            # Updates have left it out meanwhile.
            (await report.session.get_one(MissionRow, stop.mission_id)).update_number += 1
        await _refused(report, answer)


async def _taken_out(report: Report) -> None:
    """It stands, and does not know where it is; as soon as it does, it says so."""
    robot = await report.session.get_one(RobotRow, report.robot, with_for_update=True)
    robot.taken_out_at = None
    robot.post = robot.previous = robot.towards = robot.seen_at = None


CARRIED: Final = (OrderState.CARRYING, OrderState.AT_RECIPIENT)


async def _refused(report: Report, answer: CommandAnswer) -> None:
    reason = answer.reason or f"the robot refused {answer.command_id}"
    await raise_alarm(report.session, report.robot, "command_refused", reason, now=report.now)


async def _recalled(report: Report, answer: CommandAnswer, command: RobotCommand) -> None:
    """It has dropped the mission that it had; with mail aboard it has told of its own before this answer."""
    wanted = select(MissionRow).where(
        MissionRow.robot == report.robot,
        MissionRow.state == MissionState.ACTIVE,
        MissionRow.created_at <= command.asked_at,
    )
    for mission in (await report.session.exec(wanted.order_by(col(MissionRow.created_at)))).all():
        if not is_own(mission.id):
            await let_go_of(report, mission, report.actor(answer.happened_at, None, RECALLED))
    await end_what_is_empty(report)
