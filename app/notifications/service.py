"""Writes notices, in the transaction of whatever they tell of; the inbox is read from them."""

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from typing import Any, Final

from sqlalchemy import String, cast, delete, update
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.unread import unread_notices
from app.core.database.database import write_all_once, write_once
from app.core.paging import Paging, Sorting
from app.models import Alarm, Notification, NotificationKind, OutgoingNotification, Person, Role
from app.notifications.schemas import Inbox, NotificationView

COMES_AND_GOES: Final = timedelta(minutes=10)
NEWEST_FIRST = Sorting("notices", col(Notification.id), descending=True)


async def tell(
    session: AsyncSession,
    *,
    person: Person,
    key: str,
    order_id: str | None,
    kind: NotificationKind,
    facts: Mapping[str, str],
    now: datetime,
) -> bool:
    """Tell one person one thing, which `key` names; False if they were told before.

    The outbox worker takes it from here to the person's channels (`app.notifications.routing`).
    """
    return await write_once(session, Notification, notice_row(person.id, key, order_id, kind, facts, now))


async def tell_all(session: AsyncSession, notices: Sequence[Mapping[str, Any]]) -> None:
    """The same for several of a kind."""
    await write_all_once(session, Notification, notices)


def notice_row(
    person_id: str, key: str, order_id: str | None, kind: NotificationKind, facts: Mapping[str, str], now: datetime
) -> dict[str, Any]:
    """For those who have several to write."""
    return {"person_id": person_id, "key": key, "order_id": order_id, "kind": kind, "at": now, "facts": dict(facts)}


async def withdraw(session: AsyncSession, person_id: str, key: str) -> bool:
    """Send no more of what was told; whether the person may have seen it, so that they have to be told."""
    notice = (
        await session.exec(select(Notification).where(Notification.person_id == person_id, Notification.key == key))
    ).first()
    if notice is None:
        return False
    theirs = col(OutgoingNotification.notice_id) == notice.id
    await session.exec(delete(OutgoingNotification).where(theirs, col(OutgoingNotification.next_try_at).is_not(None)))
    if notice.routed_at is None:
        await session.delete(notice)
    return notice.routed_at is not None


async def tell_dispatchers(session: AsyncSession, alarm: Alarm) -> None:
    """Tell everybody who dispatches of a new alarm. One that is acknowledged or over is silent, or comes and goes."""
    if alarm.acknowledged_at or alarm.cleared_at or await _was_just_over(session, alarm):
        return
    facts = {"robot": alarm.robot, "reason": alarm.reason, "post": alarm.post or ""}
    for person in await _with_role(session, Role.DISPATCHER):
        await tell(
            session,
            person=person,
            key=f"alarm.{alarm.id}",
            order_id=None,
            kind=NotificationKind.ALARM,
            facts=facts,
            now=alarm.at,
        )


async def _was_just_over(session: AsyncSession, alarm: Alarm) -> bool:
    """A robot that people brush past all day rings each time: they are told of it once."""
    same = select(Alarm.id).where(Alarm.robot == alarm.robot, Alarm.name == alarm.name, Alarm.id != alarm.id)
    return (await session.exec(same.where(col(Alarm.cleared_at) > alarm.at - COMES_AND_GOES))).first() is not None


async def _with_role(session: AsyncSession, role: Role) -> list[Person]:
    # Roles are a JSON list, which the two databases search in ways of their own: as text they are alike.
    named = select(Person).where(cast(col(Person.roles), String).contains(f'"{role}"', autoescape=True))
    return [person for person in (await session.exec(named)).all() if person.has_role(role)]


async def inbox(session: AsyncSession, person: Person, page: Paging) -> Inbox:
    """Return what a person was told, newest first."""
    notices, following = await page.of(
        session, select(Notification).where(Notification.person_id == person.id), NEWEST_FIRST
    )
    return Inbox(
        items=[NotificationView.of(notice, person.language) for notice in notices],
        next=following,
        unread=await unread_notices(session, person.id),
    )


async def mark_read(session: AsyncSession, person: Person, ids: list[int], now: datetime) -> None:
    """Mark notices of this person as read; others' stay as they are."""
    theirs = update(Notification).where(
        col(Notification.id).in_(ids), col(Notification.person_id) == person.id, col(Notification.read_at).is_(None)
    )
    await session.exec(theirs.values(read_at=now))
