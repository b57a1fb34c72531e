"""Which free robot takes which waiting order next: rules to compare, executed under the same traffic rules."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from math import inf
from random import Random
from typing import Final, Literal

from benchmarks.fleet.demand import HANDLING_S, Demand, Order
from benchmarks.fleet.world import World
from fleet.schedule.journey import Goal, Journey, Task
from fleet.schedule.planning import Schedule, first_plan, improve, insert, plan

Choice = Literal["first come", "nearest robot", "optimiser", "optimiser of all", "quickest", "least delay"]
AGE_LIMIT_S: Final = 6 * 3600.0


@dataclass(frozen=True)
class Rule:
    """`choice`: the oldest order and the robot that is free longest, or the robot nearest to it; what a route optimiser
    says (`vroom_rule`), of the robots that are free or of all, so that an order may wait for one that is not; or the
    order with which the fleet loses least time, the way to it included or only what robots wait for each other.
    `orders` are tried jointly with `rounds` other orders of planning each. An order older than `age_limit_s` goes
    before all others."""

    choice: Choice
    orders: int = 1
    rounds: int = 0
    age_limit_s: float = AGE_LIMIT_S


@dataclass(frozen=True)
class Trip:
    """An order given to a robot. `alone_s`: how long it would take with no other robot in the way."""

    order: Order
    robot: str
    taken_s: float
    alone_s: float


@dataclass
class _Idea:
    price_s: float
    robot: str
    order: Order
    tasks: dict[str, Task]
    schedule: Schedule


@dataclass
class Assigning:
    """Looks after every event whether a robot is free. `refused`: no schedule was found for any robot."""

    rule: Rule
    demand: Demand
    rng: Random
    trips: list[Trip] = field(default_factory=list)
    refused: int = 0

    def look(self, world: World) -> float:
        self.demand.pass_time(world.now_s)
        free = world.free()
        while free and self.demand.waiting:
            robot = self._assign(world, free)
            if robot is None:
                self.refused += 1
                break
            free.remove(robot)
        return self.demand.next_s

    def _assign(self, world: World, free: Sequence[str]) -> str | None:
        tasks, kept = world.known()
        best: _Idea | None = None
        for robot, order in self._pairs(world, free):
            idea = self._idea(world, tasks, kept, robot, order)
            if idea is not None and (best is None or idea.price_s < best.price_s - 1e-6):
                best = idea
        if best is None:
            return None
        goals = best.tasks[best.robot].goals
        self.trips.append(Trip(best.order, best.robot, world.now_s, _alone_s(world, best.robot, best.order)))
        self.demand.take(best.order, world.now_s)
        world.give(best.robot, goals, best.schedule, best.tasks)
        return best.robot

    def _pairs(self, world: World, free: Sequence[str]) -> Iterable[tuple[str, Order]]:
        """Yield the pairs to consider. An order that has waited too long is the only one."""
        waiting = self.demand.waiting
        oldest = min(waiting, key=lambda order: order.placed_s)
        too_old = world.now_s - oldest.placed_s > self.rule.age_limit_s
        if self.rule.choice == "first come":
            return [(min(free, key=lambda robot: world.tasks[robot].start.ready_s), oldest)]
        if self.rule.choice == "nearest robot":
            return [(min(free, key=lambda robot: _to_s(world, robot, oldest)), oldest)]
        if self.rule.choice == "optimiser":
            return self._of_optimiser(world, free, free)
        if self.rule.choice == "optimiser of all":
            return self._of_optimiser(world, list(world.tasks), free)
        pairs = [(robot, order) for robot in free for order in ([oldest] if too_old else waiting)]
        if self.rule.choice == "quickest":
            pairs.sort(key=lambda pair: (_to_s(world, *pair), pair[1].number))
        return pairs[: self.rule.orders]

    def _of_optimiser(self, world: World, robots: Sequence[str], free: Sequence[str]) -> list[tuple[str, Order]]:
        from benchmarks.fleet.vroom_rule import next_orders

        return [pair for pair in next_orders(world, robots, self.demand.waiting) if pair[0] in free][:1]

    def _idea(
        self, world: World, tasks: dict[str, Task], kept: dict[str, Journey], robot: str, order: Order
    ) -> _Idea | None:
        goals = (Goal(order.start, HANDLING_S), Goal(order.end, HANDLING_S, key=str(order.number)))
        more = {**tasks, robot: Task(tasks[robot].start, goals, tasks[robot].home)}
        found = self._planned(world, more, kept, robot)
        if found is None:
            return None
        rounds = iter(range(self.rule.rounds))
        better = improve(world.network, more, found, self.rng, lambda: next(rounds, None) is not None)
        return _Idea(better.cost_s - self._unpaid_s(world, robot, order), robot, order, more, better)

    def _planned(self, world: World, tasks: dict[str, Task], kept: dict[str, Journey], robot: str) -> Schedule | None:
        order = (*(name for name in world.order if name != robot), robot)
        found = plan(world.network, tasks, [robot], kept) or plan(world.network, tasks, order)
        found = found or insert(world.network, tasks, kept, robot) or first_plan(world.network, tasks, self.rng)
        return found and Schedule(found.journeys, found.cost_s, order)

    def _unpaid_s(self, world: World, robot: str, order: Order) -> float:
        """Return the time that the rule does not hold against an order: it is as long as it is."""
        carrying_s = world.network.shortest_s[order.start][order.end]
        return carrying_s + (_to_s(world, robot, order) if self.rule.choice == "least delay" else 0.0)


def _to_s(world: World, robot: str, order: Order) -> float:
    return world.network.shortest_s[world.tasks[robot].start.post][order.start]


def _alone_s(world: World, robot: str, order: Order) -> float:
    way_s = _to_s(world, robot, order) + world.network.shortest_s[order.start][order.end]
    left_s = world.tasks[robot].start.arrives_s - world.now_s
    return way_s + 2 * HANDLING_S + (left_s if left_s > 0 and left_s < inf else 0.0)
