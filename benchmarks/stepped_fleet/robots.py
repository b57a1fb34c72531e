"""A robot's daemon on simulated time: switched on, killed, and switched on again on what it left on its disk."""

import asyncio
from collections.abc import Iterator
from dataclasses import dataclass, field
from heapq import heapify, heapreplace
from pathlib import Path
from random import Random
from typing import Final

from benchmarks.fleet_simulation.network import Network
from benchmarks.fleet_simulation.robot_link import RobotLink
from protocol.clock import Clock
from protocol.to_server import Why
from robot.core.config import load_settings
from robot.ops.assembly import Parts, Simulation, assemble
from robot.ops.runners import Loop
from robot.simulated import Motion, Pose, SimulatedRobot, World
from robot.skills import Turn
from robot.skills.tunes import TUNES

WHEEL_ERROR: Final = 0.01
SETTINGS: Final = {
    "rates.line_hz": 50.0,
    "battery.simulated_charger_ma": 15_000.0,
    "battery.simulated_capacity_mah": 6000,
}
"""The diodes do not flicker here, so that one look for each tick is enough. The charger is strong, or a day would be
spent in docks: assumed."""
NAMES: Final = {tuple(note for note, _ in notes): name for name, notes in TUNES.items()}


class DaemonLink(RobotLink):
    """The link as the daemon wants it."""

    def say(self, why: Why) -> None:
        if self._newest.take(why):
            self.wake()

    def start(self) -> None:
        """There is no thread to start."""

    def stop(self) -> None:
        """Its task is cancelled by the owner."""


@dataclass
class SteppedRobot:
    """`start`: where it is put down first, as `robot.simulated.start` has it."""

    name: str
    start: str
    world: World
    data: Path
    clock: Clock
    network: Network
    seed: int
    parts: Parts | None = None
    link: DaemonLink | None = None
    kills: int = 0
    stands_since_s: float | None = None
    _due: list[tuple[float, int]] = field(default_factory=list)
    _loops: tuple[Loop, ...] = ()
    _talk: asyncio.Task[None] | None = None
    _songs: int = 0

    @property
    def body(self) -> SimulatedRobot:
        assert self.parts is not None and self.parts.robot is not None  # switched on before
        return self.parts.robot

    @property
    def is_on(self) -> bool:
        return bool(self._loops)

    @property
    def turns_on_a_crossing(self) -> bool:
        if not self.is_on or self.parts is None:
            return False
        return self.parts.navigator.crossing is not None and self.parts.mind.hands.view.motion == Turn.name

    @property
    def stands_by_emergency_stop(self) -> bool:
        """It was told so, since it was taken out."""
        return self.is_on and self.parts is not None and "emergency_stop" in self.parts.mind.hands.view.faults

    def switch_on(self) -> None:
        """Assemble the daemon; after a kill on the disk and in the place that the last one left."""
        pose = self._put_away()
        home = self.start.removeprefix("dock:")
        settings = load_settings(None, {"name": self.name, "home": home, "data": self.data, **SETTINGS})
        motion = Motion(wheel_error=WHEEL_ERROR)
        simulation = Simulation(self.start, 0.95, self.seed, in_memory=True, world=self.world, motion=motion)
        self.parts = parts = assemble(settings, self.clock, simulation)
        if pose is not None:
            self.body.place(pose)
        missions = parts.mind.hands.missions
        self.link = DaemonLink(
            *(self.name, self.network, self.clock, missions.outbox, missions.memory, parts.daemon.hello),
            Random(f"{self.seed} {self.kills} link"),
        )
        missions.join(self.link)
        parts.mind.said, parts.daemon.server = self.link.say, self.link
        self._loops, self._songs = parts.daemon.loops(), 0
        self._due = [(self.clock.now(), number) for number in range(len(self._loops))]
        heapify(self._due)
        self._talk = asyncio.ensure_future(self.link.run())

    def kill(self) -> None:
        """Its computer has stopped: nothing is said any more, and its wheels have stopped (assumed: at once)."""
        self._loops, self._due = (), []
        if self._talk is not None:
            self._talk.cancel()
            self._talk = None
        self.network.hang_up()
        self.kills += 1

    def _put_away(self) -> Pose | None:
        if self.parts is None:
            return None
        pose = self.body.pose
        self.parts.daemon.close(self.clock.now())
        self.parts = None
        return pose

    def close(self) -> None:
        if self.is_on:
            self.kill()
        self._put_away()

    def tick_until(self, now: float) -> None:
        while self._due and self._due[0][0] <= now:
            due_s, number = self._due[0]
            loop = self._loops[number]
            loop.tick(due_s)
            if self._due:
                heapreplace(self._due, (due_s + 1.0 / loop.rate_hz, number))
        moving = self.body.body.base.moving
        self.stands_since_s = None if moving else self.stands_since_s or now

    def heard(self) -> Iterator[str]:
        """The tunes since the last call."""
        self._songs, tunes = self.body.tunes_since(self._songs)
        yield from (NAMES.get(tune, "?") for tune in tunes)
