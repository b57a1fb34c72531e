"""The hand-over codes of an order: to load, to receive, to take back. They derive from the key, stored nowhere.

Each has a QR form and six digits. The robot is given the SHA-256 of the QR form (a verifier), so that it checks a code
with no network and discloses nothing if it is stolen; digits are checked by the service alone.
"""

import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from enum import StrEnum
from hashlib import sha256
from typing import Final

import segno
from sqlalchemy import bindparam
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import columns_of, connection_of
from app.core.server_key import ServerKey
from app.models import Delegate, Notification, NotificationKind, Order, OrderState
from protocol.parts import Purpose
from protocol.to_robot import Verifier

PREFIX: Final = "CM1:"
SECRET_BYTES: Final = 16
DIGITS: Final = 6

TURNS: Final[Mapping[OrderState, Purpose]] = {
    OrderState.ASSIGNED: Purpose.LOAD,
    OrderState.TO_SENDER: Purpose.LOAD,
    OrderState.AT_SENDER: Purpose.LOAD,
    # Before the robot has arrived too: where they meet there may be no network to fetch a code by.
    OrderState.CARRYING: Purpose.RECEIVE,
    OrderState.AT_RECIPIENT: Purpose.RECEIVE,
    OrderState.RETURNING: Purpose.RETURN,
    OrderState.AT_RETURN: Purpose.RETURN,
}
PURPOSE_OF_NOTICE: Final = {
    NotificationKind.ROBOT_HERE: Purpose.LOAD,
    NotificationKind.ROBOT_HERE_FOR_YOU: Purpose.RECEIVE,
    NotificationKind.AT_RETURN: Purpose.RETURN,
}
CONFIRM_LIFETIME_S: Final = 60.0
"""A tap or digits at a hand-over are good for so long on their way to the robot."""


class Holder(StrEnum):
    """Holders of codes. Any dispatcher shows the mailroom's: to take mail back, and to load what it passes on."""

    SENDER = "sender"
    RECIPIENT = "recipient"
    MAILROOM = "mailroom"
    DELEGATE = "delegate"


OWN_CODES: Final = (
    (Purpose.LOAD, Holder.SENDER),
    (Purpose.RECEIVE, Holder.RECIPIENT),
    (Purpose.RETURN, Holder.SENDER),
    (Purpose.RETURN, Holder.MAILROOM),
)
"""The codes that every order has; delegates get more, and what is passed on has one more."""
PASSED_ON: Final = (Purpose.LOAD, Holder.MAILROOM)


@dataclass(frozen=True)
class HandoverCode:
    """One code of an order: what it is good for, whose it is, and until when."""

    order_id: str
    purpose: Purpose
    holder: Holder
    expires_at: datetime
    delegate: Delegate | None = None

    def text(self, key: ServerKey) -> str:
        """Return the text of the QR code."""
        return code_text(key, self.order_id, self.purpose, self._whose)

    def sha256(self, key: ServerKey) -> str:
        """Return the hash by which the robot knows the code."""
        return sha256(self.text(key).encode("ascii")).hexdigest()

    def digits(self, key: ServerKey) -> str:
        """The same in six digits, for the app."""
        secret = key.derive("hand-over digits", self.order_id, self.purpose, *self._whose)
        return f"{int.from_bytes(secret[:8]) % 10**DIGITS:0{DIGITS}d}"

    @property
    def _whose(self) -> tuple[str, ...]:
        if self.delegate is not None:
            return (Holder.DELEGATE, self.delegate.id)
        return (Holder.MAILROOM,) if self.holder is Holder.MAILROOM else ()


def code_text(key: ServerKey, order_id: str, purpose: Purpose, whose: tuple[str, ...] = ()) -> str:
    """Return the QR code's text: `CM1:` and 128 bits in hex. `whose`: a delegate or the mailroom; else sender and
    recipient."""
    return PREFIX + key.derive("hand-over", order_id, purpose, *whose)[:SECRET_BYTES].hex()


def code_in_mail(key: ServerKey, notice: Notification) -> tuple[Purpose, str] | None:
    """The code that goes with a notice by mail: what it is for, and what its QR form says."""
    if notice.order_id is None:
        return None
    if notice.kind is NotificationKind.DELEGATED:
        purpose, whose = Purpose(notice.facts["purpose"]), (Holder.DELEGATE, notice.facts["delegate_id"])
        return purpose, code_text(key, notice.order_id, purpose, whose)
    own = PURPOSE_OF_NOTICE.get(notice.kind)
    return None if own is None else (own, code_text(key, notice.order_id, own))


def codes_of(
    order: Order, delegates: Iterable[Delegate] = (), *, with_revoked: bool = False
) -> tuple[HandoverCode, ...]:
    """Every code of an order that is good for something; `with_revoked`: or was once."""
    pairs = (*OWN_CODES, PASSED_ON) if order.is_passed_on else OWN_CODES
    own = (HandoverCode(order.id, purpose, holder, order.codes_expire_at) for purpose, holder in pairs)
    more = (
        HandoverCode(order.id, Purpose(one.purpose), Holder.DELEGATE, order.codes_expire_at, one)
        for one in delegates
        if one.order_id == order.id and (with_revoked or one.revoked_at is None)
    )
    return (*own, *more)


async def delegates_of(session: AsyncSession, orders: Sequence[Order]) -> Sequence[Delegate]:
    """Return the delegates of some orders, revoked ones too."""
    return (await session.exec(_DELEGATES, params={"order_ids": [order.id for order in orders]})).all()


_DELEGATES: Final = (
    select(Delegate)
    .where(col(Delegate.order_id).in_(bindparam("order_ids", expanding=True)))
    .order_by(col(Delegate.named_at), col(Delegate.id))
)
_DELEGATES_COLUMNS: Final = _DELEGATES.with_only_columns(*columns_of(Delegate))


async def verifiers(session: AsyncSession, key: ServerKey, orders: Sequence[Order]) -> tuple[Verifier, ...]:
    """Return what a robot needs to check every code of some orders offline."""
    connection = await connection_of(session)
    named = await connection.execute(_DELEGATES_COLUMNS, {"order_ids": [order.id for order in orders]})
    delegates = [Delegate(**row) for row in named.mappings()]
    return tuple(
        Verifier(order_id=code.order_id, purpose=code.purpose, sha256=code.sha256(key), expires_at=code.expires_at)
        for order in orders
        for code in codes_of(order, delegates)
    )


def turn_of(order: Order, person_id: str) -> Purpose | None:
    """Return which code it is this person's turn to show, if any."""
    purpose = TURNS.get(order.state)
    if purpose is Purpose.LOAD and order.is_passed_on:
        return None  # the mailroom has it
    if purpose is Purpose.RECEIVE:
        return purpose if person_id == order.recipient_id else None
    # The dispatcher who placed an order for a walk-up sender loads it for them, too.
    loads_for_them = purpose is Purpose.LOAD and person_id == order.placed_by_id
    return purpose if person_id == order.sender_id or loads_for_them else None


def mailrooms_turn(order: Order) -> Purpose | None:
    """Return LOAD if any dispatcher may load it: it was passed on, so that the mailroom has it."""
    is_theirs = order.is_passed_on and TURNS.get(order.state) is Purpose.LOAD
    return Purpose.LOAD if is_theirs else None


def code_svg(text: str) -> bytes:
    """The QR code for a screen; light quiet zone included, so that it is read from a dark page too."""
    picture = io.BytesIO()
    segno.make_qr(text, error="m").save(picture, kind="svg", border=4, omitsize=True, light="#fff", svgclass=None)
    return picture.getvalue()


def code_png(text: str) -> bytes:
    """The QR code for a mail."""
    picture = io.BytesIO()
    segno.make_qr(text, error="m").save(picture, kind="png", border=4, scale=8)
    return picture.getvalue()
