"""The number of unread notices."""

from sqlalchemy import func
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Notification


async def unread_notices(session: AsyncSession, person_id: str) -> int:
    """Count them all, whatever page of the inbox they are on."""
    unread = select(func.count()).where(Notification.person_id == person_id, col(Notification.read_at).is_(None))
    return (await session.exec(unread)).one()
