"""Giving orders to robots: regret insertion. Next comes the order that costs little now and would cost much more with
any other robot."""

from collections.abc import Iterable, Mapping, Sequence
from math import inf
from random import Random
from typing import Final, NamedTuple

from fleet.assignment.cost import order_worth_s
from fleet.assignment.problem import AssignmentProblem, OpenOrder, Route, Routes
from fleet.assignment.routes import NO_FIT, Fit, line, movable, room, with_order, without

MOST_REGRET_S: Final = 600.0
"""An order that only one robot can have does not come before everything else."""


class Choice(NamedTuple):
    """Why a robot has been given an order: what it costs the fleet, and what it would cost with the next best."""

    order: str
    robot: str
    cost_s: float
    next_best: str | None = None
    next_cost_s: float = inf


class Given(NamedTuple):
    routes: dict[str, Route]
    choices: tuple[Choice, ...]


def give_orders(
    problem: AssignmentProblem, routes: Routes, orders: Sequence[OpenOrder], noise: Random | None = None
) -> Given:
    """As many of these orders as there is room for. With `noise` the costs are taken not quite as they are, so that
    another answer comes out."""
    table = _Table(problem, dict(routes), orders, noise)
    choices = []
    while (choice := table.next()) is not None:
        table.give(choice)
        choices.append(choice)
    return Given(table.routes, tuple(choices))


class _Table:
    """The cost of each order with each robot that has room."""

    def __init__(
        self, problem: AssignmentProblem, routes: dict[str, Route], orders: Sequence[OpenOrder], noise: Random | None
    ) -> None:
        self.routes = routes
        self._problem, self._noise = problem, noise
        self._left = {order.id: order for order in orders}
        self._worth_s = {order.id: order_worth_s(problem, order) for order in orders}
        self._fits: dict[str, dict[str, Fit]] = {order.id: {} for order in orders}
        for robot in routes:
            self._look_at(robot)

    def next(self) -> Choice | None:
        """The choice with the least cost less its regret; None if nothing fits anywhere."""
        choices = (choice for order in self._left if (choice := self._best(order)) is not None)
        return min(choices, key=self._rank, default=None)

    def give(self, choice: Choice) -> None:
        order = self._left.pop(choice.order)
        fit = self._fits.pop(choice.order)[choice.robot]
        self.routes[choice.robot] = with_order(self.routes[choice.robot], order, fit)
        self._look_at(choice.robot)

    def _look_at(self, robot: str) -> None:
        if room(self._problem, robot, self.routes[robot]) < 1:
            for fits in self._fits.values():
                fits.pop(robot, None)
            return
        ready = line(self._problem, robot, self.routes[robot])
        for order in self._left.values():
            if order.may_go_with(robot):
                fit = ready.best_fit(order)
                if fit is NO_FIT:
                    self._fits[order.id].pop(robot, None)
                else:
                    self._fits[order.id][robot] = self._blurred(fit)

    def _blurred(self, fit: Fit) -> Fit:
        return fit if self._noise is None else fit._replace(cost_s=fit.cost_s * self._noise.uniform(0.7, 1.3))

    def _best(self, order: str) -> Choice | None:
        best, best_s, next_best, next_s = None, inf, None, inf
        for robot, fit in self._fits[order].items():
            if fit.cost_s < best_s:
                best, best_s, next_best, next_s = robot, fit.cost_s, best, best_s
            elif fit.cost_s < next_s:
                next_best, next_s = robot, fit.cost_s
        return None if best is None else Choice(order, best, best_s, next_best, next_s)

    def _rank(self, choice: Choice) -> tuple[float, str]:
        regret_s = min(choice.next_cost_s - choice.cost_s, MOST_REGRET_S)
        return choice.cost_s - self._worth_s[choice.order] - regret_s, choice.order


def give_overdue(problem: AssignmentProblem, routes: Routes, orders: Iterable[OpenOrder]) -> Given:
    """Orders that have waited too long, the oldest first: behind nothing but what has begun, is aboard, or is overdue
    as well. What the robot that gets one was to fetch otherwise waits again."""
    given, choices = dict(routes), []
    cleared = {robot: _cleared(problem, robot, route) for robot, route in given.items()}
    for order in orders:
        cleared = {robot: route for robot, route in cleared.items() if room(problem, robot, route) > 0}
        if not cleared:
            break
        table = _Table(problem, cleared, [order], None)
        choice = table.next()
        if choice is not None:
            table.give(choice)
            given[choice.robot] = cleared[choice.robot] = table.routes[choice.robot]
            choices.append(choice)
    return Given(given, tuple(choices))


def _cleared(problem: AssignmentProblem, robot: str, route: Route) -> Route:
    return without(route, {order for order in movable(problem.robots[robot], route) if not problem.is_overdue(order)})


def choices_left(choices: Iterable[Choice], routes: Mapping[str, Route]) -> tuple[Choice, ...]:
    """Those that still stand."""
    return tuple(one for one in choices if any(stop.order == one.order for stop in routes[one.robot]))
