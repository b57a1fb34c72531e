"""Orders: always so many that wait, or as they come in the course of a day."""

import asyncio
from dataclasses import dataclass
from random import Random
from typing import Final, Protocol

from benchmarks.fleet_simulation.people import People

DAY_S: Final = 86400.0
BY_HOUR: Final = (0.0,) * 8 + (1.0, 3.0, 3.0, 1.0, 1.0, 1.0, 3.0, 3.0, 1.0) + (0.0,) * 7
"""How many come in an hour, beside each other: two rush hours in the morning, two in the afternoon."""
WORKING_DAYS: Final = 5


class Demand(Protocol):
    """Places orders until cancelled."""

    async def run(self, people: People, posts: list[str], rng: Random) -> None: ...


@dataclass(frozen=True)
class Saturated:
    """So many are always placed and not yet loaded."""

    waiting: int

    async def run(self, people: People, posts: list[str], rng: Random) -> None:
        changed = asyncio.Event()
        people.parts.orders.ledger.on_change.append(lambda _: changed.set())
        while True:
            changed.clear()
            for _ in range(self.waiting - await people.not_fetched()):
                await people.order(*rng.sample(posts, 2))
            await changed.wait()


@dataclass(frozen=True)
class RushHours:
    """So many a day, Monday to Friday."""

    orders_a_day: float

    async def run(self, people: People, posts: list[str], rng: Random) -> None:
        most_an_hour = self.orders_a_day * max(BY_HOUR) / sum(BY_HOUR)
        while True:
            await asyncio.sleep(rng.expovariate(most_an_hour / 3600.0))
            is_placed = rng.random() < self._share(people.now_s)
            start, end = rng.sample(posts, 2)
            if is_placed:
                await people.order(start, end)

    def _share(self, now_s: float) -> float:
        if now_s // DAY_S % 7 >= WORKING_DAYS:
            return 0.0
        return BY_HOUR[int(now_s % DAY_S // 3600)] / max(BY_HOUR)
