"""The service under test: every part of the product that decides, its workers, and a database in memory.

Left out are pages, mails and retention. What the machine's own time would decide is decided by the seed: the planner
improves for so many rounds and not for so many milliseconds, and SQLite's threads are left out.
"""

import asyncio
from collections.abc import Callable, Coroutine, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from typing import Any, Final, Protocol, TypeVar

from sqlalchemy import event
from starlette.websockets import WebSocket

from app.composition.parts import Parts
from app.core.database.schema_version import bring_to_head
from app.core.database.sqlite_driver import Connection
from app.core.http_client import HttpClient
from app.core.settings import Settings
from app.dispatch.planner_process import PlannerProcess
from app.robots.routes.robots import robot_link
from app.robots.service import enrol
from fleet.assignment.deciding import Decision
from fleet.assignment.improving import improved
from protocol.clock import Clock

MEMORY: Final = Path("/dev/shm")  # noqa: S108  # a file system in memory, where there is one
ROUNDS: Final = 60
"""Of improvement, for each plan: for more there is time in the shipped budget."""
TIMER_EVERY_S: Final = 60.0
"""The product looks each second for what only time changes; here what is late is late by minutes."""
T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Pace:
    """How often the service looks at what it is not notified of, and how long it rests between two looks, in seconds.
    None: as shipped. What wakes it wakes it at once in any case. `dispatch_s`: the rest while orders wait for
    robots."""

    dispatch_s: float | None = None
    traffic_s: tuple[float, float] | None = None
    charging_s: tuple[float, float] | None = None
    eta_s: tuple[float, float] | None = None


SHIPPED: Final = Pace()
CALM: Final = Pace(1.0, traffic_s=(30.0, 0.5), charging_s=(60.0, 10.0), eta_s=(600.0, 300.0))
"""For long runs: estimates are told later, what time alone changes (following, silence) counts some seconds later.
Looks take no simulated time: the rests of traffic and dispatch are what they earn on a real machine."""


class Worker(Protocol):
    """Runs until cancelled."""

    def run(self) -> Coroutine[Any, Any, None]: ...


class AtOnce(Connection):
    """A connection whose statements take no time, and no thread."""

    async def run(self, statement: str, limit_s: float, what: Callable[[], T]) -> T:
        return self._in_turn(what)

    async def _in_thread(self, what: Callable[[], T]) -> T:
        return what()


@dataclass
class PlansInRounds(PlannerProcess):
    """Improves a plan for so many rounds, whatever the machine's speed."""

    rng: Random
    rounds: int

    async def improved(self, decision: Decision, budget_s: float) -> Decision | None:
        left = iter(range(self.rounds))
        return improved(decision, self.rng, lambda: next(left, None) is not None)

    def cut_off(self) -> None:
        pass

    async def end(self) -> None:
        pass


@dataclass
class Service:
    """`running`: its workers. What ends one of them ends the simulation."""

    parts: Parts
    running: list[asyncio.Task[None]] = field(default_factory=list)

    @classmethod
    async def begin(
        cls, folder: Path, campus: str, clock: Clock, planning: PlannerProcess, pace: Pace, **chosen: Any
    ) -> "Service":
        """Make the database and start the workers."""
        settings = Settings(data=folder, map=campus, time_zone="UTC", **chosen)
        http_client = HttpClient(settings.outside_ports, settings.outside_refused_networks)
        parts = Parts(settings, clock, http_client, planning)
        event.listen(parts.database.engine.sync_engine, "do_connect", _connect)
        await bring_to_head(parts.database)
        await parts.fleet.begin()
        await parts.fleet.learning.begin()
        await parts.fleet.spending.learn()
        service = cls(parts)
        service._set(pace)
        service.running = [asyncio.create_task(work, name=name) for name, work in service._workers().items()]
        return service

    def _set(self, pace: Pace) -> None:
        parts = self.parts
        if pace.dispatch_s is not None:
            parts.dispatcher.rest_s = pace.dispatch_s
        paced = (parts.traffic_service, pace.traffic_s), (parts.charging_service, pace.charging_s)
        for worker, times in (*paced, (parts.eta_updates, pace.eta_s)):
            if times is not None:
                worker.polling.again_s, worker.polling.rest_s = times

    def _workers(self) -> Mapping[str, Coroutine[Any, Any, None]]:
        parts = self.parts
        workers: dict[str, Worker] = {
            "dispatch": parts.dispatcher,
            "estimates": parts.fleet.learning,
            "eta_updates": parts.eta_updates,
            "energy_use": parts.fleet.spending,
            "charging": parts.charging_service,
            "traffic": parts.traffic_service,
            "planning": parts.planner,
        }
        return {**{name: worker.run() for name, worker in workers.items()}, "timer": self._tick()}

    async def _tick(self) -> None:
        while True:
            await self.parts.timer.tick()
            await asyncio.sleep(TIMER_EVERY_S)

    async def enrol(self, name: str) -> str:
        """Return the token of a new robot."""
        async with self.parts.database.transaction() as session:
            return await enrol(session, self.parts.clock, name)

    async def serve(self, socket: WebSocket) -> None:
        """One robot's connection, as the service's route has it."""
        await robot_link(socket, self.parts.fleet, self.parts.intake)

    def check(self) -> None:
        """Raise what has ended a worker, if anything has."""
        for task in self.running:
            if task.done():
                task.result()
                raise RuntimeError(f"the service's {task.get_name()} has ended")

    async def end(self) -> None:
        for task in self.running:
            task.cancel()
        await asyncio.gather(*self.running, return_exceptions=True)
        await self.parts.public_http.aclose()
        await self.parts.operator_http.aclose()
        await self.parts.database.close()


def _connect(_dialect: Any, _record: Any, arguments: Any, options: Any) -> Connection:
    return AtOnce(*arguments, **options)
