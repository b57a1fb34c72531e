"""Something about a robot that a person should look at. Kept until it is over; logged at once."""

from datetime import datetime
from typing import Final

import structlog
from sqlmodel import col, select, update
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import connection_of
from app.models import Alarm
from app.notifications.service import tell_dispatchers

CONTRADICTION: Final = "custody_contradicts_order"
VANISHED: Final = "vanished"
log = structlog.get_logger(__name__)


async def raise_alarm(
    session: AsyncSession, robot: str, name: str, reason: str, *, now: datetime, post: str | None = None
) -> None:
    """Ring once for as long as it lasts, and tell who dispatches: the same alarm again changes nothing."""
    log.warning("alarm", robot=robot, name=name, reason=reason, post=post)
    same = select(Alarm.id).where(Alarm.robot == robot, Alarm.name == name, Alarm.reason == reason[:500])
    if (await session.exec(same.where(col(Alarm.cleared_at).is_(None)))).first() is None:
        alarm = Alarm(robot=robot, name=name[:64], reason=reason[:500], post=post, at=now)
        session.add(alarm)
        await session.flush()
        await tell_dispatchers(session, alarm)


async def clear_alarms(session: AsyncSession, robot: str, name: str, now: datetime, about: str = "") -> None:
    """It is over. `about`: only what speaks of this, an order's id say; others of the name go on ringing."""
    over = update(Alarm).where(col(Alarm.robot) == robot, col(Alarm.name) == name, col(Alarm.cleared_at).is_(None))
    if about:
        over = over.where(col(Alarm.reason).contains(about, autoescape=True))
    # Past the session: it is asked at each greeting, and nearly always there is none.
    await (await connection_of(session)).execute(over.values(cleared_at=now))
