"""Web Push (RFC 8030, 8291): encrypted for one browser, so that the push service in between reads nothing."""

import base64
import json
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import timedelta
from hashlib import sha256
from typing import ClassVar, Final

import http_ece
import httpx
from cryptography.hazmat.primitives.asymmetric import ec
from sqlmodel import col, delete

from app.core.database.database import Database
from app.models import NotificationKind, PushSubscription
from app.notifications.channels.interface import Delivery, NotSent
from app.notifications.channels.posting import GONE, post
from app.notifications.preferences import PUSH
from app.notifications.push_key import PushKey
from protocol.clock import Clock

WAITING_ROBOT: Final = frozenset(
    {NotificationKind.ROBOT_HERE, NotificationKind.ROBOT_HERE_FOR_YOU, NotificationKind.AT_RETURN}
)
SOON: Final = frozenset(
    {NotificationKind.ROBOT_NEAR, NotificationKind.ATTENTION, NotificationKind.ALARM, NotificationKind.DELAYED}
)
TTL_S: Final[Mapping[str, int]] = {"high": 1800, "normal": 7200, "low": 86400}
"""After that it is told too late to be of use to anybody whose device was off."""


def urgency_of(kind: NotificationKind) -> str:
    """Return how much of a device's battery it is worth (RFC 8030, 5.3)."""
    if kind in WAITING_ROBOT:
        return "high"
    return "normal" if kind in SOON else "low"


def topic_of(sending: Delivery) -> str:
    """A second try takes the place of the first, if that still waits at the push service."""
    return base64.urlsafe_b64encode(sha256(sending.key.encode()).digest()[:24]).decode()


def payload_of(sending: Delivery) -> bytes:
    """Return what the page's worker shows; with the same `tag`, the browser shows it once. Never a hand-over code."""
    notice = sending.notice
    shown = {
        "tag": notice.key,
        "kind": str(notice.kind),
        "order_id": notice.order_id,
        "title": sending.title[:200],
        "body": sending.body[:1000],
        "at": notice.at.isoformat(),
        "language": sending.person.language,
    }
    return json.dumps(shown, ensure_ascii=False).encode()


def encrypted(payload: bytes, subscription: PushSubscription) -> bytes:
    """For that browser alone, with a key of its own for each message."""
    return bytes(
        http_ece.encrypt(
            payload,
            private_key=ec.generate_private_key(ec.SECP256R1()),
            dh=from_base64(subscription.p256dh),
            auth_secret=from_base64(subscription.auth),
            version="aes128gcm",
        )
    )


def from_base64(text: str) -> bytes:
    """URL-safe, with or without padding. Raises ValueError."""
    return base64.urlsafe_b64decode(text.rstrip("=") + "=" * (-len(text.rstrip("=")) % 4))


@dataclass
class PushChannel:
    """`client` reaches the public network alone (`app.core.http_client`)."""

    database: Database
    client: httpx.AsyncClient
    key: PushKey
    contact: str
    clock: Clock
    name: ClassVar[str] = PUSH
    at_once: int = 20
    gives_up_after: timedelta = timedelta(hours=2)

    async def send(self, sending: Delivery) -> None:
        subscription = await self._subscription(sending)
        try:
            content = encrypted(payload_of(sending), subscription)
        except ValueError as error:
            raise NotSent(f"the keys of the device cannot be used: {error}", for_good=True) from error
        answer = await post(self.client, subscription.endpoint, content, self._headers(sending, subscription.endpoint))
        if answer.status in GONE:
            await self._forget(subscription)
            raise NotSent("the device has ended its subscription", for_good=True)
        if not answer.is_good:
            raise NotSent(
                f"the push service answered {answer.status}",
                for_good=not answer.is_for_later,
                again_after_s=answer.again_after_s,
            )

    def _headers(self, sending: Delivery, endpoint: str) -> dict[str, str]:
        url = httpx.URL(endpoint)
        urgency = urgency_of(sending.notice.kind)
        return {
            "Authorization": self.key.authorization(
                f"{url.scheme}://{url.netloc.decode()}", self.contact, self.clock.utc()
            ),
            "Content-Encoding": "aes128gcm",
            "Content-Type": "application/octet-stream",
            "TTL": str(TTL_S[urgency]),
            "Urgency": urgency,
            "Topic": topic_of(sending),
        }

    async def _subscription(self, sending: Delivery) -> PushSubscription:
        async with self.database.reading() as session:
            found = await session.get(PushSubscription, sending.target)
        if found is None or found.person_id != sending.person.id:
            raise NotSent("the device was removed", for_good=True)
        return found

    async def _forget(self, subscription: PushSubscription) -> None:
        async with self.database.transaction() as session:
            await session.exec(delete(PushSubscription).where(col(PushSubscription.id) == subscription.id))
