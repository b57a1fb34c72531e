"""One run: a fleet on a campus for some hours, from the first message to the verdict.

run = Run(Fleet(robots=4), hours=24, seed=1)
seen = run.carry_out()
"""

import asyncio
import tempfile
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from random import Random
from time import process_time
from typing import Final

from app.dispatch.planner_process import PlannerProcess
from app.eta.schemas import EstimateQuality
from benchmarks.fleet_simulation.body import Body, begins_at_home
from benchmarks.fleet_simulation.demand import Demand, Saturated
from benchmarks.fleet_simulation.durations import FITTED, Taking
from benchmarks.fleet_simulation.faults import NONE, Faults, Trouble
from benchmarks.fleet_simulation.grounds import Ground
from benchmarks.fleet_simulation.honeycomb import Honeycomb
from benchmarks.fleet_simulation.judge import Judge
from benchmarks.fleet_simulation.loop import LoopClock, SimulatedLoop
from benchmarks.fleet_simulation.network import Network
from benchmarks.fleet_simulation.owner import Owned
from benchmarks.fleet_simulation.packs import some_pack
from benchmarks.fleet_simulation.people import People
from benchmarks.fleet_simulation.robot import Mind
from benchmarks.fleet_simulation.service import MEMORY, SHIPPED, Pace, PlansInRounds, Service
from fleet.schedule.controller import TrafficController
from maps import CampusMap, read_map
from protocol.ids import ids_from
from robot.mission.store import Store

CHECKS_EVERY_S: Final = 60.0
NEVER_EMPTY: Final = 1000.0
"""Times as long as usual, and full at first: what charging costs is another question."""
SETTLES_S: Final = 120.0
"""After the end what was said comes in, before the letters are counted."""


@dataclass(frozen=True, slots=True)
class Fleet:
    """`lasts`: so many times as long as usual a pack lasts. `rounds`: of improvement, for each plan; `planning`: who
    decides, made of what is random and of these rounds. `unasked`: robots go in without permission, to see that a judge
    sees it."""

    robots: int = 4
    ground: Ground | Honeycomb = field(default_factory=Ground)
    capacity: int = 2
    lasts: float = 1.0
    rounds: int = 3
    faults: Faults = NONE
    demand: Demand | None = None
    pace: Pace = SHIPPED
    planning: Callable[[Random, int], PlannerProcess] = PlansInRounds
    unasked: bool = False


@dataclass
class Seen:
    """What came of a run. `astray`: letters of which the service believes what is not so. `beside_s`: how long what was
    done beside the event loop took, by its name, in real seconds. `traffic`: as it was at the end; None where the
    service was just making it anew."""

    hours: float
    took_s: float
    judge: Judge
    people: People
    befallen: Counter[str]
    estimates: EstimateQuality
    states: Counter[str]
    astray: list[str]
    driven_m: float
    stranded: int
    beside_s: dict[str, list[float]]
    traffic: TrafficController | None


@dataclass
class Run:
    """Of the same seed everything is the same, in a process whose strings hash alike (PYTHONHASHSEED)."""

    fleet: Fleet
    hours: float
    seed: int
    owned: list[Owned] = field(default_factory=list)
    _tasks: list[asyncio.Task[None]] = field(default_factory=list)

    def carry_out(self) -> Seen:
        in_memory = str(MEMORY) if MEMORY.is_dir() else None
        with (
            tempfile.TemporaryDirectory(dir=in_memory) as folder,
            ids_from(self._rng("ids").randbytes),
            asyncio.Runner(loop_factory=SimulatedLoop) as runner,
        ):
            return runner.run(self._live(Path(folder)))

    def _rng(self, of: str) -> Random:
        return Random(f"{self.seed} {of}")

    async def _live(self, folder: Path) -> Seen:
        begun_s = process_time()
        path = self.fleet.ground.write(folder)
        loop = asyncio.get_running_loop()
        assert isinstance(loop, SimulatedLoop)
        campus, clock = read_map(path), LoopClock(loop)
        planning = self.fleet.planning(self._rng("planning"), self.fleet.rounds)
        service = await Service.begin(
            *(folder / "service", str(path), clock, planning, self.fleet.pace),
            robot_capacity=self.fleet.capacity,
        )
        judge, taking = Judge(campus.track, clock.now), Taking(campus, FITTED, self.seed)
        people, befallen = People(service.parts, taking, self._rng("people")), Counter[str]()
        await people.begin()
        for number, home in enumerate(homes(campus, self.fleet.robots)):
            await self._add_robot(f"r{number}", home, (campus, clock, judge, taking), service, people, befallen)
        await self._go_through(campus, service, people)
        states, astray = await people.states(), await people.astray(self._still_to_tell())
        schedule = service.parts.traffic_service.schedule
        await self._end(service)
        judge.ends()
        estimates = EstimateQuality.of(service.parts.estimates)
        bodies = [one.body for one in self.owned]
        return Seen(
            hours=self.hours,
            took_s=process_time() - begun_s,
            judge=judge,
            people=people,
            befallen=befallen,
            estimates=estimates,
            states=states,
            astray=astray,
            driven_m=sum(body.driven_m for body in bodies),
            stranded=sum(body.stranded for body in bodies),
            beside_s=loop.beside_s,
            traffic=schedule.controller if schedule is not None else None,
        )

    async def _add_robot(
        self,
        name: str,
        home: str,
        world: tuple[CampusMap, LoopClock, Judge, Taking],
        service: Service,
        people: People,
        befallen: Counter[str],
    ) -> None:
        campus, clock, judge, taking = world
        pack = some_pack(self._rng(f"{name} pack"))
        pack.capacity_mah, pack.charger_ma = pack.capacity_mah * self.fleet.lasts, pack.charger_ma * self.fleet.lasts
        if self.fleet.lasts > 1.0:  # else it would charge for days what it had not at first
            pack.ratio = 1.0
        body = Body(name, home, campus.track, taking, judge, pack, self._rng(f"{name} body"))
        begins_at_home(body)
        network = Network(service.serve, await service.enrol(name), self._rng(f"{name} network"))
        mind = partial(Mind, name, home, campus.track, clock, body, network, people)
        make = partial(mind, Store(None), self._rng(f"{name} mind"), self.fleet.unasked)
        one = Owned(name, body, network, people, make, befallen)
        one.switch_on()
        self.owned.append(one)

    async def _go_through(self, campus: CampusMap, service: Service, people: People) -> None:
        demand = self.fleet.demand or Saturated(self.fleet.robots + 5)
        ordering = asyncio.create_task(demand.run(people, sorted(campus.posts), self._rng("orders")))
        trouble = Trouble(self.fleet.faults, campus, self.owned, people, self.seed)
        self._tasks = [ordering, *trouble.tasks()]
        until_s = self.hours * 3600.0
        while people.now_s < until_s:
            await asyncio.sleep(min(CHECKS_EVERY_S, until_s - people.now_s))
            self._check(service)
        self._tasks.remove(ordering)
        ordering.cancel()
        await asyncio.sleep(SETTLES_S)
        self._check(service)

    def _check(self, service: Service) -> None:
        """Raise what has ended anything that should go on."""
        service.check()
        for one in self.owned:
            if one.failure is not None:
                raise one.failure
        for task in self._tasks:
            if task.done():
                task.result()

    def _still_to_tell(self) -> frozenset[str]:
        return frozenset(one.name for one in self.owned if not one.has_told_all)

    async def _end(self, service: Service) -> None:
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        for one in self.owned:
            await one.switch_off()
        await asyncio.sleep(1.0)  # the service hears of it
        await service.end()


def homes(campus: CampusMap, robots: int) -> list[str]:
    """Where each robot begins: in a home of its own. Raises ValueError if the map has too few."""
    known = [home.name for home in campus.track.home_bays]
    if robots > len(known):
        raise ValueError(f"the map {campus.name} has homes for {len(known)} robots, and not for {robots}")
    return known[:robots]
