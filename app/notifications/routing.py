"""Takes new notices to the outbox of each channel that is to carry them, and tells the open pages of their readers.

It follows the transaction that wrote the notices, so that placing an order waits for none of it. What a crash comes
between is still marked as not routed.
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final

import structlog
from sqlalchemy import bindparam, insert, literal, union_all, update
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import after_commit, connection_of
from app.models import Notification, NotificationPreferences, OutgoingNotification, Person, PushSubscription, Webhook
from app.notifications.preferences import MAIL, PUSH, WEBHOOK, channels_for
from app.notifications.schemas import NotificationView
from app.realtime.feed import Feed, FeedEvent

log = structlog.get_logger(__name__)

AT_ONCE: Final = 100
SERVICE: Final = "service"
"""The target of the one webhook that is told of everything."""

Muted = Mapping[str, Sequence[str]]
Targets = Mapping[tuple[str, str], Sequence[str]]
"""By (person, channel): their devices, their webhook."""

_IS_NEW: Final = col(Notification.routed_at).is_(None)
_READERS: Final = select(Notification.person_id).where(_IS_NEW)
_NEW: Final[Any] = (
    select(Notification, Person, NotificationPreferences.muted)
    .join(Person, col(Notification.person_id) == Person.id)
    .outerjoin(NotificationPreferences, col(NotificationPreferences.person_id) == Person.id)
    .where(_IS_NEW)
    .order_by(col(Notification.id))
    .limit(AT_ONCE)
)
_TARGETS: Final[Any] = union_all(
    select(literal(PUSH), PushSubscription.person_id, PushSubscription.id).where(
        col(PushSubscription.person_id).in_(_READERS)
    ),
    select(literal(WEBHOOK), Webhook.person_id, Webhook.id).where(col(Webhook.person_id).in_(_READERS)),
)
_ROUTED: Final = (
    update(Notification).where(col(Notification.id) == bindparam("its_id")).values(routed_at=bindparam("now"))
)
_OUTGOING: Final = insert(OutgoingNotification)


@dataclass(frozen=True)
class New:
    """A notice that no channel has yet, and its reader; `muted` is None for a reader who has changed nothing."""

    notice: Notification
    person: Person
    muted: Muted | None


async def route(session: AsyncSession, feed: Feed, now: datetime, *, tell_service: bool) -> set[str]:
    """Route what waits, at most AT_ONCE notices; which channels have something to send now."""
    news = [New(*row) for row in await session.exec(_NEW)]
    if not news:
        return set()
    targets = await _targets(session)
    rows = [row for new in news for row in _outgoing(new, targets, tell_service=tell_service)]
    connection = await connection_of(session)
    if rows:
        await connection.execute(_OUTGOING, rows)
    await connection.execute(_ROUTED, [{"its_id": new.notice.id, "now": now} for new in news])
    for new in news:
        _tell_pages(session, feed, new)
    return {row["channel"] for row in rows}


async def _targets(session: AsyncSession) -> Targets:
    targets: defaultdict[tuple[str, str], list[str]] = defaultdict(list)
    for channel, person_id, target in await session.exec(_TARGETS):
        targets[person_id, channel].append(target)
    return targets


def _outgoing(new: New, targets: Targets, *, tell_service: bool) -> Iterator[dict[str, Any]]:
    person_id = new.person.id
    reachable = {MAIL} | {channel for channel in (PUSH, WEBHOOK) if (person_id, channel) in targets}
    for channel in channels_for(new.notice.kind, new.muted, reachable):
        for target in targets.get((person_id, channel), (None,)):
            yield _sending(new.notice, channel, target)
    if tell_service:
        yield _sending(new.notice, WEBHOOK, SERVICE)


def _sending(notice: Notification, channel: str, target: str | None) -> dict[str, Any]:
    key = ".".join(part for part in (channel, notice.key, notice.person_id, target) if part)
    return {
        "key": key,
        "channel": channel,
        "target": target,
        "notice_id": notice.id,
        "created_at": notice.at,
        "next_try_at": notice.at,
        "tries": 0,
    }


def _tell_pages(session: AsyncSession, feed: Feed, new: New) -> None:
    if not feed.is_heard:
        after_commit(session, feed.pass_over)
        return
    try:
        view = NotificationView.of(new.notice, new.person.language)
    except KeyError as gap:  # a notice that lacks a fact of its text holds up no other
        log.exception("notice without words", key=new.notice.key, gap=str(gap))
        return
    after_commit(session, lambda: feed.publish(FeedEvent("notice", view, person_id=new.person.id)))
