"""People who order by HTTP, each order under a key, again and again until it is acknowledged."""

import asyncio
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final

from benchmarks.service_kills.people import Person

POSTS: Final = ("post1", "post2", "post3", "post4")


@dataclass
class Sender(Person):
    """A person who sends letters. `acknowledged`: which order each key was answered with."""

    recipients: Sequence[str] = ()
    pause_s: float = 0.0
    acknowledged: dict[str, str] = field(default_factory=dict)
    replayed: int = 0

    async def order_until(self, is_over: Callable[[], bool]) -> None:
        """One order after the other; the one that is under way at the end is still brought to its answer."""
        number = 0
        while not is_over():
            number += 1
            await self.order(f"{self.email}-{number}")
            await asyncio.sleep(self.random.uniform(0.5, 1.5) * self.pause_s)

    async def order(self, key: str) -> None:
        from_post, to_post = self.random.sample(POSTS, 2)
        wish = {"from_post": from_post, "to_post": to_post, "recipient": self.random.choice(self.recipients)}
        answer = await self.post("/orders", wish, key)
        if answer.status_code != 201:
            self.wrong.append(f"order {key} was answered {answer.status_code}: {answer.text[:200]}")
            return
        self.acknowledged[key] = str(answer.json()["id"])
        self.replayed += answer.headers.get("Idempotency-Replayed") == "true"
