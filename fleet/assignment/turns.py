"""One robot with the orders that could come in turn once it has done what it has: what each place would cost.

Ways are as long as on empty corridors. What a robot has is done when the schedule says. What its charge does not last
for comes after a charge.
"""

from collections.abc import Iterator, Sequence
from math import inf
from typing import Final, NamedTuple

from fleet.assignment.cost import latency_s, later_by_a_second_s
from fleet.assignment.problem import AssignmentProblem, OpenOrder, Route
from fleet.assignment.routes import NO_FIT, Fit, leaves_s, line, room, with_order

CHARGES_S: Final = 3600.0
"""Assumed, for the way to a dock and the charge between two orders; with that it does all that is looked at here."""


class Waiting(NamedTuple):
    """An order made ready for many questions; times from now on. `takes_s`: from its first stop to its end."""

    order: OpenOrder
    load: int
    give: int
    soonest_s: float
    takes_s: float
    way_s: float
    waited_s: float


def waiting(problem: AssignmentProblem, order: OpenOrder) -> Waiting:
    load, give = order.load, order.give
    way_s = problem.network.shortest_s[load.post][give.post]
    takes_s = load.handling_s + way_s + give.handling_s
    soonest_s, waited_s = load.not_before_s - problem.now_s, problem.now_s - order.since_s
    return Waiting(order, load.post, give.post, soonest_s, takes_s, way_s, waited_s)


_At = tuple[float, int, float, float]
"""Behind some of the turns: when and where, what they have cost, and for how many seconds of driving the charge
lasts."""
Place = Fit | int
"""Between the stops of the route, or before so many of the turns."""


class Turns:
    """`route`: what the robot has and takes along; `behind`: the orders in turn after that."""

    def __init__(self, problem: AssignmentProblem, name: str, route: Route) -> None:
        self.name = name
        self._problem, self._robot = problem, problem.robots[name]
        self._shortest_s = problem.network.shortest_s
        self._weights = problem.rules.late, problem.rules.late_after_s, problem.rules.driving
        self._late_s = 0.0
        self._takes(route)
        if (late_s := self._later_than_alone(route)) != 0.0:
            self._late_s = late_s
            self._takes(route)
        self._line(())

    def _later_than_alone(self, route: Route) -> float:
        """By how much the schedule has it done later than on empty corridors."""
        kept = self._problem.kept
        if not route or kept is None or kept.goals.get(self.name) != tuple(stop.goal for stop in route):
            return 0.0
        done_s = kept.schedule.journeys[self.name].done_s - self._problem.now_s
        return done_s - self._begins[0]

    def _takes(self, route: Route) -> None:
        problem, robot = self._problem, self._robot
        self.route, self.room = route, room(problem, self.name, route)
        self.route_s, at_s = self._route_s(route)
        self._begins = self._behind(route, at_s)
        self._goes_along = line(problem, self.name, route) if self.room > 0 and route and robot.capacity > 1 else None

    def _behind(self, route: Route, at_s: float) -> _At:
        start = self._robot.start.post
        spare_s = self._robot.drives_s - self._problem.drive_s(start, route)
        return at_s, route[-1].goal.post if route else start, 0.0, spare_s

    def done_s(self, route: Route) -> float:
        """When it has done these stops, in seconds from now."""
        if route == self.route:
            return self._begins[0]
        return leaves_s(self._problem, self.name, route)[-1] + self._late_s

    def _route_s(self, route: Route) -> tuple[float, float]:
        """What these stops cost, and when they are done."""
        problem, leaves = self._problem, leaves_s(self._problem, self.name, route)
        cost_s = problem.rules.driving * problem.drive_s(self._robot.start.post, route)
        cost_s += sum(latency_s(problem.rules, order.weight, age_s) for order, age_s in self._ages_s(route, leaves))
        return cost_s, leaves[-1] + self._late_s

    def _ages_s(self, route: Route, leaves: Sequence[float]) -> Iterator[tuple[OpenOrder, float]]:
        """The orders that these stops give, and how long each has waited then."""
        orders, now_s = self._problem.orders, self._problem.now_s
        for stop, at_s in zip(route, leaves[1:], strict=True):
            if stop.change < 0 and stop.order in orders:
                yield orders[stop.order], at_s + self._late_s + now_s - orders[stop.order].since_s

    def _line(self, behind: Sequence[Waiting]) -> None:
        self.behind = tuple(behind)
        self._at = [self._begins]
        for one in self.behind:
            self._at.append(self._after(self._at[-1], (one,)))

    def _after(self, at: _At, turns: Sequence[Waiting]) -> _At:
        at_s, post, cost_s, spare_s = at
        late, late_after_s, driving, shortest_s, home = *self._weights, self._shortest_s, self._robot.home
        for order, load, give, soonest_s, takes_s, way_s, waited_s in turns:
            there_s = shortest_s[post][load]
            spare_s -= there_s + way_s
            if spare_s < (0.0 if home is None else shortest_s[give][home]):
                at_s, spare_s = at_s + CHARGES_S, inf
            at_s += there_s
            if at_s < soonest_s:  # noqa: PLR1730  # a call takes longer than all else here
                at_s = soonest_s
            at_s += takes_s
            latency_s = at_s + waited_s
            if latency_s > late_after_s:  # as in `cost.latency_s`; this is asked thousands of times for a decision
                latency_s += late * (latency_s - late_after_s)
            cost_s += order.weight * latency_s + driving * (there_s + way_s)
            post = give
        return at_s, post, cost_s, spare_s

    # What it costs.

    @property
    def cost_s(self) -> float:
        return self.route_s + self._at[-1][2]

    @property
    def weight(self) -> float:
        """By how much the cost rises if all is done a second later; 1.0 at least, without any order."""
        given = list(self._ages_s(self.route, leaves_s(self._problem, self.name, self.route)))
        given += [(one.order, at[0] + one.waited_s) for one, at in zip(self.behind, self._at[1:], strict=True)]
        return max(1.0, sum(later_by_a_second_s(self._problem.rules, order.weight, age_s) for order, age_s in given))

    def with_turns_s(self, behind: Sequence[Waiting]) -> float:
        """The cost, if these were in turn."""
        return self.route_s + self._after(self._begins, behind)[2]

    def best_place(self, one: Waiting) -> tuple[float, int]:
        """Where the cost rises least, and by how much; of equal places the last."""
        if not one.order.may_go_with(self.name):
            return inf, 0
        best_s, best, behind = inf, 0, self.behind
        for place in range(len(behind), -1, -1):
            cost_s = self._after(self._at[place], (one, *behind[place:]))[2]
            if cost_s < best_s:
                best_s, best = cost_s, place
        return best_s - self._at[-1][2], best

    def along(self, one: Waiting) -> tuple[float, Fit]:
        """The same between the stops of the route, where it has room for more than one."""
        if self._goes_along is None or not one.order.may_go_with(self.name):
            return inf, NO_FIT
        fit = self._goes_along.best_fit(one.order)
        if not 0 <= fit.load_at < len(self.route):
            return inf, NO_FIT
        route = with_order(self.route, one.order, fit)
        route_s, at_s = self._route_s(route)
        behind_s = self._after(self._behind(route, at_s), self.behind)[2]
        return route_s + behind_s - self.cost_s, fit

    # What changes.

    def put(self, one: Waiting, place: Place) -> None:
        if isinstance(place, Fit):
            self._takes(with_order(self.route, one.order, place))
            self._line(self.behind)
        elif self._robot.capacity > 1 and not self.route and self._can_take(one):
            self._takes(one.order.stops)
            self._line(self.behind)
        else:
            self._line((*self.behind[:place], one, *self.behind[place:]))

    def _can_take(self, one: Waiting) -> bool:
        """Now, without a charge."""
        return self.room > 0 and line(self._problem, self.name, self.route).best_fit(one.order) is not NO_FIT

    def set_behind(self, behind: Sequence[Waiting]) -> None:
        self._line(behind)

    def given_now(self) -> Route:
        """The route with as many of the first in turn as there is room for."""
        route = self.route
        for one in self.behind:
            if room(self._problem, self.name, route) < 1:
                break
            fit = line(self._problem, self.name, route).best_fit(one.order)
            if fit is NO_FIT:
                break
            route = with_order(route, one.order, fit)
        return route
