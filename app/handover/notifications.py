"""Notifications to delegates, by mail and their other channels: their code, and its end."""

from collections.abc import Mapping
from typing import Final

from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.errors import AddressNotAllowed
from app.accounts.sign_in.service import SignInService, find_person, may_be_sent_mail
from app.models import Delegate, NotificationKind, Order, Person
from app.notifications.service import tell, withdraw
from app.orders.ledger import Ledger
from app.orders.notifications import return_post_of, title_of
from app.orders.transitions import ENDED
from protocol.parts import Purpose

OVER: Final = NotificationKind.DELEGATION_OVER


async def notify_delegate(
    session: AsyncSession, ledger: Ledger, sign_in: SignInService, order: Order, row: Delegate, named_by: Person
) -> None:
    """Mail a delegate their code and a link to the order. Raises AddressNotAllowed."""
    email = row.email or ""
    if await find_person(session, email) is None and not may_be_sent_mail(email, ledger.settings):
        domains = ", ".join(ledger.settings.allowed_domains)
        raise AddressNotAllowed(f"No account here has the address {email}. New addresses are those of {domains}.")
    person = await sign_in.person(session, email, row.named_at)
    code = {"delegate_id": row.id, "purpose": row.purpose, "named_by": named_by.name}
    await _tell(session, ledger, order, row, person, NotificationKind.DELEGATED, code)


async def notify_revoked(session: AsyncSession, ledger: Ledger, order: Order, row: Delegate) -> None:
    """Withdraw the notice of a code if it has not gone out; else notify the delegate that the code is worthless."""
    person = await find_person(session, row.email) if row.email else None
    was_told = person is not None and await withdraw(session, person.id, _key(row, NotificationKind.DELEGATED))
    if person is not None and was_told and order.state not in ENDED:
        await _tell(session, ledger, order, row, person, OVER, {})


async def _tell(
    session: AsyncSession,
    ledger: Ledger,
    order: Order,
    row: Delegate,
    person: Person,
    kind: NotificationKind,
    more: Mapping[str, str],
) -> None:
    facts = {
        "sender": (await session.get_one(Person, order.sender_id)).name,
        "recipient": (await session.get_one(Person, order.recipient_id)).name,
        "post": title_of(post_of(order, Purpose(row.purpose)), ledger.campus),
    }
    await tell(
        session,
        person=person,
        key=_key(row, kind),
        order_id=order.id,
        kind=kind,
        facts={**facts, **more},
        now=ledger.clock.utc(),
    )


def _key(row: Delegate, kind: NotificationKind) -> str:
    return f"{row.order_id}.{kind}.{row.id}"


def post_of(order: Order, purpose: Purpose) -> str:
    """Where they meet the robot."""
    if purpose is Purpose.RETURN:
        return return_post_of(order)
    return order.from_post if purpose is Purpose.LOAD else order.to_post
