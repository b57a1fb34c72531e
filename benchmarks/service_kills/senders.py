"""People who order by HTTP, each order under a key, again and again until it is acknowledged."""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field
from random import Random
from typing import Any, Final

import httpx

from benchmarks.service_kills.mail_server import Mailbox, newest_code

AGAIN_AFTER_S: Final = 0.05
GIVES_UP_AFTER_S: Final = 10.0
IMPATIENT: Final = 0.2
"""So many orders are sent anew before their answer can have come: an answer that is lost, as on a bad network."""
POSTS: Final = ("post1", "post2", "post3", "post4")


@dataclass
class Sender:
    """Somebody with a browser. `acknowledged`: which order each key was answered with."""

    url: str
    email: str
    recipients: tuple[str, ...]
    random: Random
    pause_s: float
    acknowledged: dict[str, str] = field(default_factory=dict)
    tried: int = 0
    replayed: int = 0
    wrong: list[str] = field(default_factory=list)

    async def sign_in(self, http: httpx.AsyncClient, mailbox: Mailbox) -> None:
        """With the mailed code, as everybody."""
        await self._post(http, "/sign-in/codes", {"email": self.email})
        while (code := newest_code(mailbox, self.email)) is None:  # noqa: ASYNC110  # a mailbox rings no bell
            await asyncio.sleep(AGAIN_AFTER_S)
        (await self._post(http, "/sign-in", {"email": self.email, "code": code})).raise_for_status()

    async def order_until(self, http: httpx.AsyncClient, is_over: Callable[[], bool]) -> None:
        """One order after the other; the one that is under way at the end is still brought to its answer."""
        number = 0
        while not is_over():
            number += 1
            await self.order(http, f"{self.email}-{number}")
            await asyncio.sleep(self.random.uniform(0.5, 1.5) * self.pause_s)

    async def order(self, http: httpx.AsyncClient, key: str) -> None:
        from_post, to_post = self.random.sample(POSTS, 2)
        wish = {"from_post": from_post, "to_post": to_post, "recipient": self.random.choice(self.recipients)}
        answer = await self._post(http, "/orders", wish, key)
        if answer.status_code != 201:
            self.wrong.append(f"order {key} was answered {answer.status_code}: {answer.text[:200]}")
            return
        self.acknowledged[key] = str(answer.json()["id"])
        self.replayed += answer.headers.get("Idempotency-Replayed") == "true"

    async def _post(self, http: httpx.AsyncClient, path: str, body: dict[str, Any], key: str = "") -> httpx.Response:
        """Until there is an answer: no connection, a broken one, a 5xx or "still running" is none."""
        headers = {"Sec-Fetch-Site": "same-origin", **({"Idempotency-Key": key} if key else {})}
        while True:
            self.tried += 1
            is_impatient = key and self.random.random() < IMPATIENT
            patience_s = self.random.uniform(0.005, 0.05) if is_impatient else GIVES_UP_AFTER_S
            try:
                answer = await http.post(f"{self.url}/api/v1{path}", json=body, headers=headers, timeout=patience_s)
            except httpx.HTTPError:
                pass
            else:
                if answer.status_code < 500 and answer.status_code != 409:
                    return answer
            await asyncio.sleep(AGAIN_AFTER_S)
