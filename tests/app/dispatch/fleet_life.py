"""A fleet that lives: orders come, decisions are made, and a small world carries the schedules out, late as ever."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from random import Random

from fleet.assignment.deciding import Decision, decide
from fleet.assignment.improving import improved
from fleet.assignment.problem import AssignmentProblem, Kept, OpenOrder, RobotAtWork, Route, Rules
from fleet.schedule.execution import retimed
from fleet.schedule.journey import Goal, Start, Task
from fleet.schedule.network import Network
from fleet.schedule.planning import Schedule, first_plan
from fleet.schedule.validation import problems
from tests.fleet.schedule.carried_out import World


def order(number: int, start: int, end: int, since_s: float = 0.0, handling_s: float = 10.0) -> OpenOrder:
    name = f"o{number:03}"
    return OpenOrder(
        name, Goal(start, handling_s, key=f"{name} load"), Goal(end, handling_s, key=f"{name} give"), since_s
    )


def rounds(count: int) -> Callable[[], bool]:
    """Goes on so many times."""
    left = iter(range(count))
    return lambda: next(left, None) is not None


@dataclass
class Life:
    """The fates of orders, and the times promised. Raises AssertionError where something is not as it must be."""

    network: Network
    homes: list[int]
    capacity: int
    rng: Random
    rules: Rules = field(default_factory=Rules)
    improvement: int = 2
    waiting: dict[str, OpenOrder] = field(default_factory=dict)
    aboard: dict[str, str] = field(default_factory=dict)
    given_s: dict[str, float] = field(default_factory=dict)
    routes: dict[str, Route] = field(default_factory=dict)
    world: World = field(init=False)
    schedule: Schedule = field(init=False)

    def __post_init__(self) -> None:
        tasks = {f"r{n}": Task(Start(home, True, 0.0, 0.0), (), home) for n, home in enumerate(self.homes)}
        found = first_plan(self.network, tasks, Random(0))
        assert found is not None
        self.schedule = found
        self.world = World(self.network, tasks, dict(found.journeys), self.rng, slowness=1.5)
        self.routes = dict.fromkeys(tasks, ())

    def problem(self) -> AssignmentProblem:
        now_s = self.world.now_s
        tasks = {
            name: replace(task, start=replace(task.start, ready_s=max(task.start.ready_s, now_s)))
            for name, task in self.world.tasks.items()
        }
        kept = retimed(self.network, tasks, self.world.journeys)
        assert problems(self.network, tasks, kept) == []
        cost_s = sum(kept[name].done_s for name, task in tasks.items() if task.goals)
        robots = {
            name: RobotAtWork(task.start, task.home, self.capacity, self.routes[name]) for name, task in tasks.items()
        }
        schedule = Schedule(kept, cost_s, self.schedule.order)
        goals = {name: task.goals for name, task in tasks.items()}
        return AssignmentProblem(now_s, self.network, robots, dict(self.waiting), Kept(goals, schedule), self.rules)

    def decide(self) -> Decision:
        problem = self.problem()
        first = decide(problem)
        assert first is not None
        best = improved(first, self.rng, rounds(self.improvement))
        for one in (first, best):
            self.check(one)
        assert best.cost_s <= first.cost_s
        self.schedule, self.routes = best.timed.schedule, dict(best.routes)
        self.world.tasks, self.world.journeys = dict(best.timed.tasks), dict(best.timed.schedule.journeys)
        return best

    def check(self, one: Decision) -> None:
        assert not one.timed.refused
        assert problems(self.network, one.timed.tasks, one.timed.schedule.journeys) == []
        placed = [stop.order for route in one.routes.values() for stop in route if stop.change > 0]
        assert len(placed) == len(set(placed)), "an order is with two robots"
        for name, route in one.routes.items():
            assert one.timed.tasks[name].goals == tuple(stop.goal for stop in route)
            aboard = {order for order, robot in self.aboard.items() if robot == name}
            for stop in route:
                assert (stop.change > 0) != (stop.order in aboard), f"{stop.order} is loaded twice or not at all"
                aboard = aboard | {stop.order} if stop.change > 0 else aboard - {stop.order}
                assert len(aboard) <= self.capacity
            assert not aboard, "mail stays aboard"

    def arrives(self, new: OpenOrder) -> None:
        self.waiting[new.id] = new

    def step(self) -> bool:
        """One step of the world, and what has been done in it; whether something was."""
        before = {name: len(task.goals) for name, task in self.world.tasks.items()}
        self.world.step()
        done = False
        for name, task in self.world.tasks.items():
            for stop in self.routes[name][: before[name] - len(task.goals)]:
                done = True
                self._happens(name, stop.order, stop.change)
            self.routes[name] = self.routes[name][before[name] - len(task.goals) :]
        return done

    def _happens(self, robot: str, name: str, change: int) -> None:
        if change > 0:
            self.aboard[name] = robot
            self.waiting[name] = replace(self.waiting[name], loaded=True)
        else:
            assert self.aboard.pop(name) == robot
            self.given_s[name] = self.world.now_s
            del self.waiting[name]
