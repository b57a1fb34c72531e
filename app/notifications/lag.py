"""The lag of the channels, for monitoring."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime

from sqlmodel import col, func, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Notification, OutgoingNotification


@dataclass(frozen=True)
class OutboxLag:
    """`oldest_s` is the age of the oldest notice that a channel still owes; what was given up is counted apart."""

    oldest_s: float
    waiting: Mapping[str, int]
    given_up: Mapping[str, int]
    not_routed: int


async def outbox_lag(session: AsyncSession, now: datetime) -> OutboxLag:
    """By channel; quick, whatever has been sent before."""
    owed = col(OutgoingNotification.next_try_at).is_not(None)
    begun = func.min(col(OutgoingNotification.created_at))
    waiting = await session.exec(
        select(OutgoingNotification.channel, func.count(), begun).where(owed).group_by(OutgoingNotification.channel)
    )
    rows = waiting.all()
    gave_up = select(OutgoingNotification.channel, func.count()).where(
        col(OutgoingNotification.gave_up_at).is_not(None)
    )
    given_up = (await session.exec(gave_up.group_by(OutgoingNotification.channel))).all()
    new = (
        await session.exec(select(func.count(), func.min(Notification.at)).where(col(Notification.routed_at).is_(None)))
    ).one()
    oldest = min([at for _, _, at in rows] + ([new[1]] if new[1] else []), default=now)
    return OutboxLag(
        oldest_s=max(0.0, (now - oldest).total_seconds()),
        waiting={channel: count for channel, count, _ in rows},
        given_up=dict(given_up),
        not_routed=new[0],
    )
