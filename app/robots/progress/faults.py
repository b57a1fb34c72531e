"""Consequences of a robot's faults: an alarm, and with mail aboard an order that a person has to see to."""

from typing import Final

from sqlmodel import col, select

from app.models import Alarm, OrderState
from app.orders.transitions import MAIL_ABOARD
from app.robots.alarms import clear_alarms, raise_alarm
from app.robots.corridors.closed_corridors import clear_corridor, open_corridor
from app.robots.progress.reports import Report
from protocol.to_server import Fault

NEEDS_A_PERSON: Final = frozenset(
    {
        "emergency_stop",
        "wheel_drop",
        "cliff",
        "line_sensor",
        "camera_lost",
        "battery_critical",
        "base_silent",
        "agent_silent",
        "stuck",
    }
)
"""The robot's faults (docs/reference/faults.md) that it does not recover from by itself; the others delay no person."""


async def follow_fault(report: Report, fault: Fault) -> None:
    """A fault begins or is over."""
    if fault.cleared and (corridor := open_corridor(fault.name, fault.reason)):
        await clear_corridor(report.session, report.robot, corridor, report.now)
        return
    if fault.cleared:
        await _over(report, fault)
        return
    await raise_alarm(report.session, report.robot, fault.name, fault.reason, now=report.now, post=fault.post)
    if fault.name in NEEDS_A_PERSON:
        for order in await report.aboard(*MAIL_ABOARD):
            actor = report.actor(fault.happened_at, fault.post, fault.reason)
            await report.orders.ledger.move(report.session, order.id, OrderState.ATTENTION, actor)


async def _over(report: Report, fault: Fault) -> None:
    """Orders that waited for this very fault go on; those that a dispatcher stopped, or another fault, do not."""
    open_ones = select(Alarm.reason).where(
        Alarm.robot == report.robot, Alarm.name == fault.name, col(Alarm.cleared_at).is_(None)
    )
    reasons = (await report.session.exec(open_ones)).all()
    await clear_alarms(report.session, report.robot, fault.name, report.now)
    if fault.name not in NEEDS_A_PERSON:
        return
    for order in await report.aboard(OrderState.ATTENTION):
        if order.why in reasons and order.state_before_attention is not None:
            actor = report.actor(fault.happened_at, fault.post, fault.reason)
            await report.orders.ledger.move(report.session, order.id, order.state_before_attention, actor)
