"""A delivery for trial, at a tap: the owner of a webhook knows at once if their program hears, or why not."""

import json
from datetime import datetime

from app.core.http_client import HttpClient
from app.core.server_key import ServerKey
from app.models import Person, Webhook
from app.notifications.channels.interface import NotSent
from app.notifications.channels.webhook import Address, deliver, secret_bytes, secret_of
from app.notifications.preference_api.schemas import TrialView
from protocol.ids import new_id


async def try_webhook(
    http_client: HttpClient, key: ServerKey, row: Webhook, person: Person, now: datetime
) -> TrialView:
    """Sent as a notice would be, but once. No transaction may be open: the receiver takes its time."""
    told = {
        "type": "trial",
        "timestamp": now.isoformat(),
        "data": {"person": {"email": person.email, "name": person.name}},
    }
    async with http_client.client() as client:
        address = Address(row.url, secret_bytes(secret_of(key, row.id)), client)
        try:
            answer = await deliver(address, f"trial-{new_id()}", json.dumps(told, ensure_ascii=False).encode(), now)
        except NotSent as problem:
            return TrialView(is_good=False, status=None, problem=str(problem))
    return TrialView(is_good=answer.is_good, status=answer.status, problem=None)
