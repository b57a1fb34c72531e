"""The estimates of a simulated fleet, as its orders come: forecast with each order, scored once the robot is there.

Everything is simulated: robots on the Carleton tunnels, demand with two rush hours a day, each corridor with a pace of
its own that the map does not tell, a robot that stands still in every two hundredth corridor, charges in between.
Orders are given, first come first served, to the robot that will be there first; `fleet.schedule.planning` puts them
in.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from math import inf
from random import Random
from typing import Any, Final

from app.dispatch.forecasts import Stop as EtaUpdates
from benchmarks.fleet.estimated_world import (
    CHARGE_AFTER_S,
    CHARGE_S,
    CLOSES_H,
    DAY_S,
    HOUR_S,
    OFFICE_H,
    OPENS_H,
    RUSH_H,
    Robot,
    Stop,
    Truth,
    World,
    hour_of,
)
from benchmarks.fleet.grounds import home_docks
from benchmarks.fleet.promises import Promises
from fleet.eta.arrivals import Ahead, Estimates
from fleet.eta.durations import Kind, Thing
from fleet.eta.forecast import forecast
from fleet.eta.intervals import Interval
from fleet.schedule.execution import retimed
from fleet.schedule.journey import Start
from fleet.schedule.network import Network, network_of
from fleet.schedule.planning import Schedule, first_plan, improve, insert, plan
from maps import builtin_map
from maps.ways import Ways
from protocol.parts import StopAction

SPEED_M_S: Final = 0.15
HANDOVER_S: Final = 120.0
PER_HOUR, PER_RUSH_HOUR = 1.0, 3.0
PACE: Final = (0.9, 1.6)
"""Of the seconds by length, each corridor in each direction for itself."""
FOLLOWING_S: Final = 60.0
ROUNDS: Final = 4
CHARGED_S: Final = sum(CHARGE_S) / 2
BEGINS: Final = datetime(2026, 1, 5, tzinfo=UTC)
"""A Monday."""


@dataclass
class Study:
    """One seed: a world, and the estimates that watch it."""

    rng: Random
    network: Network
    promises: Promises
    world: World = field(init=False)
    _not_fetched: set[str] = field(default_factory=set)

    # What the world tells.

    def handled(self, stop: Stop, _at_s: float) -> None:
        if stop.kind is not None:
            self.promises.handled(stop.kind, stop.begun_s, stop.takes_s)

    def reached(self, key: str, at_s: float) -> None:
        order, _, what = key.rpartition(" ")
        if what == "load":
            self._not_fetched.discard(order)
            self.promises.fetched(order, at_s)
        elif what == "receive":
            self.promises.came(order, at_s)

    # What is planned and forecast.

    def place(self, name: str, start: int, end: int) -> None:
        """One order: told when it is placed, given at once to the robot likely to have it done first, told then."""
        self.promises.estimates.ahead = Ahead(len(self._not_fetched), len(self.world.robots))
        self.promises.placed(name, self.world.now_s, start, end)
        self._not_fetched.add(name)
        load, receive = Stop(f"{name} load", Kind.LOAD, start), Stop(f"{name} receive", Kind.RECEIVE, end)
        robot = self._soonest(start)
        its = self.world.robots[robot]
        charge = [Stop(f"{name} charge", None, its.home)] if self._must_charge(its) else []
        self._give(robot, [*charge, load, receive])
        self.promises.under_way(name, self.world.now_s, (start, end), self._forecast()[receive.key])

    def _soonest(self, start: int) -> str:
        tasks = self._tasks()
        journeys = retimed(self.network, tasks, self.world.journeys)

        def ready_there_s(robot: str) -> float:
            task = tasks[robot]
            last = task.goals[-1].post if task.goals else task.start.post
            return journeys[robot].done_s + self.network.shortest_s[last][start]

        return min(journeys, key=ready_there_s)

    def _must_charge(self, robot: Robot) -> bool:
        if robot.driven_s < CHARGE_AFTER_S or any(stop.kind is None for stop in robot.stops):
            return False
        robot.driven_s = 0.0
        return True

    def _give(self, robot: str, stops: list[Stop]) -> None:
        kept = retimed(self.network, self._tasks(), self.world.journeys)
        self.world.add(robot, *stops)
        tasks = self._tasks()
        found = plan(self.network, tasks, [robot], kept) or insert(self.network, tasks, kept, robot)
        found = found or first_plan(self.network, tasks, self.rng)
        assert found is not None, "there is always a schedule"
        left = iter(range(ROUNDS))
        whole = Schedule(found.journeys, found.cost_s, tuple(tasks))
        better = improve(self.network, tasks, whole, self.rng, lambda: next(left, None) is not None)
        self.world.journeys = dict(better.journeys)

    def _tasks(self) -> dict[str, Any]:
        durations = self.promises.estimates.durations
        return self.world.believed(
            lambda stop: CHARGED_S if stop.kind is None else durations.quantile_s(self._handling(stop.kind), 0.5),
            lambda lane: durations.quantile_s(self.promises.corridor(lane), 0.5),
        )

    def _handling(self, kind: Kind) -> Thing:
        return self.promises.estimates.stop(kind, self.promises.local(self.world.now_s))

    def _forecast(self) -> dict[str, Interval]:
        tasks, now_s = self._tasks(), self.world.now_s
        journeys = retimed(self.network, tasks, self.world.journeys)
        robots = self.world.robots.items()
        stops = {stop.key: self._seen(stop, name) for name, robot in robots for stop in robot.stops if stop.kind}
        return forecast(self.network, tasks, journeys, now_s, self.promises.foresight(stops, now_s, self.rng).chance())

    def _seen(self, stop: Stop, robot: str) -> EtaUpdates:
        """As the service has it."""
        order, _, what = stop.key.rpartition(" ")
        arrived_at = None if stop.begun_s == inf else self.promises.local(stop.begun_s)
        return EtaUpdates(stop.key, StopAction(what), self.network.posts[stop.post], order, robot, arrived_at)


def arrivals(rng: Random, days: float) -> Iterator[float]:
    """When orders come: by chance, in opening hours, more in the rush."""
    now_s = OPENS_H * HOUR_S
    while now_s < days * DAY_S:
        now_s += rng.expovariate(PER_RUSH_HOUR / HOUR_S)
        hour = int(hour_of(now_s))
        rate = 0.0 if not OPENS_H <= hour < CLOSES_H - 1 else PER_RUSH_HOUR if hour in RUSH_H else PER_HOUR
        if rng.random() < rate / PER_RUSH_HOUR:
            yield now_s


def study(seed: int, days: float, robots: int = 4, bays: int = 2) -> Study:
    """So many days of one seed."""
    rng, campus = Random(seed), builtin_map("carleton")
    network = network_of(campus, lambda way, _: way.length_m / SPEED_M_S, lambda _: FOLLOWING_S)
    network = replace(network, bays=tuple(bays for _ in network.posts))
    estimates = Estimates(Ways(campus), SPEED_M_S, HANDOVER_S, UTC, range(*OFFICE_H))
    its = Study(rng, network, Promises(network, estimates, BEGINS))
    pace = {(at, back): rng.uniform(*PACE) for at in range(len(network.corridors)) for back in (0, 1)}
    homes = [network.number_of(post) for post in home_docks(campus)]
    fleet = {f"r{number}": homes[number % len(homes)] for number in range(robots)}
    there = {name: Robot(home, Start(home, True, 0.0, 0.0)) for name, home in fleet.items()}
    its.world = World(network, there, Truth(rng, pace), its.promises.drove, its.handled, its.reached)
    first = first_plan(network, its.world.believed(lambda _: 0.0, lambda lane: lane.travel_s), rng)
    assert first is not None, "everybody is at home"
    its.world.journeys = dict(first.journeys)
    demand = Random(1000 + seed)  # the same whatever the robots do
    for number, at_s in enumerate(arrivals(demand, days)):
        its.world.advance(at_s)
        its.place(f"o{number}", *demand.sample(range(len(network.posts)), 2))
    its.world.advance(its.world.now_s + 12 * HOUR_S)
    return its
