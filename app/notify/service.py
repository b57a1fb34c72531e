"""Writes notices, and what is to be sent of them, in the transaction of whatever they tell of."""

from collections.abc import Mapping
from datetime import datetime

from sqlalchemy import func, update
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.database import after_commit
from app.live.feed import Feed, Happening
from app.notify.schemas import Inbox, NoticeView
from app.paging import Paging, Sorting
from app.tables import Notice, NoticeKind, OutgoingNotice, Person

CHANNELS = ("mail",)
"""Besides the inbox, which is the table of notices itself."""
NEWEST_FIRST = Sorting("notices", col(Notice.id), descending=True)


async def tell(
    session: AsyncSession,
    feed: Feed,
    *,
    person: Person,
    key: str,
    order_id: str | None,
    kind: NoticeKind,
    facts: Mapping[str, str],
    now: datetime,
) -> bool:
    """Tell one person one thing, which `key` names; False if they were told before."""
    if await _told(session, person, key):
        return False
    notice = Notice(key=key, order_id=order_id, kind=kind, person_id=person.id, at=now, facts=dict(facts))
    session.add(notice)
    await session.flush()
    for channel in CHANNELS:
        session.add(_outgoing(notice, channel))
    view = NoticeView.of(notice, person.language).model_dump(mode="json")
    after_commit(session, lambda: feed.publish(Happening("notice", view, person_id=person.id)))
    return True


async def _told(session: AsyncSession, person: Person, key: str) -> bool:
    wanted = select(Notice.id).where(Notice.person_id == person.id, Notice.key == key)
    return (await session.exec(wanted)).first() is not None


def _outgoing(notice: Notice, channel: str) -> OutgoingNotice:
    key = f"{channel}.{notice.key}.{notice.person_id}"
    assert notice.id is not None  # noqa: S101  # flushed rows have one
    return OutgoingNotice(key=key, channel=channel, notice_id=notice.id, created_at=notice.at, next_try_at=notice.at)


async def inbox(session: AsyncSession, person: Person, page: Paging) -> Inbox:
    """What a person was told, newest first."""
    notices, following = await page.of(session, select(Notice).where(Notice.person_id == person.id), NEWEST_FIRST)
    unread = select(func.count()).where(Notice.person_id == person.id, col(Notice.read_at).is_(None))
    return Inbox(
        items=[NoticeView.of(notice, person.language) for notice in notices],
        next=following,
        unread=(await session.exec(unread)).one(),
    )


async def mark_read(session: AsyncSession, person: Person, ids: list[int], now: datetime) -> None:
    """Mark notices of this person as read; others' stay as they are."""
    theirs = update(Notice).where(
        col(Notice.id).in_(ids), col(Notice.person_id) == person.id, col(Notice.read_at).is_(None)
    )
    await session.exec(theirs.values(read_at=now))
