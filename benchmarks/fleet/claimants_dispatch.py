"""Dispatch on a simulated campus: the nearest order for a free robot, or the product's planner.

Goals have the key of their order: "17 load", "17 give".
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from random import Random
from statistics import mean
from typing import TYPE_CHECKING

from benchmarks.fleet.demand import HANDLING_S, Order
from benchmarks.fleet.planned import so_many
from fleet.assignment.adopting import Able, adopt, problem_of
from fleet.assignment.deciding import decide
from fleet.assignment.improving import improved
from fleet.assignment.problem import OpenOrder, Rules
from fleet.schedule.journey import Goal

if TYPE_CHECKING:
    from benchmarks.fleet.claimants import Campus, Robot

Dispatch = Callable[["Campus", "Robot"], bool]
"""A robot has nothing to do. Whether it has now."""


def number_of(goal: Goal) -> int:
    return int(goal.key.split()[0])


def nearest(campus: "Campus", robot: "Robot") -> bool:
    """The nearest that waits; or the oldest, if that has waited too long, or will have before this robot has done."""
    way_s = campus.network.shortest_s
    waiting = sorted(campus.demand.waiting, key=lambda order: (way_s[robot.post][order.start], order.number))
    oldest = min(waiting, key=lambda order: order.placed_s)
    trips_s = mean([one.trip_s for one in campus.delivered] or [0.0])
    order = oldest if campus.now_s + trips_s - oldest.placed_s > campus.age_limit_s else waiting[0]
    if not campus.controller.give(robot.name, goals := list(_goals(order)), campus.now_s, rounds=0):
        campus.refused += 1
        return False
    robot.goals = goals
    campus.note_taken([order.number])
    return True


@dataclass
class Planner:
    """The planner, with some rounds of improvement for each decision."""

    rng: Random
    rounds: int = 3
    open: dict[int, OpenOrder] = field(default_factory=dict)

    def __call__(self, campus: "Campus", robot: "Robot") -> bool:
        self._note_orders(campus)
        able = {one.name: Able(begun=int(one.handles)) for one in campus.robots.values() if not one.off}
        taken_away = {number_of(goal) for one in campus.robots.values() if one.off for goal in one.goals}
        orders = {order.id: order for number, order in self.open.items() if number not in taken_away}
        rules = Rules(age_limit_s=campus.age_limit_s)
        decision = decide(problem_of(campus.controller, able, orders, campus.now_s, rules))
        if decision is not None:
            decision = improved(decision, self.rng, so_many(self.rounds)())
        if decision is None or not adopt(campus.controller, decision, able, campus.now_s):
            campus.refused += 1
            return False
        for one in campus.robots.values():
            if not one.off:
                one.goals = list(campus.controller.goals(one.name))
        campus.note_taken(self._carried(campus.robots.values()))
        return bool(robot.goals)

    def _note_orders(self, campus: "Campus") -> None:
        for order in campus.demand.waiting:
            if order.number not in self.open:
                load, give = _goals(order)
                self.open[order.number] = OpenOrder(str(order.number), load, give, order.placed_s)
        for number, order in list(self.open.items()):
            if order.give.key in campus.served:
                del self.open[number]
            elif order.load.key in campus.served and not order.loaded:
                self.open[number] = replace(order, loaded=True)

    def _carried(self, robots: Iterable["Robot"]) -> list[int]:
        return [number_of(goal) for robot in robots for goal in robot.goals]


def _goals(order: Order) -> tuple[Goal, Goal]:
    load, give = (f"{order.number} {what}" for what in ("load", "give"))
    return Goal(order.start, HANDLING_S, key=load), Goal(order.end, HANDLING_S, key=give)
