"""When something was last written down: at a start the only witness of what time it is, besides the clock itself."""

from datetime import datetime

from sqlmodel import col, func, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Notification, PersonSession, RobotRow, SignInCode


async def last_record(session: AsyncSession) -> datetime | None:
    """The time of the newest record of what happens often: robots heard, notices, sign-ins. None in a new database."""
    heard = (await session.exec(select(func.max(RobotRow.heard_at)))).one()
    newest = [
        (await session.exec(select(at).order_by(number.desc()).limit(1))).first()
        for at, number in (
            (col(Notification.at), col(Notification.id)),
            (col(PersonSession.created_at), col(PersonSession.id)),
            (col(SignInCode.created_at), col(SignInCode.id)),
        )
    ]
    return max((at for at in (heard, *newest) if at is not None), default=None)
