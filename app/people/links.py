"""Links in mails, for recipients without account and for delegates: one opens one order, for whoever it was mailed to.

The token stands in the URL's fragment, which no browser sends and no proxy sees; the page sends it in a body. It
derives from the server key and the row's nonce, so that a mail that is written again holds the same link.
"""

import base64
import secrets
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Final

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.database import Database
from app.people.errors import LinkRefused
from app.people.sessions import hash_of
from app.server_key import ServerKey
from app.settings import Settings
from app.tables import Delegate, Identity, Order, OrderLink, Person, PersonSession
from protocol.clock import Clock

PAGE: Final = "one-order.html"


@dataclass(frozen=True)
class Guest:
    """Somebody who came by a link: themselves without any role, for one order. `is_delegate`: not its recipient."""

    person: Person
    order_id: str
    is_delegate: bool = False


@dataclass(frozen=True)
class Links:
    """Writes links and opens orders by them."""

    database: Database
    key: ServerKey
    settings: Settings
    clock: Clock

    async def url_for(self, person: Person, order_id: str) -> str | None:
        """For an order's recipient who has never signed in, and for its delegates; None for everybody else.

        One link for all mails about an order: the first that comes when it is too old makes it good again.
        """
        if not self.settings.public_url:
            return None
        now = self.clock.utc()
        async with self.database.reading() as session:
            order = await session.get(Order, order_id)
            if order is None or not await _needs_link(session, person, order):
                return None
            row = await _link(session, person, order_id)
        if row is None or row.expires_at <= now:
            # Like the codes: whoever is named for an order that was left for later comes then.
            ends_at = max(now, order.not_before or now) + timedelta(seconds=self.settings.link_lifetime_s)
            async with self.database.transaction() as session:
                row = await _link(session, person, order_id) or self._new(person, order_id, ends_at)
                row.expires_at = ends_at
                session.add(row)
        return f"{self.settings.public_url.rstrip('/')}/{PAGE}#{self._token(row.nonce, order_id, person.id)}"

    def _new(self, person: Person, order_id: str, expires_at: datetime) -> OrderLink:
        nonce = secrets.token_hex(16)
        return OrderLink(
            nonce=nonce,
            order_id=order_id,
            person_id=person.id,
            token_hash=hash_of(self._token(nonce, order_id, person.id)),
            created_at=self.clock.utc(),
            expires_at=expires_at,
        )

    def _token(self, nonce: str, order_id: str, person_id: str) -> str:
        secret = self.key.derive("order-link", nonce, order_id, person_id)
        return base64.urlsafe_b64encode(secret).decode().rstrip("=")

    async def open(self, session: AsyncSession, token: str) -> Guest:
        """Who comes by this link, and for which order. Raises LinkRefused."""
        wanted = select(OrderLink, Person).where(
            OrderLink.token_hash == hash_of(token), OrderLink.person_id == Person.id
        )
        found = (await session.exec(wanted)).first()
        if found is None or not _is_good(found[0], self.clock.utc()):
            raise LinkRefused("This link is unknown or too old. The newest mail about your order has a good one.")
        row, person = found
        order = await session.get_one(Order, row.order_id)
        is_delegate = order.recipient_id != person.id
        if is_delegate and not await _is_named(session, person, order.id):
            raise LinkRefused("Whoever named you for this order has taken that back.")
        # A copy: whoever is a dispatcher too is only the recipient here, or a delegate.
        return Guest(Person(**{**person.model_dump(), "roles": []}), order.id, is_delegate)


def _is_good(row: OrderLink, now: datetime) -> bool:
    return row.revoked_at is None and row.expires_at > now


async def _link(session: AsyncSession, person: Person, order_id: str) -> OrderLink | None:
    theirs = select(OrderLink).where(OrderLink.order_id == order_id, OrderLink.person_id == person.id)
    return (await session.exec(theirs)).first()


async def _needs_link(session: AsyncSession, person: Person, order: Order) -> bool:
    if order.recipient_id != person.id:
        # The pages for those who sign in show a delegate nothing of the order.
        return order.sender_id != person.id and await _is_named(session, person, order.id)
    signed_in = select(PersonSession.id).where(PersonSession.person_id == person.id).limit(1)
    known_outside = select(col(Identity.person_id)).where(Identity.person_id == person.id).limit(1)
    return not (await session.exec(signed_in)).first() and not (await session.exec(known_outside)).first()


async def _is_named(session: AsyncSession, person: Person, order_id: str) -> bool:
    named = select(Delegate.id).where(
        Delegate.order_id == order_id, Delegate.email == person.email, col(Delegate.revoked_at).is_(None)
    )
    return (await session.exec(named.limit(1))).first() is not None
