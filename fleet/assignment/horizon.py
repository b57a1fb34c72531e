"""Which orders robots take next, seen from what all of them will do after that.

Robots with room, and those that are free soonest, get the waiting orders in turn, so that all are given soon. What a
robot has room for now becomes part of its route. The rest is forgotten: no robot and no schedule hears of it.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from math import inf
from random import Random
from typing import Final, NamedTuple

from fleet.assignment.cost import SLACK_S, latency_s
from fleet.assignment.problem import AssignmentProblem, OpenOrder, Route, Routes
from fleet.assignment.turns import Place, Turns, Waiting, waiting
from fleet.schedule.planning import Schedule

SOONEST: Final = 6
"""So many robots without room are looked at."""
MORE: Final = 12
"""So many orders come in turn beyond what there is room for; the others are too far away to matter now."""
LOOKS: Final = 200
"""After so many looks at places for what is in turn already no more is begun."""
MOST_REGRET_S: Final = 600.0
"""An order that only one robot can have does not come before everything else."""
NOT_SOON_S: Final = 4 * 3600.0
"""Assumed until an order that comes in no turn is given."""
BLURS_S: Final = (60.0, 300.0, 900.0)
"""Up to one of these an order with a robot costs more than it does, where another answer is wanted."""


class Outlook(NamedTuple):
    """`routes`: what robots have and are given now. `cost_s`: of everything looked at, on empty corridors; `done_s`:
    when robots that have something to do have done it there, added up, each with its weight. `comes`: the robot that
    each order waits for. `weights`: by robot, what it costs if that is done a second later."""

    routes: dict[str, Route]
    cost_s: float
    done_s: float
    comes: Mapping[str, str]
    weights: Mapping[str, float]

    def cost_of(self, schedule: Schedule) -> float:
        """Return the cost with this schedule of the routes, in which robots wait for each other."""
        return self.cost_s + schedule.cost_s - self.done_s

    def allows(self, cost_s: float) -> float:
        """Return how much the schedule may cost, so that everything together costs no more than this."""
        return cost_s - self.cost_s + self.done_s


def look_ahead(
    problem: AssignmentProblem,
    routes: Routes,
    orders: Iterable[OpenOrder],
    noise: Random | None = None,
    had: Mapping[str, str] | None = None,
) -> Outlook:
    """With `noise` the costs are taken not quite as they are, so that another answer comes out. An order that a robot
    `had` stays with it where no robot has room for it now."""
    all_turns = {name: Turns(problem, name, route) for name, route in routes.items()}
    horizon = _Horizon(problem, _looked_at(problem, all_turns), noise)
    left = horizon.give([waiting(problem, order) for order in orders])
    horizon.improve()
    weights = {name: turns.weight for name, turns in all_turns.items()}
    given = {name: turns.given_now() for name, turns in all_turns.items()}
    placed = {stop.order for route in given.values() for stop in route}
    for order, name in (had or {}).items():
        if order not in placed:
            given[name] = (*given[name], *problem.orders[order].stops)
            placed.add(order)
    behind = [(one.order.id, turns.name) for turns in all_turns.values() for one in turns.behind]
    return Outlook(
        given,
        sum(turns.cost_s for turns in all_turns.values()) + sum(_not_soon_s(problem, one) for one in left),
        sum(weights[name] * (problem.now_s + all_turns[name].done_s(route)) for name, route in given.items() if route),
        {order: name for order, name in behind if order not in placed},
        weights,
    )


def _looked_at(problem: AssignmentProblem, turns: Mapping[str, Turns]) -> list[Turns]:
    able = [one for name, one in turns.items() if problem.robots[name].accepts]
    busy = sorted((one for one in able if one.room < 1), key=lambda one: (one.done_s(one.route), one.name))
    return [*(one for one in able if one.room > 0), *busy[:SOONEST]]


def _not_soon_s(problem: AssignmentProblem, one: Waiting) -> float:
    return latency_s(problem.rules, one.order.weight, NOT_SOON_S + one.waited_s)


class _Best(NamedTuple):
    """The cheapest place of an order, and the cheapest with another robot."""

    cost_s: float = inf
    turns: Turns | None = None
    next_s: float = inf
    next_turns: Turns | None = None


@dataclass
class _Row:
    """An order that is in no turn yet. `least_s`: its cost if a robot stood beside it."""

    one: Waiting
    least_s: float
    places: dict[str, tuple[float, Place]] = field(default_factory=dict)
    best: _Best = field(default_factory=_Best)

    def rank(self) -> tuple[float, float, str]:
        """The less, the sooner; of those that cost the same the oldest."""
        order = self.one.order
        if self.best.turns is None:
            return inf, order.since_s, order.id
        regret_s = min(self.best.next_s - self.best.cost_s, MOST_REGRET_S)
        return round(self.best.cost_s - self.least_s - regret_s, 3), order.since_s, order.id

    def find_best(self, turns: Iterable[Turns]) -> None:
        best, best_s, following, next_s = None, inf, None, inf
        for its in turns:
            cost_s = self.places[its.name][0]
            if cost_s < best_s:
                best, best_s, following, next_s = its, cost_s, best, best_s
            elif cost_s < next_s:
                following, next_s = its, cost_s
        self.best = _Best(best_s, best, next_s, following)

    def may_change(self, turns: Turns) -> bool:
        """Tell if the best is to be found anew, now that the places of this robot have changed."""
        best = self.best
        return turns in (best.turns, best.next_turns) or self.places[turns.name][0] < best.next_s


class _Horizon:
    def __init__(self, problem: AssignmentProblem, turns: Sequence[Turns], noise: Random | None) -> None:
        self._problem, self._turns, self._noise = problem, turns, noise
        self._extra_s: dict[tuple[str, str], float] = {}
        self._looks = 0

    def give(self, orders: Sequence[Waiting]) -> list[Waiting]:
        """Regret insertion: next comes the order that costs little now and would cost much more with any other robot.
        Return what is in no turn."""
        self._blur(orders)
        rows = {one.order.id: self._row(one) for one in orders}
        more = MORE + sum(max(0, turns.room) for turns in self._turns)
        while rows and more > 0:
            row = min(rows.values(), key=_Row.rank)
            turns = row.best.turns
            if turns is None:
                break
            turns.put(row.one, row.places[turns.name][1])
            del rows[row.one.order.id]
            more -= 1
            for other in rows.values():
                other.places[turns.name] = self._place(turns, other.one)
                if other.may_change(turns):
                    other.find_best(self._turns)
        return [row.one for row in rows.values()]

    def _blur(self, orders: Sequence[Waiting]) -> None:
        if self._noise is not None:
            most_s = self._noise.choice(BLURS_S)
            pairs = ((one.order.id, turns.name) for one in orders for turns in self._turns)
            self._extra_s = {pair: self._noise.uniform(0.0, most_s) for pair in pairs}

    def _row(self, one: Waiting) -> _Row:
        rules = self._problem.rules
        least_s = latency_s(rules, one.order.weight, one.waited_s + one.takes_s) + rules.driving * one.way_s
        row = _Row(one, least_s, {turns.name: self._place(turns, one) for turns in self._turns})
        row.find_best(self._turns)
        return row

    def _place(self, turns: Turns, one: Waiting) -> tuple[float, Place]:
        place: Place
        cost_s, place = turns.best_place(one)
        along_s, along = turns.along(one)
        if along_s < cost_s:
            cost_s, place = along_s, along
        return cost_s + self._blurred_s(one, turns), place

    def _blurred_s(self, one: Waiting, turns: Turns) -> float:
        return self._extra_s.get((one.order.id, turns.name), 0.0)

    # Better.

    def improve(self) -> None:
        """Orders in turn go elsewhere, or two change places, as long as that is better for all."""
        better = True
        while better and self._looks < LOOKS:
            moved = [self._moves(turns, one) for turns in self._turns for one in turns.behind]
            pairs = combinations([turns for turns in self._turns if turns.behind], 2)
            exchanged = [self._exchanges(one, other) for one, other in pairs]
            better = any(moved) or any(exchanged)

    def _moves(self, turns: Turns, one: Waiting) -> bool:
        """Tell if there was a better place for it, where it is now."""
        before, before_s = turns.behind, turns.cost_s
        turns.set_behind([other for other in before if other is not one])
        best_s = before_s - turns.cost_s + self._blurred_s(one, turns) - SLACK_S
        to, at = None, 0
        for other in self._turns:
            cost_s, place = other.best_place(one)
            cost_s += self._blurred_s(one, other)
            if cost_s < best_s:
                best_s, to, at = cost_s, other, place
        self._looks += len(self._turns)
        if to is None:
            turns.set_behind(before)
            return False
        to.set_behind([*to.behind[:at], one, *to.behind[at:]])
        return True

    def _exchanges(self, one: Turns, other: Turns) -> bool:
        """Tell if an order of each went to the other."""
        before_s = one.cost_s + other.cost_s - SLACK_S
        for at, mine in enumerate(one.behind):
            for there, theirs in enumerate(other.behind):
                if not (mine.order.may_go_with(other.name) and theirs.order.may_go_with(one.name)):
                    continue
                self._looks += 1
                ones = [*one.behind[:at], theirs, *one.behind[at + 1 :]]
                others = [*other.behind[:there], mine, *other.behind[there + 1 :]]
                after_s = one.with_turns_s(ones) + other.with_turns_s(others)
                after_s += self._blurred_s(theirs, one) + self._blurred_s(mine, other)
                after_s -= self._blurred_s(mine, one) + self._blurred_s(theirs, other)
                if after_s < before_s:
                    one.set_behind(ones)
                    other.set_behind(others)
                    return True
        return False
