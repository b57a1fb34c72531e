"""Erasing a person: nothing leads to them any more, while the orders and their custody stay as records.

The row of the person stays too, with name and address replaced, since orders refer to it.
"""

from collections.abc import Mapping
from datetime import datetime
from email import message_from_bytes
from enum import StrEnum
from pathlib import Path
from typing import Any, Final

from sqlalchemy import ColumnElement, delete, update
from sqlmodel import col, or_, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.errors import StartError
from app.models import (
    Contact,
    Delegate,
    IdempotencyKey,
    Notification,
    Order,
    OrderEvent,
    OutgoingNotification,
    Person,
    Role,
    SignInCode,
    StandingOrder,
    metadata,
)
from app.models.orders.order_events import DELEGATE_NAMED, DELEGATE_REVOKED
from app.orders.transitions import ENDED

ERASED_NAME: Final = "Erased"
ERASED_DOMAIN: Final = "erased.invalid"
"""RFC 2606: no mail can ever go there."""


class Fate(StrEnum):
    """The fate of a row that refers to an erased person."""

    GOES = "goes"
    STAYS = "stays"


FATES: Final[Mapping[str, Fate]] = {
    "alarms": Fate.STAYS,
    "closed_corridors": Fate.STAYS,
    "contacts": Fate.GOES,
    "delegates": Fate.STAYS,
    "enrolment_codes": Fate.STAYS,
    "handovers": Fate.STAYS,
    "idempotency_keys": Fate.GOES,
    "identities": Fate.GOES,
    "notice_wishes": Fate.GOES,
    "notices": Fate.GOES,
    "order_events": Fate.STAYS,
    "order_links": Fate.GOES,
    "orders": Fate.STAYS,
    "person_tokens": Fate.GOES,
    "push_subscriptions": Fate.GOES,
    "robot_commands": Fate.STAYS,
    "sessions": Fate.GOES,
    "standing_orders": Fate.STAYS,
    "webhooks": Fate.GOES,
}
"""Every table that refers to people, so that a new one cannot be forgotten: a test compares."""


class OrderUnderWay(StartError):
    """A robot would stand at a post with mail for an erased person."""


class LastMaintainerStays(StartError):
    """Without a maintainer no role could be given any more."""


async def erase(session: AsyncSession, person: Person, now: datetime) -> int:
    """Replace name and address, take away every way in and everything said; the number of orders that stay.

    Raises OrderUnderWay, LastMaintainerStays.
    """
    await _refuse_the_last_maintainer(session, person)
    orders = (await session.exec(select(Order).where(_takes_part(person)))).all()
    under_way = [order.id for order in orders if order.state not in ENDED]
    if under_way:
        raise OrderUnderWay(
            f"{person.email} has an order under way ({', '.join(under_way)}). Erase when it has ended, or cancel it."
        )
    await _forget_what_others_know(session, person, [order.id for order in orders])
    await _end_standing_orders(session, person, now)
    await delete_rows(session, person)
    for order in orders:
        order.description = None
    person.email, person.name = f"{person.id}@{ERASED_DOMAIN}", ERASED_NAME
    person.usual_post, person.roles = None, []
    return len(orders)


async def _refuse_the_last_maintainer(session: AsyncSession, person: Person) -> None:
    everybody = (await session.exec(select(Person))).all() if person.has_role(Role.MAINTAINER) else []
    if [one.id for one in everybody if one.has_role(Role.MAINTAINER)] == [person.id]:
        raise LastMaintainerStays(f"{person.email} is the last maintainer. Give another person the role first.")


def _takes_part(person: Person) -> Any:
    return or_(
        col(Order.sender_id) == person.id, col(Order.recipient_id) == person.id, col(Order.placed_by_id) == person.id
    )


async def _forget_what_others_know(session: AsyncSession, person: Person, order_ids: list[str]) -> None:
    """Their name in what others were told, in answers kept for retries, in address books, as a delegate."""
    names = {person.name, person.email}
    for notice in (await session.exec(select(Notification).where(col(Notification.order_id).in_(order_ids)))).all():
        notice.facts = {key: ERASED_NAME if value in names else value for key, value in notice.facts.items()}
    partners = select(Order.sender_id).where(_takes_part(person))
    await session.exec(delete(IdempotencyKey).where(col(IdempotencyKey.person_id).in_(partners)))
    await session.exec(delete(Contact).where(col(Contact.email) == person.email))
    await session.exec(delete(SignInCode).where(col(SignInCode.email) == person.email))
    theirs = or_(col(Delegate.email) == person.email, col(Delegate.named_by_id) == person.id)
    await forget_delegates(session, theirs)


async def forget_delegates(session: AsyncSession, which: ColumnElement[bool], **more: str) -> None:
    """Their names and addresses, in the timelines of their orders too; `more`: what else becomes of their rows."""
    for order_id, name in (await session.exec(select(Delegate.order_id, Delegate.name).where(which))).all():
        of_them = (col(OrderEvent.kind).in_((DELEGATE_NAMED, DELEGATE_REVOKED)), col(OrderEvent.reason) == name)
        told = update(OrderEvent).where(col(OrderEvent.order_id) == order_id, *of_them)
        await session.exec(told.values(reason=ERASED_NAME))
    await session.exec(update(Delegate).where(which).values(name=ERASED_NAME, email=None, **more))


async def _end_standing_orders(session: AsyncSession, person: Person, now: datetime) -> None:
    theirs = or_(col(StandingOrder.sender_id) == person.id, col(StandingOrder.recipient_id) == person.id)
    await session.exec(update(StandingOrder).where(theirs).values(description=None, next_at=None))
    still_going = update(StandingOrder).where(theirs, col(StandingOrder.ended_at).is_(None))
    await session.exec(still_going.values(ended_at=now))


async def delete_rows(session: AsyncSession, person: Person) -> None:
    """Every way in, every wish, and what they were told."""
    connection = await session.connection()
    told = select(Notification.id).where(Notification.person_id == person.id)
    await session.exec(delete(OutgoingNotification).where(col(OutgoingNotification.notice_id).in_(told)))
    for name, fate in FATES.items():
        if fate is Fate.GOES:
            table = metadata.tables[name]
            await connection.execute(delete(table).where(table.c.person_id == person.id))


def erase_mails(spool: Path, email: str) -> int:
    """Delete the mails to this address that lie in the spool folder; how many."""
    found = [file for file in spool.glob("*.eml") if _is_to(file, email)]
    for file in found:
        file.unlink()
    return len(found)


def _is_to(file: Path, email: str) -> bool:
    return str(message_from_bytes(file.read_bytes()).get("To", "")).lower() == email
