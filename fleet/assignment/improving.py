"""Better decisions, while there is time: other orders for other robots, each tried with the robots favoured in several
orders, and judged by the same outlook and by what the schedule costs everybody.

Only what has not begun is moved. What is overdue is never given later than it was to be.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from random import Random
from typing import Final

from fleet.assignment.cost import SLACK_S
from fleet.assignment.deciding import Decision
from fleet.assignment.horizon import Outlook, look_ahead
from fleet.assignment.problem import AssignmentProblem, Route
from fleet.assignment.routes import movable, without
from fleet.assignment.timing import Timed, in_order, keeps_promises, overdue_s, sound, tasks_of
from fleet.schedule.planning import Schedule, improve, plan

RESHUFFLES: Final = 6
"""So many orders of robots are tried for each choice of orders."""
MOST_TAKEN_BACK: Final = 3
PATIENCE: Final = 60
"""After so many rounds without anything better there is hardly anything to find."""
LAST_STEP_S: Final = 0.003
"""Between two looks at the time: one robot planned, or one schedule looked at."""

GoOn = Callable[[], bool]


class _NoTimeLeftError(Exception):
    """In the middle of something that is not needed any more."""


def within(budget_s: float, now_s: Callable[[], float]) -> GoOn:
    """For so long by this clock, the last step included."""
    end_s = now_s() + budget_s - LAST_STEP_S
    return lambda: now_s() < end_s


def improved(decision: Decision, rng: Random, go_on: GoOn, in_time: GoOn = lambda: True) -> Decision:
    """The best decision found while it goes on, which is asked before each attempt; the same one if there is none
    better. `in_time` is asked in the middle of attempts, too: one that is not is left."""
    if not any(decision.routes.values()) or decision.timed.refused:
        return decision
    search = _Search(decision, rng, go_on, in_time)
    return search.run()


class _Search:
    def __init__(self, decision: Decision, rng: Random, go_on: GoOn, in_time: GoOn) -> None:
        self._best, self._rng, self._go_on, self._in_time = decision, rng, go_on, in_time
        self._problem = decision.problem
        self._had = {
            order: name for name, robot in self._problem.robots.items() for order in movable(robot, robot.route)
        }
        self._tried: set[tuple[Route, ...]] = set()

    def run(self) -> Decision:
        with suppress(_NoTimeLeftError):
            self._search()
        return self._best

    def _search(self) -> None:
        fruitless = 0
        while fruitless < PATIENCE and self._go_on():
            before_s = self._best.cost_s
            self._reshuffle()
            self._try_other_orders()
            fruitless = 0 if self._best.cost_s < before_s - SLACK_S else fruitless + 1

    def _look_at_the_time(self) -> None:
        if not self._in_time():
            raise _NoTimeLeftError

    def _reshuffle(self) -> None:
        """The same stops with another schedule."""
        timed, pause = self._best.timed, self._look_at_the_time
        network, rounds = self._problem.network, self._some_rounds()
        better = improve(network, timed.tasks, timed.schedule, self._rng, rounds, pause=pause)
        if better is not timed.schedule:
            self._take_if_better(replace(timed, schedule=better), self._best.outlook, 0.0)

    def _some_rounds(self) -> GoOn:
        left = iter(range(RESHUFFLES))
        return lambda: next(left, None) is not None and self._go_on()

    def _try_other_orders(self) -> None:
        """Some orders are taken back, and given anew with costs that are not quite right."""
        self._look_at_the_time()
        routes = self._with_some_taken_back()
        outlook = self._look_ahead(routes)
        key = tuple(outlook.routes[name] for name in sorted(outlook.routes))
        if key in self._tried or outlook.routes == self._best.routes:
            return
        self._tried.add(key)
        worth_s = self._problem.rules.worth_s if self._moves(outlook.routes) else 0.0
        found = self._timed(outlook, worth_s)
        if found is not None:
            self._take_if_better(found, outlook, worth_s)

    def _look_ahead(self, routes: dict[str, Route]) -> Outlook:
        """An order stays with the robot that has it, unless another has room for it now: people were told of one."""
        problem, has = self._problem, self._best.robot_of()
        left = {stop.order for route in routes.values() for stop in route}
        orders = [order for order in dict.fromkeys((*self._best.looked_at, *has)) if order not in left]
        had = {order: has[order] for order in orders if order in has and order in self._had}
        return look_ahead(problem, routes, [problem.orders[order] for order in orders if order], self._rng, had)

    def _with_some_taken_back(self) -> dict[str, Route]:
        """Routes without some orders that could go elsewhere."""
        routes = dict(self._best.routes)
        free = [
            (order, name)
            for name, route in routes.items()
            for order in movable(self._problem.robots[name], route)
            if not self._problem.is_overdue(order)
        ]
        for order, name in self._rng.sample(free, min(len(free), self._rng.randint(1, MOST_TAKEN_BACK))):
            routes[name] = without(routes[name], (order,))
        return routes

    def _moves(self, routes: dict[str, Route]) -> bool:
        """Tell if an order is taken from the robot that had it before this decision, and still had so far."""
        now = {stop.order: name for name, route in routes.items() for stop in route}
        had = self._best.robot_of()
        return any(now.get(order) != name and had.get(order) == name for order, name in self._had.items())

    def _timed(self, outlook: Outlook, worth_s: float) -> Timed | None:
        """The best schedule for these routes, if it makes the whole cheaper."""
        problem, kept, routes = self._problem, self._best.timed, outlook.routes
        tasks = tasks_of(problem, routes, outlook.weights)
        within_s = outlook.allows(self._best.cost_s - worth_s - SLACK_S)
        found: Schedule | None = None
        for order in self._orders([name for name in sorted(tasks) if tasks[name].goals != kept.tasks[name].goals]):
            if not self._go_on():
                break
            schedule = plan(problem.network, tasks, order, kept.schedule.journeys, within_s, self._look_at_the_time)
            if schedule is not None:
                within_s = schedule.cost_s - SLACK_S
                names = in_order(kept.schedule.order, tasks, order)
                found = Schedule(schedule.journeys, schedule.cost_s, names)
        return None if found is None else Timed(routes, tasks, found)

    def _orders(self, new: Sequence[str]) -> Iterator[Sequence[str]]:
        """First only those with other stops round all others; then more and more are planned again."""
        others = [name for name in self._best.timed.schedule.order if name not in new]
        yield new
        for more in range(1, RESHUFFLES):
            together = [*new, *self._rng.sample(others, min(len(others), more))]
            self._rng.shuffle(together)
            yield together

    def _take_if_better(self, timed: Timed, outlook: Outlook, worth_s: float) -> None:
        best, problem, cost_s = self._best, self._problem, outlook.cost_of(timed.schedule)
        if cost_s > best.cost_s - worth_s - SLACK_S or not _keeps_promises(problem, best.timed, timed):
            return
        if sound(problem, timed.tasks, timed.schedule) is not None:
            self._best = replace(best, timed=timed, outlook=outlook, cost_s=cost_s)


def _keeps_promises(problem: AssignmentProblem, before: Timed, after: Timed) -> bool:
    promised_s = overdue_s(problem, before.tasks, before.schedule)
    now_s = overdue_s(problem, after.tasks, after.schedule)
    return promised_s.keys() <= now_s.keys() and keeps_promises(promised_s, now_s)
