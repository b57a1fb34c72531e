"""The rows that some messages will ask for, fetched together: one question per table instead of one per message."""

from collections.abc import Sequence

from sqlmodel import SQLModel, col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.tables import MissionRow, StopRow
from protocol.parts import Part
from protocol.to_server import Event


async def look_ahead(session: AsyncSession, messages: Sequence[Part]) -> Sequence[SQLModel]:
    """Fetch them into the session, which gives them to whoever asks, as long as the answer is held."""
    happened = [message.happened for message in messages if isinstance(message, Event)]
    if len(happened) < 2:  # one message asks for itself
        return []
    missions = select(MissionRow).where(col(MissionRow.id).in_(_named(happened, "mission_id")))
    stops = select(StopRow).where(col(StopRow.id).in_(_named(happened, "stop_id")))
    return [*(await session.exec(missions)).all(), *(await session.exec(stops)).all()]


def _named(happened: Sequence[Part], field: str) -> set[str]:
    return {found for one in happened if (found := getattr(one, field, None))}
