"""What goes wrong, at random moments, and how often."""

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass
from random import Random
from typing import Final

from benchmarks.fleet_simulation.owner import Owned
from benchmarks.fleet_simulation.people import People
from maps import CampusMap

HOUR_S: Final = 3600.0
AWAY_S: Final = (1.0, 300.0)
CARRIED_S: Final = (20.0, 120.0)
CLOSED_S: Final = (600.0, 3600.0)


@dataclass(frozen=True, slots=True)
class Faults:
    """One in so many hours of each robot; corridors closed: of the whole campus. 0: never."""

    killed_h: float = 0.0
    cut_off_h: float = 0.0
    messages_lost_h: float = 0.0
    carried_h: float = 0.0
    died_h: float = 0.0
    closed_h: float = 0.0


NONE: Final = Faults()
MANY: Final = Faults(killed_h=8.0, cut_off_h=4.0, messages_lost_h=4.0, carried_h=24.0, died_h=24.0, closed_h=12.0)


@dataclass
class Trouble:
    """Brings all of it about. Of the same seed the same befalls the same robots at the same moments."""

    faults: Faults
    campus: CampusMap
    owned: Sequence[Owned]
    people: People
    seed: int

    def tasks(self) -> list[asyncio.Task[None]]:
        works = [
            self._now_and_then(every_h, f"{one.name} {kind}", befalls)
            for one in self.owned
            for kind, every_h, befalls in self._kinds(one)
            if every_h > 0
        ]
        if self.faults.closed_h > 0:
            works.append(self._now_and_then(self.faults.closed_h, "closed", self._close))
        return [asyncio.create_task(work) for work in works]

    def _kinds(self, one: Owned) -> Sequence[tuple[str, float, Callable[[Random], Awaitable[None]]]]:
        faults = self.faults
        return (
            ("killed", faults.killed_h, lambda _: one.restarts()),
            ("cut off", faults.cut_off_h, lambda rng: one.is_cut_off(rng.uniform(*AWAY_S))),
            ("lost", faults.messages_lost_h, lambda _: one.loses_messages()),
            ("carried", faults.carried_h, lambda rng: one.is_carried(rng.uniform(*CARRIED_S), rng)),
            ("died", faults.died_h, lambda _: one.dies()),
        )

    async def _now_and_then(self, every_h: float, name: str, befalls: Callable[[Random], Awaitable[None]]) -> None:
        rng = Random(f"{self.seed} {name}")
        while True:
            await asyncio.sleep(rng.expovariate(1 / (every_h * HOUR_S)))
            await befalls(rng)

    async def _close(self, rng: Random) -> None:
        corridor = rng.choice(self.campus.corridors).name
        await self.people.close(corridor)
        await asyncio.sleep(rng.uniform(*CLOSED_S))
        await self.people.open_again(corridor)
