"""One letter for one simulated robot in stepped time: people at both ends, and a service that grants what is claimed.

The robot may be killed and started again on what it left on its disk. All the time the truth is compared with what it
was granted and with where it believes to stand.
"""

import math
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from hashlib import sha256
from multiprocessing import get_context
from pathlib import Path
from random import Random
from typing import TypeVar

from benchmarks.body.missions import PROCESSES
from maps import corridor_name
from protocol.clock import SteppedClock
from protocol.parts import Leg, Part, Purpose, Stop, StopAction
from protocol.to_robot import Grant, Mission, Verifier, Verifiers
from protocol.to_server import Claim, Clear, Event, Fault, HandoverReceipt
from robot.core.config import load_settings
from robot.mission.memory import Incoming
from robot.mission.mission import MissionManager
from robot.ops.assembly import Simulation, assemble
from robot.ops.runners import LockstepRunner
from robot.scenarios.campus import campus_of
from robot.scenarios.places import POST_ROOM_M, corridor_at
from robot.scenarios.replay.drawing import WORLDS
from robot.simulated import Motion, World

DEAD_S = 3.0
SHOWN_FOR_S = 4.0
AT_DOCK_M = 1.0
LIMIT_S = 2500.0
Played = TypeVar("Played")
SETTINGS = {"rates.line_hz": 50.0, "battery.simulated_charger_ma": 60_000.0}
STOPS = {Purpose.LOAD: StopAction.LOAD, Purpose.RECEIVE: StopAction.RECEIVE}


@dataclass
class Service:
    """Grants every claim at once; `held` are the corridors that it believes to be the robot's."""

    missions: MissionManager
    held: list[Leg] = field(default_factory=list)
    told: list[Part] = field(default_factory=list)
    online: bool = True
    heard: int = 0
    _said: int = 0
    _waiting: list[Incoming] = field(default_factory=list)

    def incoming(self) -> Sequence[Incoming]:
        """Called in every tick of the mind: that is when the robot is heard, too."""
        for kept in self.missions.outbox.pending(after=self.heard, limit=1000):
            self.heard = kept.seq
            self.told.append(kept.message)
            self._hear(kept.message)
        taken, self._waiting = self._waiting, []
        return taken

    def _hear(self, message: Part) -> None:
        match message:
            case Claim(claim_id=claim_id, legs=legs):
                self.held += [leg for leg in legs if leg not in self.held]
                self.missions.memory.grant(legs)
                self._said += 1
                self._waiting.append(Incoming(Grant(claim_id=claim_id, legs=legs), "service", self._said))
            case Clear(leg=leg):
                self.held.remove(leg)

    def wake(self) -> None:
        pass


class LetterRun:
    """`run` until `stop` says so, the letter is delivered and the robot at home, or the time is over.

    `motion`: how well its wheels do what they are told; `slip`: the share of it that is lost on the floor. `drains_to`:
    what its battery holds as soon as the mail is aboard; None: it loses nothing at once.
    """

    def __init__(
        self,
        folder: Path,
        world: str,
        seed: int,
        motion: Motion | None = None,
        slip: float = 0.0,
        drains_to: float | None = None,
    ) -> None:
        self.random, self._world, self._seed = Random(f"{world}/{seed}/letter"), world, seed
        self._motion, self._slip, self._drains_to = motion or Motion(), slip, drains_to
        self._folder, self.clock, self.campus = folder, SteppedClock(), campus_of(WORLDS[world])
        self._track = self.campus.track
        homes = [self._track.address_of(home.name) for home in self._track.home_bays if home.dock]
        self._home = self.random.choice(homes or [dock.name for dock in self.campus.docks()])
        self._codes = {purpose: f"CM1:{self.random.randbytes(16).hex()}" for purpose in STOPS}
        self.told: list[Part] = []
        self.problems: list[str] = []
        self._held: list[Leg] = []
        self._heard = 0
        self._wanted: Callable[[], bool] = lambda: False
        self.start()
        self._give_letter()

    def start(self) -> None:
        """For the first time, or on what it left when it was killed."""
        settings = load_settings(None, {**SETTINGS, "data": self._folder, "home": self._home})
        world = World(self.campus, seed=self._seed)
        simulation = Simulation(f"dock:{self._home}", 0.9, self._seed, in_memory=True, world=world, motion=self._motion)
        self.parts = assemble(settings, self.clock, simulation)
        assert self.parts.robot is not None
        self.robot, self.mind, self.navigator = self.parts.robot, self.parts.mind, self.parts.navigator
        self.robot.set_fault("slip", self._slip)
        self._service = Service(self.mind.hands.missions, self._held, self.told, heard=self._heard)
        self.mind.hands.missions.join(self._service)
        self._runner = LockstepRunner(self.parts.daemon.loops(), self.clock)
        self.parts.daemon.watchers = (self._look,)

    def kill(self) -> None:
        """As SIGKILL does: nothing is tidied up; it stays dead for a moment."""
        self._heard = self._service.heard
        self.parts.daemon.close_devices()
        self.clock.advance(DEAD_S)

    def close(self) -> None:
        self.parts.daemon.close(self._runner.now_s)

    def run(self, stop: Callable[[], bool] = lambda: False) -> bool:
        """Run; return whether `stop` ended it."""
        self._wanted = stop
        self._runner.run()
        self._runner.restart()
        return stop()

    def _look(self, now: float) -> None:
        self._judge()
        waited_for = next((one for one in self.mind.actions.under_way if one.startswith("wait_handover(")), None)
        handing_over = self.mind.hands.missions.custody.handing_over
        if waited_for and not handing_over and self.robot.camera.shown is None:
            purpose = Purpose(waited_for.removeprefix("wait_handover(").split(",")[0])
            self.robot.show_code(self._codes.get(purpose, self._codes[Purpose.LOAD]), SHOWN_FOR_S)
        if self._drains_to is not None and self._handed_over:
            self.robot.sag(self._drains_to)
            self._drains_to = None
        if self._wanted() or self.is_over or now > LIMIT_S:
            self._runner.stop()

    # The truth.

    def distance_m(self, post: str) -> float:
        pose = self.robot.pose
        return math.dist(self._track.post(post).point, (pose.x_m, pose.y_m))

    def _judge(self) -> None:
        pose, at = self.robot.pose, self.navigator.at
        corridor = corridor_at(self._track, pose.x_m, pose.y_m)
        granted = {corridor_name(leg.from_post, leg.to_post) for leg in self._held}
        if corridor and corridor not in granted:
            self._complain(f"in {corridor} without a grant")
        if at and self.distance_m(at) > (AT_DOCK_M if self._track.post(at).dock else POST_ROOM_M):
            self._complain(f"believes to stand at {at}")

    def _complain(self, problem: str) -> None:
        if not any(one.startswith(problem) for one in self.problems):
            self.problems.append(f"{problem} at {self.clock.now():.1f} s")

    @property
    def _handed_over(self) -> list[Purpose]:
        happened = [message.happened for message in self.told if isinstance(message, Event)]
        return [one.purpose for one in happened if isinstance(one, HandoverReceipt)]

    @property
    def delivered(self) -> bool:
        return self._handed_over == list(STOPS)

    @property
    def is_over(self) -> bool:
        return self.delivered and self.robot.docked and self.mind.is_quiet

    def faults(self, name: str) -> int:
        """Return the number of times people were told that it began."""
        happened = [message.happened for message in self.told if isinstance(message, Event)]
        return sum(isinstance(one, Fault) and one.name == name and not one.cleared for one in happened)

    # The letter.

    def _give_letter(self) -> None:
        missions, places = self.mind.hands.missions, self.random.sample(sorted(self.campus.posts), 2)
        verifiers = [
            Verifier(
                order_id="o1",
                purpose=purpose,
                sha256=sha256(code.encode()).hexdigest(),
                expires_at=self.clock.utc().replace(year=2999),
            )
            for purpose, code in self._codes.items()
        ]
        missions.memory.keep_verifiers(Verifiers(verifiers=tuple(verifiers)), self.clock.utc())
        stops = tuple(
            Stop(id=f"s{purpose}", post=post, action=action, order_id="o1", wait_limit_s=1e6)
            for (purpose, action), post in zip(STOPS.items(), places, strict=True)
        )
        missions.give(Mission(id="m1", update=1, stops=stops))


def on_both_maps(play: Callable[[str, int], Played], first_seed: int, number: int) -> list[Played]:
    """So many, on one map after the other, in processes of their own. `play` is a module's function."""
    worlds = list(WORLDS)
    tasks = [(worlds[index % len(worlds)], first_seed + index) for index in range(number)]
    with ProcessPoolExecutor(PROCESSES, mp_context=get_context("spawn")) as pool:
        return list(pool.map(play, *zip(*tasks, strict=True)))
