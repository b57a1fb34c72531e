"""The hand-over codes of an order: one to load, one to receive. Nothing of them is stored: they derive from the key.

The robot is given the SHA-256 of each (a verifier), so that it checks a code with no network and discloses nothing if
it is stolen. Thin: QR form only; the six digits for the app are a later issue.
"""

import io
from collections.abc import Mapping
from hashlib import sha256
from typing import Final

import segno

from app.server_key import ServerKey
from app.tables import NoticeKind, Order, OrderState
from protocol.parts import Purpose
from protocol.to_robot import Verifier

PREFIX: Final = "CM1:"
SECRET_BYTES: Final = 16

TURNS: Final[Mapping[OrderState, Purpose]] = {
    OrderState.ASSIGNED: Purpose.LOAD,
    OrderState.TO_SENDER: Purpose.LOAD,
    OrderState.AT_SENDER: Purpose.LOAD,
    # Before the robot has arrived too: where they meet there may be no network to fetch a code by.
    OrderState.CARRYING: Purpose.RECEIVE,
    OrderState.AT_RECIPIENT: Purpose.RECEIVE,
}
PURPOSE_OF_NOTICE: Final = {NoticeKind.ROBOT_HERE: Purpose.LOAD, NoticeKind.ROBOT_HERE_FOR_YOU: Purpose.RECEIVE}


def code_text(key: ServerKey, order_id: str, purpose: Purpose) -> str:
    """What the QR code says: `CM1:` and 128 bits in hex."""
    return PREFIX + key.derive("hand-over", order_id, purpose)[:SECRET_BYTES].hex()


def verifiers(key: ServerKey, order: Order) -> tuple[Verifier, ...]:
    """What the robot needs to check both codes of an order offline."""
    return tuple(
        Verifier(
            order_id=order.id,
            purpose=purpose,
            sha256=sha256(code_text(key, order.id, purpose).encode("ascii")).hexdigest(),
            expires_at=order.codes_expire_at,
        )
        for purpose in (Purpose.LOAD, Purpose.RECEIVE)
    )


def turn_of(order: Order, person_id: str) -> Purpose | None:
    """Which code it is this person's turn to show, if any."""
    purpose = TURNS.get(order.state)
    if purpose is Purpose.LOAD and person_id == order.sender_id:
        return purpose
    if purpose is Purpose.RECEIVE and person_id == order.recipient_id:
        return purpose
    return None


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
