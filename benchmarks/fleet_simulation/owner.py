"""One robot from outside: its computer's lives one after another, and what befalls it."""

import asyncio
from collections import Counter
from dataclasses import dataclass, field
from random import Random
from typing import Final

from benchmarks.fleet_simulation.body import Body
from benchmarks.fleet_simulation.judge import BAY, CORRIDOR, CROSSING, bay
from benchmarks.fleet_simulation.network import Network
from benchmarks.fleet_simulation.people import People
from benchmarks.fleet_simulation.robot import MakeMind, Mind

LOOKS_S: Final = 10.0


@dataclass
class Owned:
    """`befallen`: how often what has befallen it. `is_dead`: until a person has found it."""

    name: str
    body: Body
    network: Network
    people: People
    make: MakeMind
    befallen: Counter[str]
    mind: Mind | None = None
    is_dead: bool = False
    failure: BaseException | None = None
    _life: asyncio.Task[None] | None = None
    _busy: asyncio.Lock = field(default_factory=asyncio.Lock)

    def switch_on(self) -> None:
        self.mind = self.make()
        self._life = asyncio.create_task(self.mind.run(), name=self.name)
        self._life.add_done_callback(self._ended)

    def _ended(self, life: "asyncio.Task[None]") -> None:
        if not life.cancelled() and life.exception() is not None:
            self.failure = life.exception()

    async def switch_off(self) -> None:
        life, self._life, self.mind = self._life, None, None
        if life is not None:
            life.cancel()
            await asyncio.gather(life, return_exceptions=True)

    @property
    def has_told_all(self) -> bool:
        """Nothing of what it has to say is still on its way."""
        mind = self.mind
        return mind is not None and mind.link.online and mind.missions.outbox.waiting() == 0

    # What befalls it, one thing at a time.

    async def restarts(self) -> None:
        """Killed at any moment, and started again: what it had in memory alone is gone."""
        async with self._busy:
            self.befallen["killed"] += 1
            self.body.judge.is_off(self.name)
            await self.switch_off()
            await self.body.takes(self.body.taking.table.boot)
            self.switch_on()

    async def is_cut_off(self, for_s: float) -> None:
        async with self._busy:
            self.befallen["cut off"] += 1
            await self.network.be_away(for_s)

    async def loses_messages(self) -> None:
        """Its connection breaks: what was on its way never comes, and is said again over the next one."""
        async with self._busy:
            self.befallen["messages lost"] += 1
            self.network.hang_up()

    async def is_carried(self, for_s: float, rng: Random) -> None:
        """A person lifts it, and puts it down in a bay somewhere else."""
        async with self._busy:
            if self.body.docked:
                return
            self.befallen["carried"] += 1
            await self.switch_off()  # its wheels drop: nothing that it was about goes on
            self.body.is_taken()
            self.switch_on()
            await asyncio.sleep(for_s)
            self.body.is_put(rng.choice(self._empty_bays()))
            if self.mind is not None:
                self.mind.was_moved()

    async def dies(self) -> None:
        """Where it is, until a person has found it, carried it home, and told the service so."""
        async with self._busy:
            self.befallen[f"died in a {self._kind_of_place()}"] += 1
            self.is_dead = True
            self.body.judge.is_off(self.name)
            home = self.mind.home if self.mind else self.body.post
            await self.switch_off()
            await self.body.takes(self.body.taking.table.looked_for)
            self.body.is_taken()
            await self.people.take_out(self.name)
            await self._comes_home(home)
            self.is_dead = False

    def _kind_of_place(self) -> str:
        """The most that it blocks: on its way from one to the next it is in both."""
        kinds = {place.partition(" ")[0] for place in self.body.judge.places_of(self.name)}
        return next(kind for kind in (CROSSING, CORRIDOR, BAY) if kind in kinds)

    def _empty_bays(self) -> list[str]:
        track, is_free = self.body.track, self.body.judge.is_free
        passing = [place.name for place in track.posts.values() if place.bay_of and not (place.homes or place.dock)]
        return [name for name in passing if is_free(bay(name))]

    async def _comes_home(self, home: str) -> None:
        """The person puts it into its dock, switches it on, and lets it go when it has heard what it has to."""
        self.body.is_put(home)
        self.switch_on()
        await self.body.takes(self.body.taking.table.boot)
        while self.mind is not None and not self.mind.missions.held.revoked:  # noqa: ASYNC110  # as a person does
            await asyncio.sleep(LOOKS_S)
        if self.mind is not None:
            self.mind.is_let_go()
