"""The planner of the fleet (`fleet.assignment`) in the simulated world: a decision whenever a robot is free."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import inf
from random import Random
from time import perf_counter

from benchmarks.fleet.demand import HANDLING_S, Demand, Order, Saturated
from benchmarks.fleet.world import World
from fleet.assignment.deciding import Decision, decide
from fleet.assignment.improving import improved
from fleet.assignment.problem import AssignmentProblem, Kept, OpenOrder, RobotAtWork, Route, Routes, Rules
from fleet.schedule.journey import Goal, Task
from fleet.schedule.planning import Schedule

Budget = Callable[[], Callable[[], bool]]
"""Of one improvement: makes what says whether it goes on."""


@dataclass(frozen=True, slots=True)
class Spent:
    """One decision: how many robots and orders it was about, and what it took."""

    orders: int
    first_s: float
    improvement_s: float
    first_cost_s: float
    cost_s: float


@dataclass
class Planning:
    """`open`: all orders that are not delivered. `refused`: decisions for which no schedule was found."""

    demand: Demand
    rng: Random
    budget: Budget
    capacity: int = 1
    rules: Rules = field(default_factory=Rules)
    keeps_waiting: int = 5
    open: dict[str, OpenOrder] = field(default_factory=dict)
    routes: dict[str, Route] = field(default_factory=dict)
    spent: list[Spent] = field(default_factory=list)
    refused: int = 0
    given: int = 0

    def look(self, world: World) -> float:
        self._note_new(world)
        if len(self.open) > len(_placed(self.routes) & self.open.keys()) and self._has_room(world):
            self.decide(world)
        return self.demand.next_s

    def decide(self, world: World) -> None:
        begun_s = perf_counter()
        first = decide(self.problem(world))
        first_s = perf_counter() - begun_s
        if first is None:
            self.refused += 1
            return
        begun_s = perf_counter()
        best = self.improved(first)
        self.spent.append(Spent(len(self.open), first_s, perf_counter() - begun_s, first.cost_s, best.cost_s))
        self._carry_out(world, best)

    def improved(self, first: Decision) -> Decision:
        return improved(first, self.rng, self.budget())

    def problem(self, world: World) -> AssignmentProblem:
        tasks, journeys = world.known()
        self._note_served(world)
        cost_s = sum(journeys[name].done_s for name, task in tasks.items() if task.goals)
        kept = Kept({name: task.goals for name, task in tasks.items()}, Schedule(journeys, cost_s, world.order))
        robots = {
            name: RobotAtWork(task.start, task.home, self.capacity, self._route(name, task))
            for name, task in tasks.items()
        }
        return AssignmentProblem(world.now_s, world.network, robots, dict(self.open), kept, self.rules)

    def _carry_out(self, world: World, decision: Decision) -> None:
        self.refused += len(decision.timed.refused)
        self.routes = dict(decision.routes)
        tasks = decision.timed.tasks
        for name, task in tasks.items():
            world.tasks[name] = replace(world.tasks[name], goals=task.goals)
        some = next(iter(tasks))
        world.give(some, tasks[some].goals, decision.timed.schedule, tasks)
        if isinstance(self.demand, Saturated):
            self._fill_up(world, self.demand)

    def _route(self, robot: str, task: Task) -> Route:
        """Return the rest of its stops: those that have begun are no goals any more."""
        route = self.routes.get(robot, ())
        return route[len(route) - len(task.goals) :]

    def _note_new(self, world: World) -> None:
        self.demand.pass_time(world.now_s)
        for order in list(self.demand.waiting):
            if order.number >= self.given:
                self.given = order.number + 1
                self.open[str(order.number)] = _open(order, str(order.number))
            if not isinstance(self.demand, Saturated):  # there it is noted once; here one more would come for it
                self.demand.take(order, world.now_s)

    def _note_served(self, world: World) -> None:
        for name, order in list(self.open.items()):
            if order.give.key in world.served_s:
                del self.open[name]
            elif order.load.key in world.served_s and not order.loaded:
                self.open[name] = replace(order, loaded=True)

    def _has_room(self, world: World) -> bool:
        if self.capacity == 1:
            return bool(world.free())
        aboard = {name: {stop.order for stop in self._route(name, task)} for name, task in world.tasks.items()}
        return any(len(orders) < self.capacity for orders in aboard.values())

    def _fill_up(self, world: World, demand: Saturated) -> None:
        """As many wait as should, those given back among them."""
        while len(self.open) - len(_placed(self.routes)) < self.keeps_waiting:
            demand.take(demand.waiting[0], world.now_s)
            self._note_new(world)


def _open(order: Order, name: str) -> OpenOrder:
    load, give = Goal(order.start, HANDLING_S, key=f"{name} load"), Goal(order.end, HANDLING_S, key=f"{name} give")
    return OpenOrder(name, load, give, order.placed_s)


def _placed(routes: Routes) -> set[str]:
    return {stop.order for route in routes.values() for stop in route}


def so_many(rounds: int) -> Budget:
    def begin() -> Callable[[], bool]:
        left = iter(range(rounds))
        return lambda: next(left, None) is not None

    return begin


def delivered(world: World, until_s: float = inf) -> int:
    return sum(1 for key, at_s in world.served_s.items() if key.endswith("give") and at_s <= until_s)
