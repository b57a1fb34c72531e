"""Which of the waiting orders are looked at for a decision: all cannot be, and need not be.

Those that have waited longest, and near each robot that has room those that begin near. Sorting is all that grows with
the number of orders.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import Final

from fleet.assignment.problem import AssignmentProblem, OpenOrder, Routes
from fleet.assignment.routes import room

LONGEST: Final = 16
NEAR: Final = 3
"""So many at each robot."""


def waiting_orders(problem: AssignmentProblem, routes: Routes) -> list[OpenOrder]:
    """Orders that are in no route and could be, the longest waiting first: overdue ones, then by age and weight."""
    in_routes = {stop.order for route in routes.values() for stop in route}
    left = [
        order
        for order in problem.orders.values()
        if order.id not in in_routes and not order.loaded and problem.is_due(order)
    ]
    left.sort(key=lambda order: rank(problem, order))
    return left


def rank(problem: AssignmentProblem, order: OpenOrder) -> tuple[bool, float, str]:
    """The less, the sooner."""
    if problem.is_overdue(order.id):
        return False, order.since_s, order.id
    return True, -order.weight * (problem.now_s - order.since_s), order.id


def candidates(problem: AssignmentProblem, routes: Routes, waiting: Sequence[OpenOrder]) -> list[OpenOrder]:
    """Of the `waiting`, in their order, those that are looked at."""
    rooms = {name: left for name, route in routes.items() if (left := room(problem, name, route)) > 0}
    chosen = {order.id for order in waiting[: LONGEST + sum(rooms.values())]}
    by_post: dict[int, list[OpenOrder]] = {}
    for order in waiting:
        by_post.setdefault(order.load.post, []).append(order)
    for name in rooms:
        first, route = problem.robots[name].start.post, routes[name]
        for post in {first, route[-1].goal.post if route else first}:
            chosen.update(order.id for order in islice(_near(problem, name, by_post, post), NEAR))
    return [order for order in waiting if order.id in chosen]


def _near(
    problem: AssignmentProblem, robot: str, by_post: Mapping[int, list[OpenOrder]], post: int
) -> Iterator[OpenOrder]:
    """Orders that this robot may have, by how far from the post they begin."""
    seconds = problem.network.shortest_s[post]
    for start in sorted(by_post, key=lambda at: (seconds[at], at)):
        yield from (order for order in by_post[start] if order.may_go_with(robot))
