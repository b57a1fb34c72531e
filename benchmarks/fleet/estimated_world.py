"""A simulated campus for the study of estimates: robots carry a schedule out in durations that are unknown before.

What is true is drawn here: each corridor has a pace of its own, robots fail in corridors, people come sooner in office
hours. The estimates see what a service would see: when a corridor was entered and left, and a stop begun and done.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from math import inf
from random import Random
from typing import Final

from fleet.eta.durations import Kind
from fleet.schedule.execution import retimed
from fleet.schedule.journey import Goal, Journey, Leg, Start, Task, without_first
from fleet.schedule.network import Lane, Network

HOUR_S: Final = 3600.0
DAY_S: Final = 24 * HOUR_S
OPENS_H, CLOSES_H = 8, 20
OFFICE_H: Final = (9, 17)
RUSH_H: Final = frozenset({9, 10, 14, 15})
CHARGE_AFTER_S: Final = 1.5 * HOUR_S
CHARGE_S: Final = (40 * 60.0, 80 * 60.0)
FAILS: Final = 1 / 200
"""Of all entries into a corridor: the robot stands there until a person has come."""
REPAIR_S: Final = 20 * 60.0


def hour_of(now_s: float) -> float:
    return now_s % DAY_S / HOUR_S


def is_attended(now_s: float) -> bool:
    return OFFICE_H[0] <= hour_of(now_s) < OFFICE_H[1]


@dataclass
class Stop:
    """One goal: `takes_s` is the truth, hidden from the estimates."""

    key: str
    kind: Kind | None
    """None: a charge."""
    post: int
    takes_s: float = 0.0
    begun_s: float = inf


@dataclass
class Robot:
    """Where it is in truth, and what it has to do."""

    home: int
    start: Start
    stops: list[Stop] = field(default_factory=list)
    driven_s: float = 0.0


@dataclass
class Truth:
    """The distributions that durations are drawn from."""

    rng: Random
    pace: Mapping[tuple[int, int], float]

    def travel_s(self, lane: Lane) -> float:
        takes_s = lane.travel_s * self.pace[lane.corridor, lane.backwards] * self.rng.uniform(0.8, 1.2)
        if self.rng.random() < FAILS:
            takes_s += self.rng.expovariate(1 / REPAIR_S)
        return takes_s

    def handling_s(self, kind: Kind | None, now_s: float) -> float:
        if kind is None:
            return self.rng.uniform(*CHARGE_S)
        median_s = 50.0 if is_attended(now_s) else 130.0
        return min(600.0, median_s * self.rng.lognormvariate(0.0, 0.6))


Drove = Callable[[Lane, float], None]
Handled = Callable[[Stop, float], None]
Reached = Callable[[str, float], None]


@dataclass
class World:
    """The robots, the schedule that they carry out, and who is told of what they do."""

    network: Network
    robots: dict[str, Robot]
    truth: Truth
    drove: Drove
    handled: Handled
    reached: Reached
    journeys: dict[str, Journey] = field(default_factory=dict)
    now_s: float = 0.0

    def advance(self, to_s: float) -> None:
        """Until then they go on, in the order of the schedule."""
        tasks = {name: self._true_task(robot) for name, robot in self.robots.items()}
        course = retimed(self.network, tasks, self.journeys, lambda _, lane: self.truth.travel_s(lane))
        for name, journey in course.items():
            self._follow(name, journey, to_s)
        self.now_s = to_s

    def _true_task(self, robot: Robot) -> Task:
        """Return the true task: what has begun ends when it does; how long the rest will take is drawn as it may
        begin."""
        goals = []
        for stop in robot.stops:
            if stop.begun_s == inf:
                stop.takes_s = self.truth.handling_s(stop.kind, self.now_s)
            ends_in_s = stop.takes_s if stop.begun_s == inf else stop.begun_s + stop.takes_s - self.now_s
            goals.append(Goal(stop.post, ends_in_s, key=stop.key))
        return Task(robot.start, tuple(goals), robot.home)

    def _follow(self, name: str, journey: Journey, to_s: float) -> None:
        robot = self.robots[name]
        for number, leg in enumerate(journey.legs):
            if number > 0 and leg.enter_s > to_s:
                break
            if number > 0:
                self.journeys[name] = without_first(self.journeys[name])
            if self._is_under_way(robot, leg, to_s):
                return
            if leg.lane is not None and (number > 0 or robot.start.lane is not None):
                robot.driven_s += leg.arrive_s - leg.enter_s
                self.drove(leg.lane, leg.arrive_s - leg.enter_s)
            begins_s = leg.arrive_s if number > 0 else robot.start.ready_s
            robot.start = Start(leg.post, leg.at_home, to_s, leg.enter_s)
            self._serve(robot, leg, begins_s, to_s)

    def _is_under_way(self, robot: Robot, leg: Leg, to_s: float) -> bool:
        if leg.lane is None or leg.arrive_s <= to_s:
            return False
        robot.start = Start(leg.post, leg.at_home, leg.arrive_s, leg.enter_s, leg.lane, leg.arrive_s)
        return True

    def _serve(self, robot: Robot, leg: Leg, at_s: float, to_s: float) -> None:
        for _ in range(leg.goals):
            stop = robot.stops[0]
            if stop.begun_s == inf:
                if at_s > to_s:
                    return
                stop.begun_s = at_s
                self.reached(stop.key, at_s)
            at_s = stop.begun_s + stop.takes_s
            if at_s > to_s:
                return
            del robot.stops[0]
            self.handled(stop, at_s)

    def add(self, robot: str, *stops: Stop) -> None:
        self.robots[robot].stops += stops

    def believed(self, handling_s: Callable[[Stop], float], travel_s: Callable[[Lane], float]) -> dict[str, Task]:
        """Every robot's task as the service may plan it: who is in a corridor arrives when that usually takes."""
        tasks = {}
        for name, robot in self.robots.items():
            start = robot.start
            if start.lane is not None:
                arrives_s = max(self.now_s + 5.0, start.entered_s + travel_s(start.lane))
                start = replace(start, arrives_s=arrives_s, ready_s=arrives_s)
            goals = tuple(Goal(stop.post, handling_s(stop), key=stop.key) for stop in robot.stops)
            tasks[name] = Task(start, goals, robot.home)
        return tasks
