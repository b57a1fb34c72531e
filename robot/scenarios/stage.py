"""A scenario that runs: one world, every robot's daemon, the people and the service, moved by one stepped clock."""

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import Final

from protocol.clock import SteppedClock
from robot.core.config import ConfigError, Settings, load_settings
from robot.ops.assembly import Parts, Simulation, assemble
from robot.ops.runners import LockstepRunner, Loop
from robot.scenarios.actors.actors import Actor
from robot.scenarios.actors.mail import letters_of
from robot.scenarios.actors.people import Crowd, handings
from robot.scenarios.actors.stand_in import StandIn
from robot.scenarios.actors.stepped_link import SteppedLink
from robot.scenarios.campus import campus_of
from robot.scenarios.errors import ScenarioError
from robot.scenarios.happenings import Happenings
from robot.scenarios.judging import Ending, verdict
from robot.scenarios.places import is_in
from robot.scenarios.scenario import NoNetwork, RobotRow, Scenario
from robot.scenarios.watching import Watch
from robot.simulated import CollisionJudge, Motion, World

LOOK_HZ: Final = 10.0
"""How often people look, the service answers and the truth is compared."""
QUIET_S: Final = 5.0
"""Everybody has been at rest for so long: the run is over."""
NOISY_HZ: Final = 200.0
"""With diodes that flicker the floor is looked at as often as on the robot, for the majority vote."""
Say = Callable[[float, str, str], None]
"""Told what happens: when, to whom, what."""


def silent(_: float, __: str, ___: str) -> None:
    """No listener."""


class Stage:
    """`with Stage(scenario, folder) as stage: ending = stage.run()`. Raises ScenarioError."""

    def __init__(self, scenario: Scenario, data: Path, source: Path | None = None, say: Say = silent) -> None:
        self.scenario, self.say = scenario, say
        self.clock = SteppedClock()
        self.campus = campus_of(scenario.map, source)
        self.world = World(self.campus, gap_m=scenario.noise.gap_mm / 1000, seed=scenario.seed)
        self.letters = letters_of(scenario.order, scenario.seed)
        self.watchers: list[Callable[[float], None]] = []
        """Called after everything else, ten times a second: who records."""
        self._quiet_since_s: float | None = None
        self._dark = [(row, row.darkness) for row in scenario.dark]
        with ExitStack() as closing:
            track = self.campus.track
            homes = {row.name: track.home_at(row.home) for row in scenario.robot}
            self.service = StandIn(track, self.clock, self.letters, homes)
            self.actors: list[Actor] = []
            for number, row in enumerate(scenario.robot):
                actor = self._actor(number, row, data)
                closing.callback(self._close_actor, actor)
                self.actors.append(actor)
            self._closing = closing.pop_all()
        self.handings = handings(self.letters.values(), scenario.seed)
        self.crowd = Crowd(self.campus, scenario.walker, scenario.stander)
        self.watch = Watch(track, self.service)
        self.judge = CollisionJudge()
        self.happenings = Happenings(self.campus, self.service, lambda who, what: self.say(self.clock.now(), who, what))
        self.happenings.add(scenario, self.actors)
        self._told = 0
        self.runner = LockstepRunner(
            (*self._robot_loops(), Loop("world", LOOK_HZ, "everybody", self._tick)), self.clock
        )

    def __enter__(self) -> "Stage":
        return self

    def __exit__(self, *_: object) -> None:
        self._closing.close()

    # Robots

    def _actor(self, number: int, row: RobotRow, data: Path) -> Actor:
        scenario = self.scenario
        motion = Motion(ripple_mm_s=scenario.noise.ripple_mm_s, wheel_error=scenario.noise.wheel_error)
        seed = Random(f"{scenario.seed}/{number}").getrandbits(31) if number else scenario.seed
        simulation = Simulation(row.start, row.battery, seed, in_memory=True, world=self.world, motion=motion)
        parts = assemble(self._settings(row, data), self.clock, simulation)
        body = parts.robot
        if body is None:
            raise ScenarioError("scenario", f"robot {row.name}", "it is not simulated")
        body.set_fault("floor_flip", scenario.noise.flip)
        body.set_fault("floor_edge_mm", scenario.noise.edge_mm)
        body.soil(scenario.dirt)
        actor = Actor(row, parts, body, self._link(row, parts))
        parts.mind.hands.noted = lambda text: self.say(self.clock.now(), row.name, text)
        return actor

    def _settings(self, row: RobotRow, data: Path) -> Settings:
        own = {
            "name": row.name,
            "home": row.home,
            "data": data / row.name,
            "battery.simulated_capacity_mah": row.capacity_mah,
            "battery.simulated_charger_ma": row.charger_ma,
            **self._rates(),
        }
        try:
            return load_settings(None, {**own, **row.settings})
        except ConfigError as error:
            raise ScenarioError("scenario", f"robot.settings.{error.key}", error.message, error.way_out) from None

    def _rates(self) -> dict[str, float]:
        """Diodes that do not flicker need no majority: one look per tick is enough, and four times as quick."""
        noise = self.scenario.noise
        if noise.flip or noise.edge_mm:
            return {"rates.line_hz": NOISY_HZ, "rates.base_hz": NOISY_HZ}
        return {"rates.line_hz": 50.0}

    def _link(self, row: RobotRow, parts: Parts) -> SteppedLink:
        missions, robot = parts.mind.hands.missions, parts.robot

        def network() -> bool:
            pose = robot.pose if robot else None
            return pose is not None and not any(
                self._is_now(patch) and is_in(patch, self.campus, pose.x_m, pose.y_m)
                for patch in self.scenario.no_network
            )

        link = SteppedLink(
            robot=row.name,
            clock=self.clock,
            outbox=missions.outbox,
            memory=missions.memory,
            hello_source=parts.daemon.hello,
            far=self.service,
            network=network,
        )
        missions.join(link)
        parts.mind.said = link.say
        parts.daemon.server = link
        return link

    def _is_now(self, patch: NoNetwork) -> bool:
        now = self.clock.now()
        return now >= patch.from_s and (patch.until_s is None or now < patch.until_s)

    def _robot_loops(self) -> list[Loop]:
        return [
            replace(loop, name=f"{actor.name}: {loop.name}")
            for actor in self.actors
            for loop in actor.parts.daemon.loops()
        ]

    def _close_actor(self, actor: Actor) -> None:
        actor.parts.daemon.close(self.clock.now())

    # What goes on

    def run(self, limit_s: float | None = None) -> Ending:
        """Until everybody is at rest, or the limit; then everything is judged."""
        self._until_s = self.clock.now() + (limit_s or self.scenario.limit_s)
        self.runner.run()
        self.runner.restart()
        return self.ending()

    def _tick(self, now: float) -> None:
        self.happenings.tick(now)
        self.crowd.tick(self.actors, now)
        self.world.obstacles[:] = self.crowd.present
        for actor in self.actors:
            actor.look(self.campus.track, now)
            self._darken(actor)
            for one in self.handings:
                one.tick(actor, now)
        self.service.tick(now)
        for actor in self.actors:
            actor.link.tick(now)
        self.watch.tick(self.actors, self.crowd.present, now)
        self.judge.look({actor.name: actor.body.body.true_pose for actor in self.actors})
        self._tell(now)
        for watcher in self.watchers:
            watcher(now)
        if now >= self._until_s or self._is_quiet(now):
            self.runner.stop()

    def _darken(self, actor: Actor) -> None:
        """As dark as the darkest place that the robot is in; a fault `darkness` goes by itself where there is none."""
        if not self._dark:
            return
        pose = actor.body.pose
        darkest = max((share for row, share in self._dark if is_in(row, self.campus, pose.x_m, pose.y_m)), default=0.0)
        actor.body.set_fault("darkness", darkest)

    def _tell(self, now: float) -> None:
        for told in self.service.told[self._told :]:
            self.say(now, told.robot, told.text)
        self._told = len(self.service.told)

    def _is_quiet(self, now: float) -> bool:
        quiet = not self.happenings.pending and self.service.is_done and all(_rests(actor) for actor in self.actors)
        if not quiet:
            self._quiet_since_s = None
        elif self._quiet_since_s is None:
            self._quiet_since_s = now
        return self._quiet_since_s is not None and now - self._quiet_since_s >= QUIET_S

    def ending(self) -> Ending:
        """The result so far."""
        return Ending(
            verdicts=[verdict(letter, self.service) for letter in self.letters.values()],
            violations=[*self.watch.violations, *map(str, self.judge.overlaps), *self._errors()],
            bumps=sum(self.watch.bumps.values()),
            searches=sum(self.watch.searches.values()),
            home=all(actor.body.docked for actor in self.actors),
            posts=[post for _, post in self.actors[0].posts],
            told=self.service.told,
        )

    def _errors(self) -> list[str]:
        """Return what went wrong on the link, and an agent's goals that failed without a recovery plan."""
        link = [f"{name}: {error}" for name, session in self.service.sessions.items() for error in session.errors]
        return [*link, *(f"{actor.name}: {one}" for actor in self.actors for one in actor.parts.mind.failures)]


def _rests(actor: Actor) -> bool:
    """In its dock, with nothing to do; or where no dock is."""
    mind = actor.parts.mind
    return mind.is_quiet and (actor.body.docked or mind.hands.navigator.home is None)
