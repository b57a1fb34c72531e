"""One run: a fleet of whole robots on a campus for some minutes, and what the bodies did."""

import asyncio
import tempfile
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from time import process_time
from typing import Any, Final

from sqlmodel import col, select

from app.models import Alarm, GrantRow, OccupancyRow
from benchmarks.fleet_simulation.demand import Saturated
from benchmarks.fleet_simulation.durations import FITTED, Taking
from benchmarks.fleet_simulation.loop import LoopClock, SimulatedLoop
from benchmarks.fleet_simulation.network import Network
from benchmarks.fleet_simulation.people import People
from benchmarks.fleet_simulation.service import MEMORY, SHIPPED, Pace, PlansInRounds, Service
from benchmarks.stepped_fleet.bystanders import Bystanders
from benchmarks.stepped_fleet.fates import NONE, Fates, Rates
from benchmarks.stepped_fleet.judge import TrueFloor
from benchmarks.stepped_fleet.paces import Paces
from benchmarks.stepped_fleet.robots import SteppedRobot
from benchmarks.stepped_fleet.silence import keep_silent
from maps import CampusMap, read_map
from maps.campus_map import map_path
from maps.map_file import load_map_file, toml_of
from maps.scaling import scaled
from protocol.ids import ids_from
from robot.simulated import World

STEP_S: Final = 0.02
QUIET_S: Final = 180.0
"""At the end, when nothing befalls a robot any more: longer than a network is cut, so that all it has to say comes."""
LOOK_EVERY: Final = 5
"""Steps between two looks of the judge: a tenth of a second."""


@dataclass(frozen=True)
class Fleet:
    """`scale`: of the corridors. `waiting`: so many orders always wait."""

    map: str = "carleton"
    robots: int = 4
    scale: float = 0.1
    waiting: int = 6
    rates: Rates = NONE
    pace: Pace = SHIPPED


@dataclass
class Run:
    """`carry_out` gives the figures."""

    fleet: Fleet
    minutes: float
    seed: int
    robots: list[SteppedRobot] = field(default_factory=list)
    befallen: Counter[str] = field(default_factory=Counter)

    def carry_out(self) -> dict[str, Any]:
        in_memory = str(MEMORY) if MEMORY.is_dir() else None
        with (
            tempfile.TemporaryDirectory(dir=in_memory) as folder,
            ids_from(Random(f"{self.seed} ids").randbytes),
            asyncio.Runner(loop_factory=SimulatedLoop) as runner,
        ):
            return runner.run(self._live(Path(folder)))

    async def _live(self, folder: Path) -> dict[str, Any]:
        begun_s = process_time()
        path = folder / "campus.toml"
        path.write_text(toml_of(scaled(load_map_file(map_path(self.fleet.map)), self.fleet.scale)))
        campus, clock = read_map(path), LoopClock(asyncio.get_running_loop())
        planning = PlansInRounds(Random(f"{self.seed} planning"), 3)
        service = await Service.begin(folder / "service", str(path), clock, planning, self.fleet.pace)
        people = People(service.parts, Taking(campus, FITTED, self.seed), Random(f"{self.seed} people"))
        await people.begin()
        world, floor, paces = World(campus, seed=self.seed), TrueFloor(campus.track), Paces(campus.track)
        await self._put_down(campus, world, folder, clock, service)
        bystanders = Bystanders(people, campus.track, Random(f"{self.seed} bystanders"))
        ordering = Saturated(self.fleet.waiting).run(people, sorted(campus.posts), Random(f"{self.seed} orders"))
        silences = [keep_silent(one, campus.track, self.befallen) for one in self.robots]
        fates = Fates(self.fleet.rates, self.robots, people, campus, self.seed, self.befallen)
        tasks = [*(asyncio.create_task(one) for one in (ordering, *silences)), *fates.tasks()]
        await self._step(60.0 * self.minutes, clock, service, (floor, paces), bystanders, tasks)
        fates.end()
        bystanders.leave()
        await self._step(QUIET_S, clock, service, (floor, paces), bystanders, tasks)
        found = await self._figures(service, people, floor, bystanders, process_time() - begun_s)
        found["takes"] = paces.figures()
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        for one in self.robots:
            one.close()
        await asyncio.sleep(1.0)
        await service.end()
        return found

    async def _put_down(
        self, campus: CampusMap, world: World, folder: Path, clock: LoopClock, service: Service
    ) -> None:
        homes = campus.track.home_bays
        if self.fleet.robots > len(homes):
            raise ValueError(f"{campus.name} has homes for {len(homes)} robots, not for {self.fleet.robots}")
        for number, home in enumerate(homes[: self.fleet.robots]):
            name = f"r{number}"
            network = Network(service.serve, await service.enrol(name), Random(f"{self.seed} {name} network"))
            start = f"dock:{home.name}" if home.dock else home.name
            seed = Random(f"{self.seed} {name}").getrandbits(31)
            one = SteppedRobot(name, start, world, folder / name, clock, network, seed)
            one.switch_on()
            self.robots.append(one)

    async def _step(
        self,
        for_s: float,
        clock: LoopClock,
        service: Service,
        judges: tuple[TrueFloor, Paces],
        bystanders: Bystanders,
        tasks: list[asyncio.Task[None]],
    ) -> None:
        floor, paces = judges
        for step in range(round(for_s / STEP_S)):
            await asyncio.sleep(STEP_S)
            for one in self.robots:
                one.tick_until(clock.now())
            if step % LOOK_EVERY == 0:
                poses = {one.name: one.body.body.true_pose for one in self.robots}
                floor.look(poses)
                paces.look(poses)
            if step % 50 == 0:
                service.check()
                for task in tasks:
                    if task.done():
                        task.result()
                await bystanders.tick(self.robots, clock.now())
                floor.look_at_grants(poses, await _granted(service))
                paces.hear(await _occupied(service))

    async def _figures(
        self, service: Service, people: People, floor: TrueFloor, bystanders: Bystanders, took_s: float
    ) -> dict[str, Any]:
        states = await people.states()
        async with service.parts.database.reading() as session:
            alarms = Counter(alarm.name for alarm in (await session.exec(select(Alarm))).all())
        judge, out_of_reach = floor.collisions, frozenset(one.name for one in self.robots if not one.network.is_up)
        return {
            "robot_hours": round(self.fleet.robots * (60.0 * self.minutes + QUIET_S) / 3600.0, 2),
            "overlaps": len(judge.overlaps),
            "touches": judge.touches,
            "collisions": [str(one) for one in judge.found],
            "ungranted": floor.ungranted,
            "longest_on_a_crossing_s": round(floor.longest_on_crossing_s, 1),
            "driven_m": round(floor.driven_m),
            "handed_over": bystanders.handed_over,
            "orders": dict(states),
            "astray": await people.astray(out_of_reach),
            "out_of_reach": sorted(out_of_reach),
            "befallen": dict(self.befallen),
            "alarms": dict(alarms),
            "processor_s": round(took_s),
        }


async def _granted(service: Service) -> dict[str, set[str]]:
    async with service.parts.database.reading() as session:
        held = (await session.exec(select(GrantRow).where(col(GrantRow.cleared_at).is_(None)))).all()
    granted: dict[str, set[str]] = {}
    for row in held:
        granted.setdefault(row.robot, set()).add(row.corridor)
    return granted


async def _occupied(service: Service) -> dict[str, str]:
    async with service.parts.database.reading() as session:
        return {row.robot: row.kind for row in (await session.exec(select(OccupancyRow))).all()}
