"""What befalls whole robots: computers stop, networks are cut, people carry them away, and corridors are closed."""

import asyncio
import math
from collections import Counter
from collections.abc import Awaitable, Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from random import Random
from typing import Final

from benchmarks.fleet_simulation.people import People
from benchmarks.stepped_fleet.robots import SteppedRobot
from maps import CampusMap
from robot.simulated.start import start_pose

LOOK_S: Final = 0.02
OFF_S: Final = 30.0
CUT_S: Final = (5.0, 120.0)
CARRIED_S: Final = (5.0, 30.0)
FOUND_AFTER_S: Final = (300.0, 900.0)
CLOSED_S: Final = (300.0, 900.0)
DIES_AFTER_S: Final = (0.1, 1.2)
"""So long after the beginning of a turn, which takes about a second for a quarter."""
NEAR_M: Final = 1.2

Befalls = Callable[[SteppedRobot, Random], Awaitable[None]]


@dataclass(frozen=True)
class Rates:
    """How often, in seconds on an average, 0: never. Of each robot: its daemon is killed, and off for half a minute
    (`kill_s`); its network is cut (`cut_s`); it is carried into another bay (`lift_s`); its computer stops until a
    person finds it and carries it home (`die_s`). Of the campus: a corridor is closed (`close_s`). `turns_killed`: the
    share of the turns on a crossing in whose middle the daemon is killed."""

    kill_s: float = 0.0
    cut_s: float = 0.0
    lift_s: float = 0.0
    die_s: float = 0.0
    close_s: float = 0.0
    turns_killed: float = 0.0


NONE: Final = Rates()


@dataclass
class Fates:
    """`befallen`: how often what. One thing at a time befalls a robot. After `end` nothing does any more, and who lies
    dead is found."""

    rates: Rates
    robots: list[SteppedRobot]
    people: People
    campus: CampusMap
    seed: int
    befallen: Counter[str]
    _busy: dict[str, asyncio.Lock] = field(default_factory=dict)
    _ended: asyncio.Event = field(default_factory=asyncio.Event)

    def tasks(self) -> Iterator[asyncio.Task[None]]:
        rates = self.rates
        kinds: tuple[tuple[str, float, Befalls], ...] = (
            ("kill", rates.kill_s, self._is_killed),
            ("cut", rates.cut_s, self._is_cut_off),
            ("lift", rates.lift_s, self._is_carried),
            ("death", rates.die_s, self._dies),
        )
        for one in self.robots:
            for kind, every_s, befalls in kinds:
                if every_s:
                    yield asyncio.create_task(self._now_and_then(one, kind, every_s, befalls))
            if rates.turns_killed:
                yield asyncio.create_task(self._dies_turning(one))
        if rates.close_s:
            yield asyncio.create_task(self._close_corridors())

    def end(self) -> None:
        self._ended.set()

    async def _goes_on_for(self, for_s: float) -> bool:
        """Wait so long; False: the end came before."""
        with suppress(TimeoutError):
            async with asyncio.timeout(for_s):
                await self._ended.wait()
        return not self._ended.is_set()

    async def _now_and_then(self, one: SteppedRobot, kind: str, every_s: float, befalls: Befalls) -> None:
        rng = Random(f"{self.seed} {one.name} {kind}")
        while await self._goes_on_for(rng.expovariate(1 / every_s)):
            async with self._busy.setdefault(one.name, asyncio.Lock()):
                if one.is_on and not self._ended.is_set():
                    await befalls(one, rng)

    async def _is_killed(self, one: SteppedRobot, _: Random) -> None:
        self.befallen["kill"] += 1
        await self._kill(one)

    async def _kill(self, one: SteppedRobot) -> None:
        one.kill()
        await asyncio.sleep(OFF_S)
        one.switch_on()

    async def _is_cut_off(self, one: SteppedRobot, rng: Random) -> None:
        self.befallen["cut"] += 1
        await one.network.be_away(rng.uniform(*CUT_S))

    async def _is_carried(self, one: SteppedRobot, rng: Random) -> None:
        """The person sees robots, and not what the service has let them into."""
        bays = self._empty_bays()
        if one.body.docked or not bays:
            return
        self.befallen["lift"] += 1
        one.body.lift(True)
        await asyncio.sleep(rng.uniform(*CARRIED_S))
        one.body.place(start_pose(self.campus, rng.choice(bays)))
        one.body.lift(False)
        await asyncio.sleep(1.0)
        one.body.press("spot")

    def _empty_bays(self) -> list[str]:
        track, poses = self.campus.track, [one.body.pose for one in self.robots]
        passing = (place for place in track.posts.values() if place.is_for_passing)
        return [
            place.name
            for place in passing
            if all(math.dist(place.point, (pose.x_m, pose.y_m)) > NEAR_M for pose in poses)
        ]

    async def _dies(self, one: SteppedRobot, rng: Random) -> None:
        self.befallen["death"] += 1
        one.kill()
        await self._goes_on_for(rng.uniform(*FOUND_AFTER_S))
        one.body.place(start_pose(self.campus, one.start))
        await self.people.take_out(one.name)
        one.switch_on()
        while not one.stands_by_emergency_stop:  # noqa: ASYNC110  # as a person looks
            await asyncio.sleep(1.0)
        one.body.press("spot")

    async def _close_corridors(self) -> None:
        rng = Random(f"{self.seed} closures")
        while await self._goes_on_for(rng.expovariate(1 / self.rates.close_s)):
            corridor = rng.choice(self.campus.corridors).name
            self.befallen["closure"] += 1
            await self.people.close(corridor)
            await self._goes_on_for(rng.uniform(*CLOSED_S))
            await self.people.open_again(corridor)

    async def _dies_turning(self, one: SteppedRobot) -> None:
        rng = Random(f"{self.seed} {one.name} turns")
        turned = False
        while not self._ended.is_set():
            await asyncio.sleep(LOOK_S)
            turned, turned_before = one.turns_on_a_crossing, turned
            if turned_before or not turned or rng.random() >= self.rates.turns_killed:
                continue
            await asyncio.sleep(rng.uniform(*DIES_AFTER_S))
            async with self._busy.setdefault(one.name, asyncio.Lock()):
                if one.turns_on_a_crossing and not self._ended.is_set():
                    self.befallen["kill in a turn"] += 1
                    self.befallen["kill in a turn beside others"] += self._others_near(one)
                    await self._kill(one)

    def _others_near(self, one: SteppedRobot) -> bool:
        """Others in a bay of that post, or before its crossing."""
        here = one.body.pose
        others = (other.body.pose for other in self.robots if other is not one)
        return any(math.dist((here.x_m, here.y_m), (there.x_m, there.y_m)) < NEAR_M for there in others)
