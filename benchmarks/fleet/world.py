"""Robots that carry a schedule out, event by event: ways take as long as they take, the order of entry holds.

Who may enter a corridor is decided by the product's own rule (`fleet.schedule.execution`). What happens is looked at
here with nothing of it: a robot that meets another or finds no bay ends the run.
"""

import heapq
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from math import inf
from random import Random
from typing import Final

from fleet.schedule.execution import may_enter, one_behind_the_other, retimed
from fleet.schedule.journey import Goal, Journey, Leg, Start, Task, ready_after, without_first
from fleet.schedule.network import Network
from fleet.schedule.planning import Schedule, first_plan
from fleet.schedule.validation import problems

LATE_S: Final = 5.0
"""A robot that should have arrived is expected so much later."""


class CollisionError(AssertionError):
    """Two robots where there is room for one."""


class DeadlockError(AssertionError):
    """No robot can go on, and nothing will change that."""


class InvalidScheduleError(AssertionError):
    """The independent check refuses a schedule that was made."""


@dataclass
class World:
    """`spread`: a way takes between 1 - spread and 1 + spread times as long as planned. `served_s`: when each goal that
    has a key was, or will be, done."""

    network: Network
    homes: Mapping[str, int]
    rng: Random
    spread: float = 0.0
    now_s: float = 0.0
    entries: int = 0
    schedules: int = 0
    served_s: dict[str, float] = field(default_factory=dict)
    tasks: dict[str, Task] = field(init=False)
    journeys: dict[str, Journey] = field(init=False)
    order: tuple[str, ...] = field(init=False)

    def __post_init__(self) -> None:
        self._arrives_s: dict[str, float] = {}
        self._events: list[float] = []
        self.tasks = {robot: Task(Start(home, True, 0.0, 0.0), (), home) for robot, home in self.homes.items()}
        at_home = first_plan(self.network, self.tasks, Random(0))
        assert at_home is not None
        self.journeys, self.order = dict(at_home.journeys), at_home.order

    def run(self, until_s: float, look: Callable[["World"], float]) -> None:
        """`look` is asked after every event whether something is to be done, and says when it wants to be asked at the
        latest."""
        while self.now_s < until_s:
            self._arrive()
            wanted_s = look(self)
            self._go_on()
            coming_s = self._next_event_s()
            if coming_s == wanted_s == inf and any(len(journey.legs) > 1 for journey in self.journeys.values()):
                raise DeadlockError(f"no robot can go on at {self.now_s:.0f} s")
            self.now_s = min(coming_s, max(wanted_s, self.now_s), until_s)

    def free(self) -> list[str]:
        """Robots that have nothing left to do: they stand, or are on their way home."""
        return [
            robot
            for robot, task in self.tasks.items()
            if not task.goals and (task.start.lane is not None or task.start.ready_s <= self.now_s)
        ]

    def known(self) -> tuple[dict[str, Task], dict[str, Journey]]:
        """Return a planner's knowledge: robots in corridors are expected when the map says, late ones soon, and a
        robot behind a late one not before it."""
        expected = {robot: replace(task, start=self._expected(task.start)) for robot, task in self.tasks.items()}
        tasks = one_behind_the_other(expected)
        return tasks, retimed(self.network, tasks, self.journeys)

    def give(self, robot: str, goals: Iterable[Goal], schedule: Schedule, tasks: Mapping[str, Task]) -> None:
        """These goals and the schedule that serves them. `tasks`: what it was made for."""
        broken = problems(self.network, tasks, schedule.journeys)
        if broken:
            raise InvalidScheduleError(broken[0])
        self.schedules += 1
        self.tasks[robot] = replace(self.tasks[robot], goals=tuple(goals))
        self.journeys, self.order = dict(schedule.journeys), schedule.order
        for name in self.tasks:  # another may be served now where it was to come back later
            self._serve(name)

    def _expected(self, start: Start) -> Start:
        if start.lane is not None:
            arrives_s = start.arrives_s if start.arrives_s > self.now_s else self.now_s + LATE_S
            return replace(start, arrives_s=arrives_s, ready_s=arrives_s)
        return replace(start, ready_s=max(start.ready_s, self.now_s))

    def _next_event_s(self) -> float:
        while self._events and self._events[0] <= self.now_s:
            heapq.heappop(self._events)
        return self._events[0] if self._events else inf

    def _arrive(self) -> None:
        for robot in [robot for robot, at_s in self._arrives_s.items() if at_s <= self.now_s]:
            del self._arrives_s[robot]
            start = replace(self.tasks[robot].start, lane=None, arrives_s=-inf, ready_s=self.now_s)
            self.tasks[robot] = replace(self.tasks[robot], start=start)
            self._serve(robot)

    def _serve(self, robot: str) -> None:
        """Begin what is to be served where it stands."""
        task = self.tasks[robot]
        begun = len(task.goals) - sum(leg.goals for leg in self.journeys[robot].legs[1:])
        if task.start.lane is not None or not begun:
            return
        ready_s = max(task.start.ready_s, self.now_s)
        for goal in task.goals[:begun]:
            assert goal.post == task.start.post, f"{robot} serves elsewhere"
            ready_s = ready_after(ready_s, (goal,))
            if goal.key:
                self.served_s[goal.key] = ready_s
        self.tasks[robot] = replace(task, goals=task.goals[begun:], start=replace(task.start, ready_s=ready_s))
        heapq.heappush(self._events, ready_s)

    def _go_on(self) -> None:
        """Let every robot enter that can, until none can."""
        starts = {robot: task.start for robot, task in self.tasks.items()}
        able = True
        while able:
            able = False
            for robot, journey in self.journeys.items():
                start = starts[robot]
                if len(journey.legs) < 2 or start.lane is not None or start.ready_s > self.now_s:
                    continue
                if may_enter(self.network, starts, self.journeys, robot, self.now_s):
                    self._enter(robot, journey.legs[1])
                    starts[robot] = self.tasks[robot].start
                    able = True

    def _enter(self, robot: str, leg: Leg) -> None:
        self._look_for_others(robot, leg)
        self.entries += 1
        arrive_s = self.now_s
        if leg.lane is not None:
            arrive_s += leg.lane.travel_s
            self._arrives_s[robot] = self._truly_arrives_s(robot, leg)
            heapq.heappush(self._events, self._arrives_s[robot])
            if leg.lane.following_s is not None:
                heapq.heappush(self._events, self.now_s + leg.lane.following_s)
        start = Start(leg.post, leg.at_home, arrive_s, self.now_s, leg.lane, arrive_s if leg.lane else -inf)
        self.tasks[robot] = replace(self.tasks[robot], start=start)
        self.journeys[robot] = without_first(self.journeys[robot])
        if leg.lane is None:
            self._serve(robot)

    def _truly_arrives_s(self, robot: str, leg: Leg) -> float:
        """No robot overtakes: one that follows arrives behind."""
        lane = leg.lane
        assert lane is not None
        arrives_s = self.now_s + lane.travel_s * self.rng.uniform(1 - self.spread, 1 + self.spread)
        if lane.following_s is None:
            return arrives_s
        ahead = [at_s for other, at_s in self._arrives_s.items() if self.tasks[other].start.lane == lane]
        return max(arrives_s, max(ahead, default=-inf) + lane.following_s)

    def _look_for_others(self, robot: str, leg: Leg) -> None:
        others = [task.start for other, task in self.tasks.items() if other != robot]
        if leg.lane is not None:
            inside = [start.lane for start in others if start.lane and start.lane.corridor == leg.lane.corridor]
            if any(leg.lane.following_s is None or lane.backwards != leg.lane.backwards for lane in inside):
                raise CollisionError(f"{robot} meets another in {self.network.corridors[leg.lane.corridor]}")
        standing = sum(start.post == leg.post and not start.at_home for start in others)
        if not leg.at_home and standing >= self.network.bays[leg.post]:
            raise CollisionError(f"{robot} finds no bay at {self.network.posts[leg.post]}")
