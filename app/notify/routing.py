"""Takes new notices to the outbox of each channel that is to carry them, and tells the open pages of their readers.

It follows the transaction that wrote the notices, so that placing an order waits for none of it. What a crash comes
between is still marked as not routed.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime

import structlog
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.database import after_commit
from app.live.feed import Feed, Happening
from app.notify.schemas import NoticeView
from app.notify.wishes import MAIL, PUSH, WEBHOOK, channels_for
from app.tables import Notice, NoticeWishes, OutgoingNotice, Person, PushSubscription, Webhook

log = structlog.get_logger(__name__)

AT_ONCE = 100
SERVICE = "service"
"""The target of the one webhook that is told of everything."""


@dataclass(frozen=True)
class Readers:
    """What is known of the people that some notices are for."""

    people: Mapping[str, Person]
    muted: Mapping[str, Mapping[str, Sequence[str]]]
    targets: Mapping[tuple[str, str], Sequence[str]]
    """By (person, channel): their devices, their webhook."""

    def reachable(self, person_id: str) -> set[str]:
        return {MAIL} | {channel for channel in (PUSH, WEBHOOK) if self.targets.get((person_id, channel))}


async def not_routed(session: AsyncSession, limit: int = AT_ONCE) -> list[Notice]:
    """The oldest notices that no channel has yet."""
    waiting = select(Notice).where(col(Notice.routed_at).is_(None)).order_by(col(Notice.id)).limit(limit)
    return list((await session.exec(waiting)).all())


async def route(session: AsyncSession, feed: Feed, now: datetime, *, tell_service: bool) -> int:
    """Route what waits, at most AT_ONCE notices; how many there were."""
    notices = await not_routed(session)
    readers = await _readers(session, {notice.person_id for notice in notices})
    for notice in notices:
        session.add_all(_outgoing(notice, readers, tell_service=tell_service))
        notice.routed_at = now
        _tell_pages(session, feed, notice, readers.people[notice.person_id])
    return len(notices)


async def _readers(session: AsyncSession, ids: Iterable[str]) -> Readers:
    ids = list(ids)
    people = (await session.exec(select(Person).where(col(Person.id).in_(ids)))).all()
    wishes = (await session.exec(select(NoticeWishes).where(col(NoticeWishes.person_id).in_(ids)))).all()
    devices = (await session.exec(select(PushSubscription).where(col(PushSubscription.person_id).in_(ids)))).all()
    hooks = (await session.exec(select(Webhook).where(col(Webhook.person_id).in_(ids)))).all()
    targets: defaultdict[tuple[str, str], list[str]] = defaultdict(list)
    for device in devices:
        targets[device.person_id, PUSH].append(device.id)
    for hook in hooks:
        targets[hook.person_id, WEBHOOK].append(hook.id)
    return Readers({one.id: one for one in people}, {one.person_id: one.muted for one in wishes}, targets)


def _outgoing(notice: Notice, readers: Readers, *, tell_service: bool) -> Iterator[OutgoingNotice]:
    person_id = notice.person_id
    for channel in channels_for(notice.kind, readers.muted.get(person_id), readers.reachable(person_id)):
        for target in readers.targets.get((person_id, channel), (None,)):
            yield _sending(notice, channel, target)
    if tell_service:
        yield _sending(notice, WEBHOOK, SERVICE)


def _sending(notice: Notice, channel: str, target: str | None) -> OutgoingNotice:
    key = ".".join(part for part in (channel, notice.key, notice.person_id, target) if part)
    assert notice.id is not None  # noqa: S101  # it was read from its table
    return OutgoingNotice(
        key=key, channel=channel, target=target, notice_id=notice.id, created_at=notice.at, next_try_at=notice.at
    )


def _tell_pages(session: AsyncSession, feed: Feed, notice: Notice, person: Person) -> None:
    try:
        view = NoticeView.of(notice, person.language).model_dump(mode="json")
    except KeyError as gap:  # a notice that lacks a fact of its text holds up no other
        log.exception("notice without words", key=notice.key, gap=str(gap))
        return
    after_commit(session, lambda: feed.publish(Happening("notice", view, person_id=person.id)))
