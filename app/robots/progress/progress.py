"""Consequences of robots' reports: one function per kind of report, in a table.

Each runs in the transaction that writes the report down, and does nothing the second time, so that a robot may repeat
itself.
"""

from collections.abc import Awaitable, Callable, Mapping
from typing import Any, Final

from app.robots.progress.answers import follow_answer
from app.robots.progress.at_stops import follow_progress
from app.robots.progress.faults import follow_fault
from app.robots.progress.handed_over import follow_receipt
from app.robots.progress.reports import Report
from protocol.parts import Part
from protocol.to_server import Charge, CommandAnswer, Event, Fault, HandoverReceipt, Progress

__all__ = ["Report", "follow"]


async def follow(report: Report, event: Event) -> None:
    """Do what follows. Raises FleetError or an order's TransitionRefused; nothing of it has happened then."""
    await _FOLLOW[type(event.happened)](report, event.happened)


async def _charge(report: Report, charge: Charge) -> None:
    """Written down with the message itself; nothing else depends on it (snapshots tell the present state)."""


_Follow = Callable[[Report, Any], Awaitable[None]]
_FOLLOW: Final[Mapping[type[Part], _Follow]] = {
    Progress: follow_progress,
    HandoverReceipt: follow_receipt,
    Charge: _charge,
    Fault: follow_fault,
    CommandAnswer: follow_answer,
}
