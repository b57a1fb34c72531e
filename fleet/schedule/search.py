"""The quickest journey of one robot round everything that is taken: a search over safe time intervals (SIPP).

A state is a post, and how many goals are done. Who is there earlier, and may be there for as long, is not worse off,
since who is early can wait: only the others are looked at (Phillips and Likhachev, "SIPP: Safe Interval Path Planning
for Dynamic Environments", ICRA 2011). Here a bay is taken when the corridor before it is entered.

Where crossings take time a robot either comes in, and can wait, or goes straight on into the next corridor. Then it
cannot wait, but all that it does since it last stood can be later by its `slack_s`.

Of ways that are equally quick the one that is furthest along is looked at first: in a grid there are very many.
"""

import heapq
from collections import defaultdict
from collections.abc import Iterator, Sequence
from math import inf
from typing import Final, NamedTuple

from fleet.schedule.journey import Goal, Leg, Start, standing
from fleet.schedule.network import Lane, Network
from fleet.schedule.occupied import Occupied, Span

_ALWAYS: Span = (-inf, inf)
_ALIKE_DIGITS: Final = 6
"""Of seconds: sums of the same times differ by less."""
_Key = tuple[float, float, float]
_State = tuple[int, bool, int, int | None]
"""The post, if at home, how many goals are done, and the corridor behind one that goes straight on: it may not turn."""


class Found(NamedTuple):
    """`done_s`: when the last goal is served."""

    legs: tuple[Leg, ...]
    done_s: float


class _Node(NamedTuple):
    """Reached by `leg`; `goals` are done, the last at `done_s`, and the bay is free until `until_s` at the latest.

    `passes`: it goes straight on at the end of the leg, which may come later by as much as `slack_s`. `later_s`: by so
    much did everything before this leg come later, back to where the robot last stood, so that it could go on."""

    leg: Leg
    goals: int
    done_s: float
    until_s: float
    before: "_Node | None"
    passes: bool = False
    slack_s: float = inf
    later_s: float = 0.0


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
        self._lanes, self._shortest_s, self._crossing_s = network.lanes, network.shortest_s, network.crossing_s
        self._shut = network.shut
        self._taken = taken
        self._goals = goals
        self._home = home
        self._within_s = within_s
        self._may_end_in_a_bay = may_end_in_a_bay
        self._left_s = _left(network, goals)
        self._ahead: list[tuple[_Key, int, _Node]] = []
        self._pushed = 0
        # When it is there, and until when it may be there: who comes later may be able to stay longer.
        self._reached: defaultdict[_State, list[Span]] = defaultdict(list)

    def run(self, start: Start) -> Found | None:
        until_s = inf if start.at_home else self._stay_of(start)
        self._reach(standing(start), until_s, None)
        if start.lane is not None and self._crossing_s[start.post] and not start.crosses and until_s > -inf:
            self._pass(standing(start), until_s, None, 0.0)
        while self._ahead:
            node = heapq.heappop(self._ahead)[2]
            if node.goals == len(self._goals) and not node.passes and self._may_end(node.leg, node.until_s):
                return _found(node)
            if not self._is_worse(node):
                self._reached[_state_of(node)].append(_span_of(node))
                self._go_on(node)
        return None

    def _is_worse(self, node: _Node) -> bool:
        """Tell if the same state is known with an earlier time, and with one as late."""
        since_s, until_s = _span_of(node)
        known = self._reached.get(_state_of(node), ())
        return any(one[0] <= since_s and one[1] >= until_s for one in known)

    def _push(self, key: _Key, node: _Node) -> None:
        if key[0] < self._within_s and not self._is_worse(node):
            self._pushed += 1
            heapq.heappush(self._ahead, (key, self._pushed, node))

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
        if leg.post == self._home and not leg.at_home and not node.passes:
            self._go_aside(node)
        came_by = leg.lane.corridor if node.passes and leg.lane is not None else None
        for lane in self._lanes[leg.post]:
            if lane.corridor != came_by:
                self._enter(node, lane)

    def _go_aside(self, node: _Node) -> None:
        """From the bay to its place at the same post: no corridor is needed for that."""
        post, ready_s, over_s = node.leg.post, node.leg.ready_s, self._crossing_s[node.leg.post]
        for opens_s, closes_s in self._taken.begins(post):
            if closes_s >= ready_s:
                enter_s = max(opens_s, ready_s)
                if enter_s + over_s <= node.until_s:
                    self._reach(Leg(None, enter_s, enter_s, post, True, 0, enter_s + over_s, over_s), inf, node)
                return

    def _enter(self, node: _Node, lane: Lane) -> None:
        """Everything that is reached through this lane: home, and each span in which a bay is free."""
        end, ready_s, until_s, windows = lane.end, node.leg.ready_s, node.until_s, self._taken.entries(lane)
        crosses = self._crossing_s[lane.start] or self._crossing_s[end]
        arrive = self._cross_and_arrive if crosses else self._arrive
        if end == self._home:
            arrive(node, lane, windows, _ALWAYS, at_home=True)
        for span in self._taken.free(end):
            if span[0] > until_s:
                break
            if span[1] > ready_s:
                arrive(node, lane, windows, span, at_home=False)

    def _arrive(self, node: _Node, lane: Lane, windows: Sequence[Span], span: Span, *, at_home: bool) -> None:
        """As early as the lane, this stay and the span allow, if that is earlier than what is known."""
        since_s, until_s = span
        ready_s, travel_s = node.leg.ready_s, lane.travel_s
        earliest_s = ready_s if ready_s > since_s else since_s
        latest_s = min(node.until_s, until_s - travel_s)
        for opens_s, closes_s in windows:
            if closes_s < earliest_s:
                continue
            enter_s = opens_s if opens_s > earliest_s else earliest_s
            if enter_s <= latest_s:
                arrive_s = enter_s + travel_s
                self._reach(Leg(lane, enter_s, arrive_s, lane.end, at_home, 0, arrive_s), until_s, node)
            return

    def _cross_and_arrive(self, node: _Node, lane: Lane, windows: Sequence[Span], span: Span, *, at_home: bool) -> None:
        """The same over the crossings before the lane and behind it; there it comes in or goes straight on."""
        since_s, until_s = span
        ready_s, out_s, in_s = node.leg.ready_s, self._crossing_s[lane.start], self._crossing_s[lane.end]
        takes_s = out_s + lane.travel_s
        latest_s = min(node.until_s - out_s, until_s - takes_s - in_s, ready_s + node.slack_s)
        fits = self._first_fit(lane, windows, max(ready_s, since_s), latest_s)
        if fits is None:
            return
        enter_s, closes_s = fits
        arrive_s, later_s = enter_s + takes_s, enter_s - ready_s if node.passes else 0.0
        leg = Leg(lane, enter_s, arrive_s, lane.end, at_home, 0, arrive_s + in_s, in_s)
        self._reach(leg, until_s, node, later_s)
        if in_s and not _has_passed(node, lane.end):
            self._pass(leg, until_s, node, min(closes_s, latest_s) - enter_s, later_s)

    def _first_fit(
        self, lane: Lane, windows: Sequence[Span], earliest_s: float, latest_s: float
    ) -> tuple[float, float] | None:
        """The first moment at which the lane may be entered over its first crossing and the second is free at its end,
        and until when that stays so."""
        takes_s = self._crossing_s[lane.start] + lane.travel_s
        wanted = (windows, 0.0), (self._taken.begins(lane.start), 0.0), (self._taken.begins(lane.end), takes_s)
        at_s, tried_s = earliest_s, -inf
        while tried_s < at_s <= latest_s:
            tried_s, until_s = at_s, inf
            for spans, after_s in wanted:
                span = next((one for one in spans if one[1] >= at_s + after_s), None)
                if span is None:
                    return None
                at_s, until_s = max(at_s, span[0] - after_s), min(until_s, span[1] - after_s)
        return (at_s, until_s) if at_s <= latest_s else None

    def _pass(self, leg: Leg, until_s: float, before: _Node | None, slack_s: float, later_s: float = 0.0) -> None:
        """It goes straight on at the end of this leg."""
        served, done_s = (0, leg.ready_s) if before is None else (before.goals, before.done_s)
        if before is not None and before.passes:
            slack_s = min(slack_s, before.slack_s - later_s)
        passing = leg._replace(ready_s=leg.arrive_s, over_s=0.0)
        latest_s = until_s - self._crossing_s[leg.post]
        node = _Node(passing, served, done_s, until_s, before, True, min(slack_s, latest_s - leg.arrive_s), later_s)
        self._push(self._key(leg.post, served, leg.arrive_s, done_s), node)

    def _reach(self, leg: Leg, until_s: float, before: _Node | None, later_s: float = 0.0) -> None:
        """Serve what can be served, or less: a robot that serves all of it may then be in another's way."""
        ready_s, post = leg.ready_s, leg.post
        served, done_s = (0, ready_s) if before is None else (before.goals, before.done_s)
        goals, done = self._goals, served
        while ready_s <= until_s:
            reached = leg if done == served else leg._replace(goals=done - served, ready_s=ready_s)
            node = _Node(reached, done, done_s, until_s, before, False, inf, later_s)
            self._push(self._key(post, done, ready_s, done_s), node)
            if done == len(goals) or goals[done].post != post:
                break
            goal = goals[done]
            ready_s = (ready_s if ready_s > goal.not_before_s else goal.not_before_s) + goal.handling_s
            done, done_s = done + 1, ready_s

    def _key(self, post: int, done: int, ready_s: float, done_s: float) -> _Key:
        """No end that is reached from here is better than this: when the last goal is done, then where it may stay
        first; of a way home when it is there. Among equals: who is done, then who is furthest along."""
        if done < len(self._goals):
            soonest_s = ready_s + self._shortest_s[post][self._goals[done].post] + self._left_s[done]
            return round(soonest_s, _ALIKE_DIGITS), 1.0, -ready_s
        if self._may_end_in_a_bay or self._home is None:
            return done_s, 0.0, ready_s
        return round(ready_s + self._shortest_s[post][self._home], _ALIKE_DIGITS), 0.0, -ready_s


def _state_of(node: _Node) -> _State:
    leg = node.leg
    behind = leg.lane.corridor if node.passes and leg.lane is not None else None
    return leg.post, leg.at_home, node.goals, behind


def _span_of(node: _Node) -> Span:
    ready_s = node.leg.ready_s
    return ready_s, ready_s + node.slack_s if node.passes else node.until_s


def _has_passed(node: _Node | None, post: int) -> bool:
    """Tell if it has been at this post since it last stood: it would go round and round."""
    while node is not None and node.passes:
        if node.leg.post == post:
            return True
        node = node.before
    return node is not None and node.leg.post == post


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
    return Found(tuple(reversed(list(_legs_back(node)))), node.done_s)


def _legs_back(last: _Node) -> Iterator[Leg]:
    at: _Node | None = last
    later_s = 0.0
    while at is not None:
        if not at.passes:
            later_s = 0.0
        yield at.leg if not later_s else _later(at.leg, later_s)
        later_s += at.later_s
        at = at.before


def _later(leg: Leg, by_s: float) -> Leg:
    return leg._replace(enter_s=leg.enter_s + by_s, arrive_s=leg.arrive_s + by_s, ready_s=leg.ready_s + by_s)
