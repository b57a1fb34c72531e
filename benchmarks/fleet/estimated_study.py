"""The estimates of a simulated fleet, as its orders come: forecast with each order, scored once the robot is there.

Everything is simulated: robots on the Carleton tunnels, demand with two rush hours a day, each corridor with a pace of
its own that the map does not tell, a robot that stands still in every two hundredth corridor, charges in between.
Orders are given, first come first served, to whoever will be there first; `app.traffic.planning` puts them in.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from random import Random
from typing import Any, Final

from app.estimates.calibration import Basis
from app.estimates.durations import Kind, Thing
from app.estimates.forecast import forecast
from app.estimates.intervals import Interval
from app.traffic.execution import retimed
from app.traffic.journey import Goal, Start
from app.traffic.network import Network, network_of
from app.traffic.planning import Timetable, first_plan, improve, insert, plan
from benchmarks.fleet.estimated_world import (
    CHARGE_AFTER_S,
    CHARGE_S,
    CLOSES_H,
    DAY_S,
    HOUR_S,
    OPENS_H,
    RUSH_H,
    Robot,
    Stop,
    Truth,
    World,
    hour_of,
    is_attended,
)
from benchmarks.fleet.promises import Promises, corridor, handling
from maps import builtin_map

SPEED_M_S: Final = 0.15
HANDOVER_S: Final = 120.0
PER_HOUR, PER_RUSH_HOUR = 1.0, 3.0
PACE: Final = (0.9, 1.6)
"""Of the seconds by length, each corridor in each direction for itself."""
FOLLOWING_S: Final = 60.0
ROUNDS: Final = 4


@dataclass
class Study:
    """One seed: a world, and the estimates that watch it."""

    rng: Random
    network: Network
    world: World = field(init=False)
    promises: Promises = field(default_factory=Promises)

    # What the world tells.

    def handled(self, stop: Stop, at_s: float) -> None:
        if stop.kind is not None:
            self.promises.durations.observe(_handling(stop.kind, at_s), stop.takes_s)

    # What is planned and forecast.

    def place(self, name: str, start: int, end: int) -> None:
        """One order: given to whoever is likely to have it done first, and told when it will arrive."""
        load, receive = Stop(f"{name} load", Kind.LOAD, start), Stop(f"{name} receive", Kind.RECEIVE, end)
        robot = self._soonest(start)
        its = self.world.robots[robot]
        charge = [Stop(f"{name} charge", None, its.home)] if self._must_charge(its) else []
        self._give(robot, [*charge, load, receive])
        raw = self._forecast()[receive.key]
        self.promises.make(receive.key, self.world.now_s, Basis.TIMETABLE, raw, self._by_map(start, end))

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
        assert found is not None, "there is always a timetable"
        left = iter(range(ROUNDS))
        whole = Timetable(found.journeys, found.cost_s, tuple(tasks))
        better = improve(self.network, tasks, whole, self.rng, lambda: next(left, None) is not None)
        self.world.journeys = dict(better.journeys)

    def _tasks(self) -> dict[str, Any]:
        durations = self.promises.durations
        return self.world.believed(
            lambda stop: sum(CHARGE_S) / 2 if stop.kind is None else durations.quantile_s(self._of(stop), 0.5),
            lambda lane: durations.quantile_s(corridor(lane), 0.5),
        )

    def _of(self, stop: Stop) -> Thing:
        assert stop.kind is not None
        return _handling(stop.kind, self.world.now_s)

    def _forecast(self) -> dict[str, Interval]:
        tasks, now_s = self._tasks(), self.world.now_s
        journeys = retimed(self.network, tasks, self.world.journeys)
        stops = {stop.key: stop for robot in self.world.robots.values() for stop in robot.stops}

        def handling_s(goal: Goal) -> float:
            stop = stops[goal.key]
            lasted_s = max(0.0, now_s - stop.begun_s)
            if stop.kind is None:
                return max(60.0, self.rng.uniform(*CHARGE_S) - lasted_s)
            return self.promises.durations.draw_s(self._of(stop), self.rng, lasted_s) - lasted_s

        return forecast(self.network, tasks, journeys, now_s, self.promises.chance(self.rng, now_s, handling_s))

    def _by_map(self, start: int, end: int) -> Interval:
        """As `app/orders/window.py` has it, with the middle in the middle."""
        way_s = self.network.shortest_s[start][end]
        coming_s = max(self.network.shortest_s[robot.home][start] for robot in self.world.robots.values())
        first_s, last_s = way_s + HANDOVER_S, 2 * (way_s + coming_s + HANDOVER_S)
        return Interval(first_s, (first_s + last_s) / 2, last_s)


def _handling(kind: Kind, now_s: float) -> Thing:
    return handling(kind, is_attended=is_attended(now_s), assumed_s=HANDOVER_S)


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
    its = Study(rng, network)
    pace = {(at, back): rng.uniform(*PACE) for at in range(len(network.corridors)) for back in (0, 1)}
    homes = [network.number_of(post.name) for post in campus.docks()]
    fleet = {f"r{number}": homes[number % len(homes)] for number in range(robots)}
    there = {name: Robot(home, Start(home, True, 0.0, 0.0)) for name, home in fleet.items()}
    its.world = World(network, there, Truth(rng, pace), its.promises.drove, its.handled, its.promises.came)
    first = first_plan(network, its.world.believed(lambda _: 0.0, lambda lane: lane.travel_s), rng)
    assert first is not None, "everybody is at home"
    its.world.journeys = dict(first.journeys)
    demand = Random(1000 + seed)  # the same whatever the robots do
    for number, at_s in enumerate(arrivals(demand, days)):
        its.world.advance(at_s)
        its.place(f"o{number}", *demand.sample(range(len(network.posts)), 2))
    its.world.advance(its.world.now_s + 12 * HOUR_S)
    return its
