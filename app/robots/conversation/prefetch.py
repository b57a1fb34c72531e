"""The rows that some messages will ask for, fetched together: one question per table instead of one per message."""

from collections.abc import Sequence
from typing import Final

from sqlalchemy import bindparam
from sqlmodel import SQLModel, col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import MissionRow, StopRow
from protocol.parts import Part
from protocol.to_server import Event


async def prefetch(session: AsyncSession, messages: Sequence[Part]) -> Sequence[SQLModel]:
    """Fetch them into the session, which gives them to later readers, as long as the answer is held."""
    happened = [message.happened for message in messages if isinstance(message, Event)]
    if len(happened) < 2:  # one message asks for itself
        return []
    rows: list[SQLModel] = []
    if mission_ids := _named(happened, "mission_id"):
        rows += (await session.exec(_MISSIONS, params={"ids": mission_ids})).all()
    if stop_ids := _named(happened, "stop_id"):
        rows += (await session.exec(_STOPS, params={"ids": stop_ids})).all()
    return rows


_MISSIONS: Final = select(MissionRow).where(col(MissionRow.id).in_(bindparam("ids", expanding=True)))
_STOPS: Final = select(StopRow).where(col(StopRow.id).in_(bindparam("ids", expanding=True)))


def _named(happened: Sequence[Part], field: str) -> list[str]:
    return list({found for one in happened if (found := getattr(one, field, None))})
