"""Taking names out of records that stay: orders whose time is over, and people of whom nothing is left.

Old orders all refer to one anonymous row: not even that two of them were the same person's can be told.
"""

from datetime import UTC, datetime
from typing import Any, Final

from sqlalchemy import ColumnElement, delete, exists, update
from sqlmodel import col, or_, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import (
    Delegate,
    Handover,
    Notification,
    Order,
    OrderEvent,
    OrderLink,
    OutgoingNotification,
    Person,
    PersonSession,
    PersonToken,
    RobotCommand,
    StandingOrder,
)
from app.orders.transitions import ENDED
from app.retention.erasure import ERASED_DOMAIN, ERASED_NAME, delete_rows, forget_delegates

ANONYMOUS: Final = "nobody"


async def forget_orders(session: AsyncSession, before: datetime, at_most: int) -> int:
    """Take the names out of orders that ended before, with whatever was told of them."""
    old = select(Order.id).where(
        col(Order.updated_at) < before, col(Order.state).in_(ENDED), col(Order.sender_id) != ANONYMOUS
    )
    ids = list((await session.exec(old.order_by(col(Order.updated_at)).limit(at_most))).all())
    if not ids:
        return 0
    await _make_anonymous(session)
    people = {"sender_id": ANONYMOUS, "recipient_id": ANONYMOUS, "placed_by_id": None, "description": None}
    await session.exec(update(Order).where(col(Order.id).in_(ids)).values(**people))
    for row in (OrderEvent, Handover):
        await session.exec(update(row).where(col(row.order_id).in_(ids)).values(person_id=None))
    await session.exec(update(RobotCommand).where(col(RobotCommand.order_id).in_(ids)).values(asked_by_id=None))
    await forget_delegates(session, col(Delegate.order_id).in_(ids), named_by_id=ANONYMOUS)
    await session.exec(delete(OrderLink).where(col(OrderLink.order_id).in_(ids)))
    await _forget_notices(session, col(Notification.order_id).in_(ids))
    return len(ids)


async def forget_alarm_notices(session: AsyncSession, before: datetime, at_most: int) -> int:
    """Delete what was told before of alarms: no order takes it along."""
    old = select(Notification.id).where(col(Notification.order_id).is_(None), col(Notification.at) < before)
    ids = list((await session.exec(old.limit(at_most))).all())
    if ids:
        await _forget_notices(session, col(Notification.id).in_(ids))
    return len(ids)


async def _forget_notices(session: AsyncSession, which: ColumnElement[bool]) -> None:
    """Their sendings first, which refer to them."""
    sent = col(OutgoingNotification.notice_id).in_(select(Notification.id).where(which))
    await session.exec(delete(OutgoingNotification).where(sent))
    await session.exec(delete(Notification).where(which))


async def forget_standing_orders(session: AsyncSession, before: datetime, at_most: int) -> int:
    """The same for standing orders that ended before."""
    ended = col(StandingOrder.ended_at) < before
    old = select(StandingOrder.id).where(ended, col(StandingOrder.sender_id) != ANONYMOUS)
    ids = list((await session.exec(old.limit(at_most))).all())
    if ids:
        await _make_anonymous(session)
        people = {"sender_id": ANONYMOUS, "recipient_id": ANONYMOUS, "placed_by_id": None, "description": None}
        await session.exec(update(StandingOrder).where(col(StandingOrder.id).in_(ids)).values(**people))
    return len(ids)


async def forget_people(session: AsyncSession, before: datetime, at_most: int) -> int:
    """Members who came before, of whom no order is left and who are signed in nowhere; perhaps they never were."""
    old = select(Person).where(
        col(Person.created_at) < before,
        col(Person.email).not_like(f"%@{ERASED_DOMAIN}"),
        ~_any(Order, col(Order.sender_id), col(Order.recipient_id), col(Order.placed_by_id)),
        ~_any(StandingOrder, col(StandingOrder.sender_id), col(StandingOrder.recipient_id)),
        ~_any(PersonSession, col(PersonSession.person_id)),
        ~_any(PersonToken, col(PersonToken.person_id)),
    )
    people = [one for one in (await session.exec(old.limit(at_most))).all() if one.roles == ["member"]]
    for person in people:
        await delete_rows(session, person)
        person.email, person.name, person.usual_post = f"{person.id}@{ERASED_DOMAIN}", ERASED_NAME, None
    return len(people)


def _any(row: Any, *columns: Any) -> Any:
    return exists().where(or_(*(column == col(Person.id) for column in columns))).select_from(row)


async def _make_anonymous(session: AsyncSession) -> None:
    if await session.get(Person, ANONYMOUS) is None:
        since = datetime(1970, 1, 1, tzinfo=UTC)
        row = Person(id=ANONYMOUS, email=f"{ANONYMOUS}@{ERASED_DOMAIN}", name=ERASED_NAME, roles=[], created_at=since)
        session.add(row)
        await session.flush()
