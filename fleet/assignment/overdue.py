"""Orders that have waited too long are given before all others, whatever that costs."""

from collections.abc import Iterable

from fleet.assignment.problem import AssignmentProblem, OpenOrder, Route, Routes
from fleet.assignment.routes import NO_FIT, line, movable, room, with_order, without


def give_overdue(problem: AssignmentProblem, routes: Routes, orders: Iterable[OpenOrder]) -> dict[str, Route]:
    """The oldest first: behind nothing but what has begun, is aboard, or is overdue as well. What the robot that gets
    one was to fetch otherwise waits again."""
    given = dict(routes)
    cleared = {robot: _cleared(problem, robot, route) for robot, route in given.items()}
    for order in orders:
        cleared = {robot: route for robot, route in cleared.items() if room(problem, robot, route) > 0}
        if not cleared:
            break
        able = (robot for robot in cleared if order.may_go_with(robot))
        fits = {robot: line(problem, robot, cleared[robot]).best_fit(order) for robot in able}
        robot = min(fits, key=lambda name: fits[name].cost_s, default=None)
        if robot is not None and fits[robot] is not NO_FIT:
            given[robot] = cleared[robot] = with_order(cleared[robot], order, fits[robot])
    return given


def _cleared(problem: AssignmentProblem, robot: str, route: Route) -> Route:
    return without(route, {order for order in movable(problem.robots[robot], route) if not problem.is_overdue(order)})
