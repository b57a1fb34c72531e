"""Into which corridors no robot is let: those that people have closed, and those that a robot found closed, for as long
as its alarm is not over. One truth, looked up and never copied."""

from collections.abc import Mapping
from datetime import datetime
from functools import partial

from pydantic import BaseModel, Field
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import after_commit
from app.core.texts.reasons import Words, words_of
from app.models import Alarm, ClosedCorridor
from app.realtime.feed import Feed, FeedEvent
from app.robots.corridors.closed_corridors import WAY_BLOCKED, closed_corridor


class ClosedCorridorView(BaseModel):
    """A corridor into which no robot is let, since when and why: the reason of the person who has closed it, else the
    words of the robot that turned back there."""

    corridor: str
    reason: str
    why_words: Words | None = Field(
        description="What a robot says, as a text of the catalogue; null: a person's words."
    )
    closed_at: datetime
    by_person: bool
    robots: list[str] = Field(description="Those that turned back there, and have not tried it again.")


class ClosedCorridors(BaseModel):
    """Closed corridors, all of them, by name: they replace what was known."""

    closed: list[ClosedCorridorView]


async def found_closed(session: AsyncSession) -> dict[str, list[Alarm]]:
    """The alarms of robots that turned back, by corridor, oldest first."""
    ringing = select(Alarm).where(Alarm.name == WAY_BLOCKED, col(Alarm.cleared_at).is_(None)).order_by(col(Alarm.id))
    found: dict[str, list[Alarm]] = {}
    for alarm in (await session.exec(ringing)).all():
        if corridor := closed_corridor(alarm.name, alarm.reason):
            found.setdefault(corridor, []).append(alarm)
    return found


async def closed_names(session: AsyncSession) -> frozenset[str]:
    """Return the corridors that people have closed and those that robots found closed."""
    by_people = (await session.exec(select(ClosedCorridor.corridor))).all()
    return frozenset((*by_people, *await found_closed(session)))


async def all_closed(session: AsyncSession) -> ClosedCorridors:
    """By name."""
    by_people = {row.corridor: row for row in (await session.exec(select(ClosedCorridor))).all()}
    found = await found_closed(session)
    return ClosedCorridors(closed=[_view(name, by_people, found) for name in sorted({*by_people, *found})])


def _view(name: str, by_people: Mapping[str, ClosedCorridor], found: Mapping[str, list[Alarm]]) -> ClosedCorridorView:
    row, alarms = by_people.get(name), found.get(name, [])
    reason, since = (row.reason, row.closed_at) if row else (alarms[0].reason, alarms[0].at)
    return ClosedCorridorView(
        corridor=name,
        reason=reason,
        why_words=None if row else words_of(reason),
        closed_at=since,
        by_person=row is not None,
        robots=sorted({alarm.robot for alarm in alarms}),
    )


async def tell_of_closed(session: AsyncSession, feed: Feed) -> ClosedCorridors:
    """After the commit: pages see it."""
    await session.flush()
    closed = await all_closed(session)
    after_commit(session, partial(feed.publish, FeedEvent("closed", closed)))
    return closed
