"""A first decision, at once: each robot with room has what it is to do next, and the schedule serves it all."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import compress
from math import inf
from random import Random

from fleet.assignment.candidates import candidates, waiting_orders
from fleet.assignment.horizon import Outlook, look_ahead
from fleet.assignment.overdue import give_overdue
from fleet.assignment.problem import AssignmentProblem, RobotAtWork, Route, Routes
from fleet.assignment.routes import movable
from fleet.assignment.timing import Timed, time_first


@dataclass(frozen=True, slots=True)
class Decision:
    """An assignment for all robots, in the `problem` without what is no longer right in it.

    `looked_at`: the orders that it was about, beside those that robots had. `cut_off`: stops that no way leads to, by
    robot; they are in no route and in no schedule.
    """

    problem: AssignmentProblem
    timed: Timed
    outlook: Outlook
    cost_s: float
    looked_at: tuple[str, ...] = ()
    cut_off: Mapping[str, Route] = field(default_factory=dict)

    @property
    def routes(self) -> Routes:
        return self.timed.routes

    def robot_of(self) -> dict[str, str]:
        """Which robot has each order that is in a route."""
        return {stop.order: name for name, route in self.routes.items() for stop in route if stop.order}


def decide(problem: AssignmentProblem, rng: Random | None = None) -> Decision | None:
    """The first answer that holds. None only where nothing is kept that holds, and not everybody can come home: robots
    that cannot be planned for must not be in the problem, nor corridors that they block. `rng`: for the order in which
    robots are planned, where nothing else says it."""
    tidy = tidied(problem)
    before = {name: robot.route for name, robot in tidy.robots.items()}
    waiting = waiting_orders(tidy, before)
    first = give_overdue(tidy, before, [order for order in waiting if tidy.is_overdue(order.id)])
    left = waiting if first == before else waiting_orders(tidy, first)
    looked_at = candidates(tidy, first, left)
    outlook = look_ahead(tidy, first, looked_at)
    timed = time_first(tidy, outlook.routes, rng or Random(0), outlook.weights)
    if timed is None:
        return None
    cost_s = outlook.cost_of(timed.schedule)
    cut_off = {name: cut for name, robot in problem.robots.items() if (cut := _cut_off(problem, name, robot))}
    return Decision(tidy, timed, outlook, cost_s, tuple(order.id for order in looked_at), cut_off)


def tidied(problem: AssignmentProblem) -> AssignmentProblem:
    """Robots with those of their stops that are still right: of orders that there are, that they may fetch, and that a
    way leads to."""
    return replace(problem, robots={name: _tidied(problem, name, robot) for name, robot in problem.robots.items()})


def _tidied(problem: AssignmentProblem, name: str, robot: RobotAtWork) -> RobotAtWork:
    gone, unreached = _gone(problem, name, robot), _cut_off(problem, name, robot)
    stays = [stop.order not in gone and stop not in unreached for stop in robot.route]
    if all(stays):
        return robot
    return replace(robot, route=tuple(compress(robot.route, stays)), begun=sum(stays[: robot.begun]))


def _gone(problem: AssignmentProblem, name: str, robot: RobotAtWork) -> set[str]:
    """Orders of its route that it is not to do any more."""
    ended = {stop.order for stop in robot.route if stop.order and stop.order not in problem.orders}
    return ended | {order for order in movable(robot, robot.route) if _is_lost(problem, name, robot, order)}


def _is_lost(problem: AssignmentProblem, name: str, robot: RobotAtWork, order: str) -> bool:
    known = problem.orders.get(order)
    if known is None or not robot.accepts or not known.may_go_with(name):
        return True
    seconds = problem.network.shortest_s[robot.start.post]
    return inf in (seconds[known.load.post], seconds[known.give.post])


def _cut_off(problem: AssignmentProblem, name: str, robot: RobotAtWork) -> Route:
    """Stops that it would have to make, and cannot."""
    seconds, gone = problem.network.shortest_s[robot.start.post], _gone(problem, name, robot)
    return tuple(stop for stop in robot.route if seconds[stop.goal.post] == inf and stop.order not in gone)
