"""People with a browser who have signed in: they ask until there is an answer, and show the codes of their orders."""

import asyncio
from collections.abc import Sequence
from dataclasses import dataclass, field
from random import Random
from typing import Any, Final

import httpx

from benchmarks.service_kills.mail_server import Mailbox, newest_code
from protocol.parts import Purpose

AGAIN_AFTER_S: Final = 0.05
GIVES_UP_AFTER_S: Final = 10.0
IMPATIENT: Final = 0.2
"""So many orders are sent anew before their answer can have come: an answer that is lost, as on a bad network."""


@dataclass
class Person:
    """`http` is their browser."""

    url: str
    email: str
    random: Random
    http: httpx.AsyncClient
    tried: int = 0
    wrong: list[str] = field(default_factory=list)

    async def sign_in(self, mailbox: Mailbox) -> None:
        """With the mailed code, as everybody."""
        await self.post("/sign-in/codes", {"email": self.email})
        while (code := newest_code(mailbox, self.email)) is None:  # noqa: ASYNC110  # a mailbox rings no bell
            await asyncio.sleep(AGAIN_AFTER_S)
        (await self.post("/sign-in", {"email": self.email, "code": code})).raise_for_status()

    async def post(self, path: str, body: dict[str, Any], key: str = "") -> httpx.Response:
        """Until there is an answer: no connection, a broken one, a 5xx or "still running" is none."""
        headers = {"Sec-Fetch-Site": "same-origin", **({"Idempotency-Key": key} if key else {})}
        while True:
            self.tried += 1
            is_impatient = key and self.random.random() < IMPATIENT
            patience_s = self.random.uniform(0.005, 0.05) if is_impatient else GIVES_UP_AFTER_S
            try:
                answer = await self.http.post(
                    f"{self.url}/api/v1{path}", json=body, headers=headers, timeout=patience_s
                )
            except httpx.HTTPError:
                pass
            else:
                if answer.status_code < 500 and answer.status_code != 409:
                    return answer
            await asyncio.sleep(AGAIN_AFTER_S)

    async def code(self, order_id: str, purpose: Purpose) -> str | None:
        """The QR code on their page; None if it is not theirs to show, not yet, or there is no answer."""
        self.tried += 1
        try:
            answer = await self.http.get(f"{self.url}/api/v1/orders/{order_id}/code", timeout=GIVES_UP_AFTER_S)
        except httpx.HTTPError:
            return None
        shown = answer.json() if answer.is_success else {}
        return shown["text"] if shown.get("purpose") == purpose else None


@dataclass(frozen=True)
class Everybody:
    """People who may stand at a robot."""

    senders: Sequence[Person]
    recipients: Sequence[Person]

    async def show(self, order_id: str, purpose: Purpose) -> str | None:
        """Return the code of the person whose turn it is."""
        who = self.recipients if purpose is Purpose.RECEIVE else self.senders
        codes = await asyncio.gather(*(one.code(order_id, purpose) for one in who))
        return next((code for code in codes if code), None)
