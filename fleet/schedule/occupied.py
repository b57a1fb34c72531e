"""Occupied resources: for how long corridors, crossings and bays are a robot's, and when they are free for another.

All times are seconds of one clock.
"""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from math import inf
from typing import Final, NamedTuple

from fleet.schedule.journey import Leg, Start, stays
from fleet.schedule.network import Lane, Network

Span = tuple[float, float]
ROUNDING_S: Final = 1e-6
"""Behind others a robot keeps the whole clearance, before others so much less is enough: what fitted exactly must still
fit when the same sum is taken in another way."""


_NOBODY_FOLLOWS: Final = -1


class Passage(NamedTuple):
    """One robot's way through a corridor."""

    robot: str
    backwards: int
    enter_s: float
    leave_s: float


class Occupied:
    """Mutable: legs are put in and taken out again, and what is free between them is worked out when it is asked."""

    def __init__(self, network: Network) -> None:
        self._network = network
        self._passages: list[list[Passage]] = [[] for _ in network.corridors]
        self._bays: list[list[tuple[str, float, float]]] = [[] for _ in network.posts]
        self._crossings: list[list[tuple[str, float, float]]] = [[] for _ in network.posts]
        self._corridors_of: defaultdict[str, set[int]] = defaultdict(set)
        self._posts_of: defaultdict[str, set[int]] = defaultdict(set)
        self._entries: dict[tuple[int, int], list[Span]] = {}
        self._free: dict[int, list[Span]] = {}
        self._begins: dict[int, list[Span]] = {}

    def put(self, robot: str, legs: Sequence[Leg], until_s: float = inf) -> None:
        """Put in everything that a robot takes on these legs; the last stay ends at `until_s`."""
        crossing_s = self._network.crossing_s
        for leg, leaves_s in stays(legs):
            lane = leg.lane
            if lane is not None:
                self._pass(robot, lane, leg.enter_s, leg.arrive_s)
                if crossing_s[lane.start]:
                    self.cross(robot, lane.start, leg.enter_s, leg.enter_s + crossing_s[lane.start])
            if leg.over_s:
                self.cross(robot, leg.post, leg.arrive_s, leg.stands_s)
            if not leg.at_home:
                self._stand(robot, leg.post, leg.enter_s, min(leaves_s + crossing_s[leg.post], until_s))

    def hold(self, robot: str, start: Start, until_s: float) -> None:
        """Put in what a robot has for certain: the corridor that it is in, the crossing at its end when it is there,
        and its bay, here until `until_s`."""
        if start.lane is not None:
            self._pass(robot, start.lane, start.entered_s, start.arrives_s)
            self.cross(robot, start.post, start.arrives_s, start.arrives_s + self._network.crossing_s[start.post])
        if not start.at_home:
            self._stand(robot, start.post, start.entered_s, until_s)

    def cross(self, robot: str, post: int, since_s: float, until_s: float) -> None:
        """Put in one move over the crossing of a post, if that takes time."""
        if self._network.crossing_s[post]:
            self._crossings[post].append((robot, since_s, until_s))
            self._posts_of[robot].add(post)
            self._begins.pop(post, None)

    def free_last(self, robot: str, leg: Leg) -> None:
        """The stay that does not end, after this leg: the bay is given back, and all before it stays as it is."""
        if not leg.at_home:
            self._bays[leg.post].remove((robot, leg.enter_s, inf))
            self._free.pop(leg.post, None)

    def go_on(self, robot: str, leg: Leg, further: Sequence[Leg]) -> None:
        """The stay after this leg, which was given back, and the legs behind it."""
        self.put(robot, (leg._replace(lane=None, over_s=0.0), *further))

    def remove(self, robot: str) -> None:
        """Remove everything that this robot has."""
        for corridor in self._corridors_of.pop(robot, ()):
            self._passages[corridor] = [passage for passage in self._passages[corridor] if passage.robot != robot]
            self._forget(corridor)
        for post in self._posts_of.pop(robot, ()):
            self._bays[post] = [bay for bay in self._bays[post] if bay[0] != robot]
            self._crossings[post] = [move for move in self._crossings[post] if move[0] != robot]
            self._free.pop(post, None)
            self._begins.pop(post, None)

    def entries(self, lane: Lane) -> list[Span]:
        """When a lane may be entered, in order. Both ends belong to it."""
        key = (lane.corridor, lane.backwards)
        found = self._entries.get(key)
        if found is None:
            found = self._entries[key] = _gaps(self._shut(lane))
        return found

    def begins(self, post: int) -> list[Span]:
        """When a move over the crossing of this post may begin, in order."""
        found = self._begins.get(post)
        if found is None:
            over_s, clear_s = self._network.crossing_s[post], self._network.clearance_s
            moves = self._crossings[post] if over_s else ()
            shut = [(begin_s - over_s - clear_s + ROUNDING_S, end_s + clear_s) for _, begin_s, end_s in moves]
            found = self._begins[post] = [] if post in self._network.shut else _gaps(sorted(shut))
        return found

    def free(self, post: int) -> list[Span]:
        """Return the intervals in which a bay of this post is free, in order, for a robot that enters the corridor
        before it and is gone within."""
        found = self._free.get(post)
        if found is None:
            found = self._free[post] = _spare(self._bays[post], self._network.bays[post], self._network.clearance_s)
        return found

    def _pass(self, robot: str, lane: Lane, enter_s: float, leave_s: float) -> None:
        backwards = _NOBODY_FOLLOWS if lane.following_s is None else lane.backwards
        self._passages[lane.corridor].append(Passage(robot, backwards, enter_s, leave_s))
        self._corridors_of[robot].add(lane.corridor)
        self._forget(lane.corridor)

    def _stand(self, robot: str, post: int, since_s: float, until_s: float) -> None:
        self._bays[post].append((robot, since_s, until_s))
        self._posts_of[robot].add(post)
        self._free.pop(post, None)

    def _shut(self, lane: Lane) -> list[Span]:
        clear_s, after_s = self._network.clearance_s, lane.following_s
        takes_s = self._network.crossing_s[lane.start] + lane.travel_s
        shut = []
        for _, backwards, enter_s, leave_s in self._passages[lane.corridor]:
            if after_s is not None and backwards == lane.backwards:
                # Behind one that is late no other may arrive too early either.
                late_s = max(enter_s, leave_s - takes_s)
                shut.append((enter_s - after_s + ROUNDING_S, late_s + after_s))
            else:
                shut.append((enter_s - takes_s - clear_s + ROUNDING_S, leave_s + clear_s))
        shut.sort()
        return shut

    def _forget(self, corridor: int) -> None:
        self._entries.pop((corridor, 0), None)
        self._entries.pop((corridor, 1), None)


def _gaps(shut: Iterable[Span]) -> list[Span]:
    gaps, since_s = [], -inf
    for begin_s, end_s in shut:
        if begin_s >= since_s:
            gaps.append((since_s, begin_s))
        since_s = max(since_s, end_s)
    if since_s < inf:
        gaps.append((since_s, inf))
    return gaps


def _spare(bays: Iterable[tuple[str, float, float]], capacity: int, clearance_s: float) -> list[Span]:
    changes = sorted(
        change for _, since_s, until_s in bays for change in ((since_s, 1), (until_s + clearance_s - ROUNDING_S, -1))
    )
    spare, standing, room_since_s = [], 0, -inf
    for at_s, change in changes:
        had_room = standing < capacity
        standing += change
        has_room = standing < capacity
        gone_by_s = at_s - clearance_s + ROUNDING_S
        if had_room and not has_room and gone_by_s > room_since_s:
            spare.append((room_since_s, gone_by_s))
        elif has_room and not had_room:
            room_since_s = at_s + ROUNDING_S
    if standing < capacity and room_since_s < inf:
        spare.append((room_since_s, inf))
    return spare
