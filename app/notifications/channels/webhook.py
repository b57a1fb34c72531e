"""Signed webhooks: a POST for each notice, to an address that a person or the operator gave.

Signed as Standard Webhooks has it: `webhook-id` is the key of the sending, the same on every try; the signature is an
HMAC-SHA256 over id, time and body, so that a receiver knows the sender, and an old delivery from a new one.
"""

import base64
import hmac
import json
from dataclasses import dataclass
from datetime import datetime, timedelta
from hashlib import sha256
from typing import ClassVar, Final

import httpx
from sqlmodel import col, delete

from app.core.database.database import Database
from app.core.server_key import ServerKey
from app.models import Webhook
from app.notifications.channels.interface import Delivery, NotSent
from app.notifications.channels.posting import Answer, post
from app.notifications.preferences import WEBHOOK
from app.notifications.routing import SERVICE
from protocol.clock import Clock

PREFIX: Final = "whsec_"
GONE: Final = 410


@dataclass(frozen=True)
class Address:
    """Where to, signed with what."""

    url: str
    secret: bytes
    client: httpx.AsyncClient


def secret_of(key: ServerKey, webhook_id: str) -> str:
    """Return the secret that the owner of a webhook is shown; nothing of it is stored."""
    return PREFIX + base64.b64encode(key.derive("webhook", webhook_id)).decode()


def secret_bytes(secret: str) -> bytes:
    """`whsec_` and base64, or any other text as it is."""
    if secret.startswith(PREFIX):
        return base64.b64decode(secret.removeprefix(PREFIX))
    return secret.encode()


def signature(secret: bytes, delivery_id: str, at: datetime, body: bytes) -> str:
    """Of one delivery at one time."""
    signed = f"{delivery_id}.{round(at.timestamp())}.".encode() + body
    return "v1," + base64.b64encode(hmac.new(secret, signed, sha256).digest()).decode()


def body_of(sending: Delivery) -> bytes:
    """Return the body of a delivery; never a hand-over code."""
    notice, person = sending.notice, sending.person
    told = {
        "type": f"notice.{notice.kind}",
        "timestamp": notice.at.isoformat(),
        "data": {
            "key": notice.key,
            "kind": str(notice.kind),
            "order_id": notice.order_id,
            "person": {"email": person.email, "name": person.name},
            "title": sending.title,
            "body": sending.body,
            "facts": notice.facts,
        },
    }
    return json.dumps(told, ensure_ascii=False).encode()


async def deliver(address: Address, key: str, body: bytes, now: datetime) -> Answer:
    """One try, signed. Raises NotSent if there was no answer."""
    headers = {
        "Content-Type": "application/json",
        "User-Agent": "Campus-Mail",
        "webhook-id": key,
        "webhook-timestamp": str(round(now.timestamp())),
        "webhook-signature": signature(address.secret, key, now, body),
    }
    return await post(address.client, address.url, body, headers)


@dataclass
class WebhookChannel:
    """`http_client` reaches the public network alone; `service` is the address that the operator set, if any."""

    database: Database
    http_client: httpx.AsyncClient
    key: ServerKey
    clock: Clock
    service: Address | None = None
    name: ClassVar[str] = WEBHOOK
    at_once: int = 20
    gives_up_after: timedelta = timedelta(days=1)

    async def send(self, sending: Delivery) -> None:
        address = await self._address(sending)
        answer = await deliver(address, sending.key, body_of(sending), self.clock.utc())
        if answer.status == GONE and sending.target != SERVICE:
            await self._forget(sending)
            raise NotSent("the receiver has ended its webhook", for_good=True)
        if not answer.is_good:  # the operator of the receiver may mend it
            raise NotSent(f"the receiver answered {answer.status}", again_after_s=answer.again_after_s)

    async def _address(self, sending: Delivery) -> Address:
        if sending.target == SERVICE:
            if self.service is None:
                raise NotSent("the service has no webhook any more", for_good=True)
            return self.service
        async with self.database.reading() as session:
            row = await session.get(Webhook, sending.target)
        if row is None or row.person_id != sending.person.id:
            raise NotSent("the webhook was removed", for_good=True)
        return Address(row.url, secret_bytes(secret_of(self.key, row.id)), self.http_client)

    async def _forget(self, sending: Delivery) -> None:
        async with self.database.transaction() as session:
            await session.exec(delete(Webhook).where(col(Webhook.id) == sending.target))
