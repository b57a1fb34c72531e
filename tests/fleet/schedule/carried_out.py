"""A small world that carries schedules out: no robot keeps to the times, all keep to the order of entry."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import inf
from random import Random

from fleet.schedule.execution import may_enter
from fleet.schedule.journey import Journey, Start, Task, ready_after, without_first
from fleet.schedule.network import Network


@dataclass
class World:
    """Robots on their journeys. Ways and stays take up to `slowness` times as long as planned."""

    network: Network
    tasks: dict[str, Task]
    journeys: dict[str, Journey]
    rng: Random
    slowness: float = 3.0
    now_s: float = 0.0

    def run(self) -> None:
        """Run until no robot has a leg left. Raises AssertionError for a deadlock or a collision."""
        while any(len(journey.legs) > 1 for journey in self.journeys.values()):
            self.step()
        self.now_s = max(task.start.ready_s for task in self.tasks.values())  # the last ones arrive
        self._serve()

    def step(self) -> None:
        """One robot enters its next corridor; if none can, time goes on."""
        self._serve()
        able = [robot for robot in self.journeys if self._is_ready(robot) and self._may_enter(robot)]
        if able:
            self.enter(self.rng.choice(able))
        else:
            self._wait()

    def starts(self) -> Mapping[str, Start]:
        return {robot: task.start for robot, task in self.tasks.items()}

    def enter(self, robot: str) -> None:
        task, leg = self.tasks[robot], self.journeys[robot].legs[1]
        arrive_s = self.now_s
        if leg.lane is not None:
            assert all(
                other.start.lane is None
                or other.start.lane.corridor != leg.lane.corridor
                or (leg.lane.following_s is not None and other.start.lane == leg.lane)
                for other in self.tasks.values()
            ), f"{robot} meets another"
            arrive_s += leg.lane.travel_s * self.rng.uniform(1.0, self.slowness)
        start = Start(leg.post, leg.at_home, arrive_s, self.now_s, leg.lane, arrive_s if leg.lane else -inf)
        self.tasks[robot] = replace(task, start=start)
        self.journeys[robot] = without_first(self.journeys[robot])
        standing = sum(1 for other in self.tasks.values() if other.start.post == leg.post and not other.start.at_home)
        assert leg.at_home or standing <= self.network.bays[leg.post], f"{robot} finds no bay"

    def _may_enter(self, robot: str) -> bool:
        return may_enter(self.network, self.starts(), self.journeys, robot, self.now_s)

    def _is_ready(self, robot: str) -> bool:
        return len(self.journeys[robot].legs) > 1 and self.tasks[robot].start.ready_s <= self.now_s

    def _serve(self) -> None:
        """Begin what is to be served where a robot has arrived."""
        for robot, task in self.tasks.items():
            start = task.start
            if start.lane is not None and start.arrives_s <= self.now_s:
                start = replace(start, lane=None, arrives_s=-inf)
            served = len(task.goals) - sum(leg.goals for leg in self.journeys[robot].legs[1:])
            if start.lane is None and served:
                assert all(goal.post == start.post for goal in task.goals[:served]), f"{robot} serves elsewhere"
                start = replace(start, ready_s=ready_after(max(start.ready_s, self.now_s), task.goals[:served]))
                self.tasks[robot] = replace(task, start=start, goals=task.goals[served:])
            else:
                self.tasks[robot] = replace(task, start=start)

    def _wait(self) -> None:
        later = [task.start.ready_s for task in self.tasks.values() if task.start.ready_s > self.now_s]
        following = [
            task.start.entered_s + (task.start.lane.following_s or 0.0)
            for task in self.tasks.values()
            if task.start.lane is not None
        ]
        ahead = [at_s for at_s in (*later, *following) if at_s > self.now_s]
        assert ahead, "no robot can go on and nothing will change that: a deadlock"
        self.now_s = min(ahead)
