"""The stops of one robot: what may be taken from them, and where one more order fits in and what that costs.

Costs here are estimates on empty corridors; the schedule decides in the end.
"""

from collections.abc import Collection
from dataclasses import dataclass
from itertools import accumulate
from math import inf
from typing import Final, NamedTuple

from fleet.assignment.problem import AssignmentProblem, OpenOrder, RobotAtWork, Route, Rules

_Seconds = tuple[tuple[float, ...], ...]


class Fit(NamedTuple):
    """The best places for the two stops of an order: before which stops of the route it is loaded and given."""

    cost_s: float
    load_at: int
    give_at: int


NO_FIT: Final = Fit(inf, -1, -1)


def with_order(route: Route, order: OpenOrder, fit: Fit) -> Route:
    load, give = order.stops
    return (*route[: fit.load_at], load, *route[fit.load_at : fit.give_at], give, *route[fit.give_at :])


def without(route: Route, orders: Collection[str]) -> Route:
    return tuple(stop for stop in route if stop.order not in orders) if orders else route


def movable(robot: RobotAtWork, route: Route) -> list[str]:
    """The orders of a route that are not loaded, and whose loading has not begun."""
    return [stop.order for stop in route[robot.begun :] if stop.change > 0]


def orders_of(route: Route) -> set[str]:
    return {stop.order for stop in route if stop.order}


def room(problem: AssignmentProblem, name: str, route: Route) -> int:
    """Return the number of orders that a robot may still be given."""
    robot = problem.robots[name]
    return robot.capacity + problem.rules.ahead - len(orders_of(route)) if robot.accepts else 0


@dataclass(slots=True)
class Line:
    """A route made ready for many questions: before stop i the robot is at `posts[i]`, which it leaves at `leaves_s[i]`
    from now with `aboard[i]` items; the stops from i on give mail of `weights[i]` altogether.

    Nothing is put in before stop `first`. `spare_s`: driving that the charge allows beyond this route and the way home.
    """

    shortest_s: _Seconds
    rules: Rules
    now_s: float
    posts: list[int]
    leaves_s: list[float]
    aboard: list[int]
    weights: list[float]
    first: int
    capacity: int
    home: int | None
    spare_s: float

    def best_fit(self, order: OpenOrder) -> Fit:
        """The cheapest pair of places; of equal ones the latest, so that what comes first stays as it is."""
        best = NO_FIT
        for load_at in range(self.first, len(self.posts)):
            if self.aboard[load_at] < self.capacity:
                found = self._loaded_at(order, load_at)
                if found.cost_s <= best.cost_s:
                    best = found
        return best

    def _loaded_at(self, order: OpenOrder, load_at: int) -> Fit:
        shortest_s, posts = self.shortest_s, self.posts
        load, (give_post, give_s, *_) = order.load, order.give
        there_s = shortest_s[posts[load_at]][load.post]
        wait_s = max(0.0, load.not_before_s - self.now_s - self.leaves_s[load_at] - there_s)
        loaded_s = there_s + wait_s + load.handling_s
        delay_s = loaded_s + self._on_s(load.post, load_at)
        given_s = loaded_s + shortest_s[load.post][give_post] + give_s
        best = NO_FIT
        for give_at in range(load_at, len(posts)):
            if self.aboard[give_at] >= self.capacity:
                break
            if give_at > load_at:
                given_s = delay_s + shortest_s[posts[give_at]][give_post] + give_s
            longer_s = given_s + self._on_s(give_post, give_at)
            driven_s = longer_s - wait_s - load.handling_s - give_s
            if driven_s + self._way_home_s(give_post, give_at) <= self.spare_s:
                delayed_s = self._delayed_s(load_at, delay_s, give_at, longer_s)
                latency_s = delayed_s + order.weight * (self.leaves_s[give_at] + given_s)
                cost_s = longer_s + self.rules.driving * driven_s + latency_s
                if cost_s <= best.cost_s:
                    best = Fit(cost_s, load_at, give_at)
        return best if best.cost_s < inf else NO_FIT

    def _on_s(self, post: int, at: int) -> float:
        """Return the extra way behind a stop that is put in at `at`; the way to that stop is not counted."""
        if at + 1 == len(self.posts):
            return 0.0
        following = self.posts[at + 1]
        return self.shortest_s[post][following] - self.shortest_s[self.posts[at]][following]

    def _way_home_s(self, post: int, at: int) -> float:
        if at + 1 < len(self.posts) or self.home is None:
            return 0.0
        return self.shortest_s[post][self.home] - self.shortest_s[self.posts[at]][self.home]

    def _delayed_s(self, load_at: int, delay_s: float, give_at: int, longer_s: float) -> float:
        """By how much mail of other orders is given later, by weight."""
        return (self.weights[load_at] - self.weights[give_at]) * delay_s + self.weights[give_at] * longer_s


def line(problem: AssignmentProblem, name: str, route: Route) -> Line:
    """Nothing is put before stops that have begun, nor before those of an order that is overdue."""
    robot = problem.robots[name]
    posts = [robot.start.post, *(stop.goal.post for stop in route)]
    items = sum(1 for order in orders_of(route) if not any(stop.order == order and stop.change > 0 for stop in route))
    overdue = [at + 1 for at, stop in enumerate(route) if stop.order and problem.is_overdue(stop.order)]
    home_s = 0.0 if robot.home is None else problem.network.shortest_s[posts[-1]][robot.home]
    drives_s = inf if robot.goes_beyond and not orders_of(route) else robot.drives_s
    return Line(
        problem.network.shortest_s,
        problem.rules,
        problem.now_s,
        posts,
        leaves_s(problem, name, route),
        list(accumulate((stop.change for stop in route), initial=items)),
        _weights(problem, route),
        max(robot.begun, *overdue, 0),
        robot.capacity,
        robot.home,
        drives_s - problem.drive_s(posts[0], route) - home_s if drives_s < inf else inf,
    )


def leaves_s(problem: AssignmentProblem, name: str, route: Route) -> list[float]:
    """Return the seconds until the robot has done with its place, and with each stop, on empty corridors."""
    start = problem.robots[name].start
    at_s, post = max(0.0, start.ready_s - problem.now_s), start.post
    leaves = [at_s]
    for stop in route:
        at_s = max(at_s + problem.network.shortest_s[post][stop.goal.post], stop.goal.not_before_s - problem.now_s)
        at_s, post = at_s + stop.goal.handling_s, stop.goal.post
        leaves.append(at_s)
    return leaves


def _weights(problem: AssignmentProblem, route: Route) -> list[float]:
    """Of the mail that is given from each stop on; nothing behind the last."""
    given = [weight_of(problem, stop.order) if stop.change < 0 else 0.0 for stop in route]
    return [*list(accumulate(reversed(given), initial=0.0))[::-1]]


def weight_of(problem: AssignmentProblem, order: str) -> float:
    known = problem.orders.get(order)
    return 1.0 if known is None else known.weight
