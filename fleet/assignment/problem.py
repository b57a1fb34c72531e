"""The problem of one decision: orders, robots with what they have before them, the network, and the schedule so far."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from typing import NamedTuple

from fleet.schedule.journey import Goal, Start, Task
from fleet.schedule.network import Network
from fleet.schedule.planning import Schedule


class Stop(NamedTuple):
    """One stop of a robot: how the number of items aboard changes there. Without an `order` it is about no mail (a
    charge) and stays where it is in the route."""

    order: str
    goal: Goal
    change: int


Route = tuple[Stop, ...]
Routes = Mapping[str, Route]


@dataclass(frozen=True, slots=True)
class OpenOrder:
    """An order that is not delivered: `load` is where it is fetched, not before `load.not_before_s`, and `give` where
    it goes. The keys of these goals are no other order's.

    `loaded`: it is aboard, so that only the robot that has it can give it. `since_s`: since when it waits. `weight`:
    how much its waiting counts, beside an ordinary order's 1. `wanted`: only these robots may have it; `avoided` may
    not.
    """

    id: str
    load: Goal
    give: Goal
    since_s: float
    weight: float = 1.0
    loaded: bool = False
    wanted: frozenset[str] | None = None
    avoided: frozenset[str] = frozenset()

    def may_go_with(self, robot: str) -> bool:
        return robot not in self.avoided and (self.wanted is None or robot in self.wanted)

    @property
    def stops(self) -> tuple[Stop, Stop]:
        return Stop(self.id, self.load, 1), Stop(self.id, self.give, -1)


@dataclass(frozen=True, slots=True)
class RobotAtWork:
    """A robot and the stops before it, of which the first `begun` stay what they are.

    `accepts`: whether it may be given work (one that is paused or recalled may not, and loses what it has not loaded).
    `drives_s`: for how many seconds of driving its charge lasts, the way home included. `goes_beyond`: with nothing
    else to do it may be given one order that is more than that, and charges on the way; no second one, which would be
    late for a charge that no forecast had.
    """

    start: Start
    home: int | None
    capacity: int = 1
    route: Route = ()
    begun: int = 0
    accepts: bool = True
    drives_s: float = inf
    goes_beyond: bool = False

    def task(self, route: Route, weight: float = 1.0) -> Task:
        return Task(self.start, tuple(stop.goal for stop in route), self.home, weight)


@dataclass(frozen=True, slots=True)
class Kept:
    """The schedule that is carried out, from where the robots are now, and the goals that it serves."""

    goals: Mapping[str, tuple[Goal, ...]]
    schedule: Schedule


@dataclass(frozen=True, slots=True)
class Rules:
    """Weights, beside one second until an order is given. Assumed, except where a figure says otherwise.

    `late`: one second more than `late_after_s`, on top; `driving`: one second of driving, for the battery and for
    corridors that others need. An order older than `age_limit_s` is served next. Robots have up to their capacity and
    `ahead` more orders before them; orders for later count from `early_s` before their time. An order that has a robot
    goes to another only if that gains `worth_s`.
    """

    late: float = 1.0
    late_after_s: float = 3600.0
    driving: float = 1.0
    age_limit_s: float = 6 * 3600.0
    ahead: int = 0
    early_s: float = 600.0
    worth_s: float = 5.0


@dataclass(frozen=True, slots=True)
class AssignmentProblem:
    """Everything that a decision depends on. `orders`: all that are not delivered, those aboard included."""

    now_s: float
    network: Network
    robots: Mapping[str, RobotAtWork]
    orders: Mapping[str, OpenOrder]
    kept: Kept | None = None
    rules: Rules = Rules()

    def is_overdue(self, order: str) -> bool:
        known = self.orders.get(order)
        return known is not None and self.now_s - known.since_s >= self.rules.age_limit_s

    def is_due(self, order: OpenOrder) -> bool:
        """Not left for a later time."""
        return order.load.not_before_s <= self.now_s + self.rules.early_s

    def drive_s(self, start: int, route: Route) -> float:
        """Return the driving time for these stops, on empty corridors."""
        shortest_s, total_s = self.network.shortest_s, 0.0
        for stop in route:
            total_s += shortest_s[start][stop.goal.post]
            start = stop.goal.post
        return total_s
