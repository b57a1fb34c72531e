"""Open work and traffic as an assignment problem, for the planner: orders as goals, whose keys are the ids of stops.

What is left out of the problem stays as it is: its stops are then places that a robot goes to anyhow.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Final

from app.core.settings import Settings
from app.dispatch.charge_limits import Charges
from app.dispatch.open_work import OpenWork, OrderNow, StopNow
from app.dispatch.waiting_work import counts_since
from app.models import OrderState, Priority
from app.orders.transitions import MAIL_ABOARD
from fleet.assignment.adopting import Able, problem_of
from fleet.assignment.problem import AssignmentProblem, OpenOrder, Rules
from fleet.schedule.controller import TrafficController
from fleet.schedule.journey import Goal
from protocol.ids import new_id
from protocol.parts import StopAction

WEIGHTS: Final = {Priority.LOW: 0.5, Priority.NORMAL: 1.0, Priority.HIGH: 2.0}
WORTH_S: Final = 60.0
"""An order that has a robot goes to another only if that saves so much: people may have been told of the first."""
NOT_BEGUN: Final = (OrderState.ASSIGNED, OrderState.TO_SENDER)
AGE_LIMIT_S: Final = 6 * 3600.0
"""An order that has waited for so long is fetched next, before all others."""


@dataclass(frozen=True)
class ProblemOfWork:
    """The same for each look: `charges` knows how far robots get."""

    settings: Settings
    charges: Charges

    def of(self, work: OpenWork, traffic: TrafficController, now: datetime, now_s: float) -> AssignmentProblem:
        keys = {name: [goal.key for goal in traffic.goals(name)] for name in traffic.can_be_planned()}
        placed = _Placed(work, traffic, {key for theirs in keys.values() for key in theirs}, self.settings, now, now_s)
        orders = {one.id: one for one in placed.orders()}
        robots = {name: self._able(work, orders, name, keys[name]) for name in keys if name in work.robots}
        # What waits for its time is not in `work` yet, so that no robot comes too early.
        rules = Rules(age_limit_s=AGE_LIMIT_S, worth_s=WORTH_S, early_s=0.0)
        return problem_of(traffic, robots, orders, now_s, rules)

    def _able(self, work: OpenWork, orders: Mapping[str, OpenOrder], name: str, keys: Sequence[str]) -> Able:
        """One that may be given nothing keeps what it has, unless others are to fetch what it has not loaded."""
        robot = work.robots[name]
        capacity = self.settings.robot_capacity - _left_out(work, orders, name, keys)
        if not robot.takes_work:
            return Able(capacity, 0 if robot.gives_away else len(keys), accepts=False)
        theirs = {stop.id: stop for stop in work.stops.get(robot.name, ())}
        begun = [at for at, key in enumerate(keys, start=1) if _has_begun(theirs.get(key))]
        drives_s, goes_beyond = self.charges.drives_s(robot), self.charges.goes_beyond(robot)
        return Able(capacity, max(begun, default=0), True, drives_s, goes_beyond)


def _left_out(work: OpenWork, orders: Mapping[str, OpenOrder], name: str, keys: Sequence[str]) -> int:
    """Count its orders that are not in its route, such as one just given: each takes a place."""
    in_route = {one.id for one in orders.values() if one.give.key in keys}
    return sum(1 for order in work.orders.values() if order.robot == name and order.id not in in_route)


def _has_begun(stop: StopNow | None) -> bool:
    """Tell if it has begun: what a robot does for reasons of its own comes before all that dispatch gives it; nor is a
    stop of no order, to charge or to make room."""
    return stop is None or stop.departed or stop.order_id is None


@dataclass(frozen=True)
class _Placed:
    """Orders at the posts of a network."""

    work: OpenWork
    traffic: TrafficController
    planned: set[str]
    settings: Settings
    now: datetime
    now_s: float

    def orders(self) -> Iterator[OpenOrder]:
        posts = set(self.traffic.network.posts)
        for order in self.work.orders.values():
            if order.from_post in posts and order.to_post in posts:
                found = self._open(order)
                if found is not None:
                    yield found

    def _open(self, order: OrderNow) -> OpenOrder | None:
        if order.state is OrderState.QUEUED:
            return self._order(order, new_id(), new_id())
        robot = self.work.robots.get(order.robot or "")
        if robot is None or not (robot.takes_work or robot.gives_away) or order.is_let_go:
            return None
        stops = {StopAction(stop.action): stop for stop in self.work.of_orders.get(order.id, ())}
        is_planned = all(stop.id in self.planned for stop in stops.values())
        give = stops.get(StopAction.RECEIVE) or stops.get(StopAction.RETURN)
        if give is None or not (is_planned or robot.has_stopped):
            return None
        load = stops.get(StopAction.LOAD)
        if order.state in MAIL_ABOARD and load is None and is_planned:
            return self._order(order, f"{give.id}-loaded", give.id, give.post)
        return self._order(order, load.id, give.id) if order.state in NOT_BEGUN and load is not None else None

    def _order(self, order: OrderNow, load: str, give: str, give_post: str = "") -> OpenOrder:
        number, handling_s = self.traffic.network.number_of, self.settings.assumed_handover_s
        since = counts_since(order.created_at, order.priority)
        avoided = {order.avoided} if order.avoided and not order.wanted else set[str]()
        return OpenOrder(
            order.id,
            Goal(number(order.from_post), handling_s, key=load),
            Goal(number(give_post or order.to_post), handling_s, key=give),
            self.now_s - (self.now - since).total_seconds(),
            WEIGHTS[order.priority],
            loaded=bool(give_post),
            wanted=frozenset({order.wanted}) if order.wanted else None,
            avoided=frozenset(avoided) | self.work.dropping.get(order.id, frozenset()),
        )
