"""Why an order waits: one sentence for people, and the data behind it."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from math import inf
from typing import Final

from fleet.assignment.candidates import waiting_orders
from fleet.assignment.deciding import Decision
from fleet.assignment.problem import AssignmentProblem, OpenOrder
from fleet.assignment.routes import room
from fleet.assignment.timing import served_s

Clock = Callable[[float], str]
"""Puts a time of the problem into words."""


@dataclass(frozen=True, slots=True)
class Why:
    """`code` is stable; `robots` are those that it is about, `at_s` when something happens, `before` how many stops or
    orders come first."""

    code: str
    robots: tuple[str, ...] = ()
    at_s: float | None = None
    before: int = 0

    def sentence(self, clock: Clock) -> str:
        words = {
            "robot": self.robots[0] if len(self.robots) == 1 else "one of " + ", ".join(self.robots),
            "at": "" if self.at_s is None else clock(self.at_s),
            "stops": f"{self.before} other {'stop' if self.before == 1 else 'stops'}",
            "orders": f"{self.before} other {'order' if self.before == 1 else 'orders'}",
        }
        return SENTENCES[self.code].format(**words)


SENTENCES: Final[Mapping[str, str]] = {
    "fetched": "{robot} fetches it at about {at}.",
    "fetched_after": "{robot} fetches it at about {at}, after {stops}.",
    "later": "It is to be fetched at {at}.",
    "no_robot": "No robot is connected at the moment.",
    "robot_absent": "It is to go with {robot}, which is not connected.",
    "robot_paused": "The robots that may fetch it take no orders at the moment.",
    "no_way": "No way that is open leads there.",
    "sooner": "{robot} can fetch it sooner than a free one.",
    "charging": "The free robots are charging first.",
    "overdue": "It has waited too long and is fetched next, as soon as a robot has room.",
    "next": "It is fetched as soon as a robot has room.",
    "turn": "Every robot is busy, and {orders} will be fetched first.",
}


@dataclass
class _Looked:
    """The facts that each order is asked for, worked out once."""

    problem: AssignmentProblem
    decision: Decision
    served_s: Mapping[str, float]
    rooms: Mapping[str, int]
    robot_of: Mapping[str, str]
    places: Mapping[str, int] = field(default_factory=dict)


def why_orders_wait(decision: Decision) -> dict[str, Why]:
    """Of every order that is not aboard."""
    problem, timed = decision.problem, decision.timed
    looked = _Looked(
        problem,
        decision,
        served_s(timed.tasks, timed.schedule),
        {name: room(problem, name, route) for name, route in timed.routes.items()},
        decision.robot_of(),
        {order.id: before for before, order in enumerate(waiting_orders(problem, timed.routes))},
    )
    return {order.id: _why(looked, order) for order in problem.orders.values() if not order.loaded}


def _why(looked: _Looked, order: OpenOrder) -> Why:
    problem = looked.problem
    robot = looked.robot_of.get(order.id)
    if robot is not None:
        return _fetched(looked, order, robot)
    if not problem.is_due(order):
        return Why("later", at_s=order.load.not_before_s)
    able = [name for name in problem.robots if order.may_go_with(name)]
    if not able:
        return Why("robot_absent", tuple(sorted(order.wanted))) if order.wanted else Why("no_robot")
    if not any(problem.robots[name].accepts for name in able):
        return Why("robot_paused", tuple(sorted(able)))
    if not _is_reached(problem, order, able):
        return Why("no_way")
    if any(looked.rooms[name] > 0 for name in able):
        comes = looked.decision.outlook.comes.get(order.id)
        if comes is not None and looked.rooms[comes] < 1:
            return Why("sooner", (comes,))
        return Why("charging", tuple(sorted(name for name in able if looked.rooms[name] > 0)))
    if problem.is_overdue(order.id):
        return Why("overdue")
    before = looked.places[order.id]
    return Why("turn", tuple(sorted(able)), before=before) if before else Why("next", tuple(sorted(able)))


def _fetched(looked: _Looked, order: OpenOrder, robot: str) -> Why:
    route = looked.decision.routes[robot]
    before = next(at for at, stop in enumerate(route) if stop.order == order.id)
    at_s = looked.served_s.get(order.load.key)
    begins_s = None if at_s is None else at_s - order.load.handling_s
    return Why("fetched_after" if before else "fetched", (robot,), begins_s, before)


def _is_reached(problem: AssignmentProblem, order: OpenOrder, robots: Iterable[str]) -> bool:
    shortest_s = problem.network.shortest_s
    starts = {problem.robots[name].start.post for name in robots}
    return any(shortest_s[start][order.load.post] < inf for start in starts) and (
        shortest_s[order.load.post][order.give.post] < inf
    )
