"""Links in mails, for recipients without account and for delegates: one opens one order, for the person it was mailed
to.

The token stands in the URL's fragment, which no browser sends and no proxy sees; the page sends it in a body. It
derives from the server key and the row's nonce, so that a mail that is written again holds the same link.
"""

import base64
import secrets
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Final

from sqlalchemy import String, and_, bindparam, case, exists, false, not_, or_
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.errors import LinkRefused
from app.accounts.sessions.sessions import hash_of
from app.core.database.database import Database
from app.core.server_key import ServerKey
from app.core.settings import Settings
from app.models import Delegate, Identity, Order, OrderLink, Person, PersonSession
from protocol.clock import Clock

PAGE: Final = "one-order.html"
LINK_LIFETIME_S: Final = 14 * 86400.0
"""Links to one order, in mails to people without an account."""


@dataclass(frozen=True)
class Guest:
    """A person who came by a link: themselves without any role, for one order. `is_delegate`: not its recipient."""

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
        asked = {"order_id": order_id, "person_id": person.id, "email": person.email}
        async with self.database.asking() as connection:
            found = (await connection.execute(_IN_NEED_OF_A_LINK, asked)).first()
        if found is None:
            return None
        not_before, nonce, expires_at = found
        now = self.clock.utc()
        if nonce is None or expires_at <= now:
            # Like the codes: a delegate of an order that was left for later comes then.
            ends_at = max(now, not_before or now) + timedelta(seconds=LINK_LIFETIME_S)
            nonce = await self._make_good(person, order_id, ends_at)
        return f"{self.settings.public_url.rstrip('/')}/{PAGE}#{self._token(nonce, order_id, person.id)}"

    async def _make_good(self, person: Person, order_id: str, until: datetime) -> str:
        """The nonce of the link, which is a new one if there was none."""
        theirs = select(OrderLink).where(OrderLink.order_id == order_id, OrderLink.person_id == person.id)
        async with self.database.transaction() as session:
            row = (await session.exec(theirs)).first() or self._new(person, order_id, until)
            row.expires_at = until
            session.add(row)
            return row.nonce

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
        """Return the guest of this link and their order. Raises LinkRefused."""
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
            raise LinkRefused("The person who named you for this order has taken that back.")
        # A copy: a dispatcher too is only the recipient here, or a delegate.
        return Guest(Person(**{**person.model_dump(), "roles": []}), order.id, is_delegate)


def _is_good(row: OrderLink, now: datetime) -> bool:
    return row.revoked_at is None and row.expires_at > now


async def _is_named(session: AsyncSession, person: Person, order_id: str) -> bool:
    named = select(Delegate.id).where(
        Delegate.order_id == order_id, Delegate.email == person.email, col(Delegate.revoked_at).is_(None)
    )
    return (await session.exec(named.limit(1))).first() is not None


_ORDER: Final = bindparam("order_id", type_=String)
_PERSON: Final = bindparam("person_id", type_=String)
_NAMED: Final = exists().where(
    col(Delegate.order_id) == _ORDER,
    col(Delegate.email) == bindparam("email", type_=String),
    col(Delegate.revoked_at).is_(None),
)
_KNOWN: Final = or_(
    exists().where(col(PersonSession.person_id) == _PERSON), exists().where(col(Identity.person_id) == _PERSON)
)
_IN_NEED_OF_A_LINK: Final = (
    select(Order.not_before, OrderLink.nonce, OrderLink.expires_at)
    .outerjoin(OrderLink, and_(col(OrderLink.order_id) == Order.id, col(OrderLink.person_id) == _PERSON))
    .where(
        col(Order.id) == _ORDER,
        # The pages for those who sign in show a delegate nothing of the order.
        case(
            (col(Order.recipient_id) == _PERSON, not_(_KNOWN)), (col(Order.sender_id) == _PERSON, false()), else_=_NAMED
        ),
    )
)
"""Nothing for a person who signs in, nor for one whom the order does not concern."""
