"""Corridors that robots found closed: told as faults whose sentences name them, kept as alarms until they are over."""

import re
from datetime import datetime
from typing import Final

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Alarm
from maps import corridor_name

WAY_BLOCKED: Final = "way_blocked"
_TURNED_BACK: Final = re.compile(r"The robot turned back in the corridor from (\w+) to (\w+)\.")
_TRIES_AGAIN: Final = re.compile(r"The robot tries the corridor between (\w+) and (\w+) again\.")


def closed_corridor(fault: str, reason: str) -> str | None:
    """The name that maps have for the corridor of this fault; None if it is about something else."""
    return _named(_TURNED_BACK, fault, reason)


def open_corridor(fault: str, reason: str) -> str | None:
    """The same, when it is over; None for a robot that says of all of them at once that they are."""
    return _named(_TRIES_AGAIN, fault, reason)


def _named(pattern: re.Pattern[str], fault: str, reason: str) -> str | None:
    told = pattern.match(reason) if fault == WAY_BLOCKED else None
    return corridor_name(*told.groups()) if told else None


async def clear_corridor(session: AsyncSession, robot: str, corridor: str, now: datetime) -> None:
    """This one is over; others that the robot found closed go on ringing."""
    open_ones = select(Alarm).where(Alarm.robot == robot, Alarm.name == WAY_BLOCKED, col(Alarm.cleared_at).is_(None))
    for alarm in (await session.exec(open_ones)).all():
        if closed_corridor(alarm.name, alarm.reason) == corridor:
            alarm.cleared_at = now
