"""The quickest journey of one robot round everything that is taken: a search over safe time intervals (SIPP).

A state is a post, the free span of one of its bays, and how many goals are done; of each state only the earliest time
counts, since who is early can wait (Phillips and Likhachev, "SIPP: Safe Interval Path Planning for Dynamic
Environments", ICRA 2011). Here a bay is taken when the corridor before it is entered.
"""

import heapq
from collections.abc import Sequence
from math import inf
from typing import NamedTuple

from fleet.schedule.journey import Goal, Leg, Start
from fleet.schedule.network import Lane, Network
from fleet.schedule.occupied import Occupied, Span


class Found(NamedTuple):
    """`done_s`: when the last goal is served."""

    legs: tuple[Leg, ...]
    done_s: float


class _Node(NamedTuple):
    """Reached by `leg`; `goals` are done, the last at `done_s`, and the stay ends at `until_s` at the latest."""

    leg: Leg
    goals: int
    done_s: float
    until_s: float
    before: "_Node | None"


def find_work(
    network: Network, taken: Occupied, start: Start, goals: Sequence[Goal], home: int | None, within_s: float = inf
) -> Found | None:
    """Find the way that has the last goal done first, and ends where the robot may stay for ever: in a bay that no
    other has asked for, or at home. None if there is none, or none that is done within `within_s`.

    `taken` is what others have; what this robot holds now must not be in it.
    """
    return _Search(network, taken, goals, home, within_s, may_end_in_a_bay=True).run(start)


def find_home(network: Network, taken: Occupied, start: Start, home: int) -> Found | None:
    """The way that is home first."""
    return _Search(network, taken, (), home, inf, may_end_in_a_bay=False).run(start)


class _Search:
    def __init__(
        self,
        network: Network,
        taken: Occupied,
        goals: Sequence[Goal],
        home: int | None,
        within_s: float,
        *,
        may_end_in_a_bay: bool,
    ) -> None:
        self._lanes, self._shortest_s = network.lanes, network.shortest_s
        self._taken = taken
        self._goals = goals
        self._home = home
        self._within_s = within_s
        self._may_end_in_a_bay = may_end_in_a_bay
        self._left_s = _left(network, goals)
        self._ahead: list[tuple[float, float, int, _Node]] = []
        self._pushed = 0
        self._reached: dict[tuple[int, bool, int, float], float] = {}

    def run(self, start: Start) -> Found | None:
        until_s = inf if start.at_home else self._stay_of(start)
        self._reach(start.post, start.at_home, start.lane, start.entered_s, start.arrives_s, start.ready_s, until_s)
        ahead, reached = self._ahead, self._reached
        while ahead:
            node = heapq.heappop(ahead)[3]
            leg = node.leg
            if node.goals == len(self._goals) and self._may_end(leg, node.until_s):
                return _found(node)
            state = (leg.post, leg.at_home, node.goals, node.until_s)
            if reached.get(state, inf) > leg.ready_s:
                reached[state] = leg.ready_s
                self._go_on(node)
        return None

    def _may_end(self, leg: Leg, until_s: float) -> bool:
        """At home; or, while work is planned, wherever it may stay. Beside the bays of another post is not at home."""
        return until_s == inf if self._may_end_in_a_bay else leg.at_home and leg.post == self._home

    def _stay_of(self, start: Start) -> float:
        """Until when the bay that a robot has now stays its own; -inf if it is another's before."""
        for since_s, until_s in self._taken.free(start.post):
            if since_s <= start.ready_s <= until_s:
                return until_s
        return -inf

    def _go_on(self, node: _Node) -> None:
        leg = node.leg
        if leg.post == self._home and not leg.at_home:  # from the bay to its place: no corridor is needed for that
            self._reach(leg.post, True, None, leg.ready_s, leg.ready_s, leg.ready_s, inf, node)
        for lane in self._lanes[leg.post]:
            self._enter(node, lane)

    def _enter(self, node: _Node, lane: Lane) -> None:
        """Everything that is reached through this lane: home, and each span in which a bay is free."""
        windows = self._taken.entries(lane)
        if lane.end == self._home:
            self._arrive(node, lane, windows, (-inf, inf), at_home=True)
        for span in self._taken.free(lane.end):
            if span[0] > node.until_s:
                break
            if span[1] > node.leg.ready_s:
                self._arrive(node, lane, windows, span, at_home=False)

    def _arrive(self, node: _Node, lane: Lane, windows: Sequence[Span], span: Span, *, at_home: bool) -> None:
        """As early as the lane, this stay and the span allow, if that is earlier than what is known."""
        since_s, until_s = span
        ready_s, travel_s = node.leg.ready_s, lane.travel_s
        earliest_s = ready_s if ready_s > since_s else since_s
        known_s = self._reached.get((lane.end, at_home, node.goals, until_s), inf)
        latest_s = min(node.until_s, until_s - travel_s, known_s - travel_s)
        for opens_s, closes_s in windows:
            if closes_s < earliest_s:
                continue
            enter_s = opens_s if opens_s > earliest_s else earliest_s
            if enter_s <= latest_s:
                arrive_s = enter_s + travel_s
                self._reach(lane.end, at_home, lane, enter_s, arrive_s, arrive_s, until_s, node)
            return

    def _reach(
        self,
        post: int,
        at_home: bool,
        lane: Lane | None,
        enter_s: float,
        arrive_s: float,
        ready_s: float,
        until_s: float,
        before: _Node | None = None,
    ) -> None:
        """Serve what can be served, or less: a robot that serves all of it may then be in another's way."""
        served, done_s = (0, ready_s) if before is None else (before.goals, before.done_s)
        goals, done = self._goals, served
        while ready_s <= until_s:
            key = self._key(post, done, ready_s, done_s)
            if key[0] < self._within_s and key[1] < inf:
                self._pushed += 1
                leg = Leg(lane, enter_s, arrive_s, post, at_home, done - served, ready_s)
                heapq.heappush(self._ahead, (*key, self._pushed, _Node(leg, done, done_s, until_s, before)))
            if done == len(goals) or goals[done].post != post:
                break
            goal = goals[done]
            ready_s = (ready_s if ready_s > goal.not_before_s else goal.not_before_s) + goal.handling_s
            done, done_s = done + 1, ready_s

    def _key(self, post: int, done: int, ready_s: float, done_s: float) -> tuple[float, float]:
        """No end that is reached from here is better than this: when the last goal is done, then when it is home."""
        way_s = self._shortest_s[post]
        if done < len(self._goals):
            return ready_s + way_s[self._goals[done].post] + self._left_s[done], ready_s
        if self._may_end_in_a_bay or self._home is None:
            return done_s, ready_s
        return done_s, ready_s + way_s[self._home]


def _left(network: Network, goals: Sequence[Goal]) -> list[float]:
    """Of each goal: how long it and all after it take from its post on, on empty corridors."""
    left_s = [0.0] * len(goals)
    following_s, post = 0.0, None
    for at in range(len(goals) - 1, -1, -1):
        on_s = 0.0 if post is None else network.shortest_s[goals[at].post][post]
        following_s += goals[at].handling_s + on_s
        left_s[at], post = following_s, goals[at].post
    return left_s


def _found(node: _Node) -> Found:
    legs = []
    at: _Node | None = node
    while at is not None:
        legs.append(at.leg)
        at = at.before
    return Found(tuple(reversed(legs)), node.done_s)
