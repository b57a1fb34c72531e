"""Judges where bodies are, by their own word alone: two in one place, who waits too long, who stands in the way.

A place is a bay (with its dock), the crossing of a post, or a corridor; on its way from one to the next a body is in
both.
"""

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Final

from maps import CampusMap, corridor_name
from protocol.parts import Leg

STUCK_S: Final = 2 * 3600.0
"""A robot that wants to go on and is not let for so long."""
ON_CROSSING_S: Final = 180.0
"""A robot that is on a crossing for so long stands there: over it takes seconds."""
SHOWN: Final = 20
"""So many meetings are told in words."""
BAY, CROSSING, CORRIDOR = "bay", "crossing", "corridor"


def bay(name: str) -> str:
    return f"{BAY} {name}"


def crossing(post: str) -> str:
    return f"{CROSSING} {post}"


def corridor(leg: Leg) -> str:
    return f"{CORRIDOR} {corridor_name(leg.from_post, leg.to_post)}"


@dataclass(frozen=True)
class Meeting:
    """Two bodies in one place. `by_person`: a person has put one of them there."""

    at_s: float
    place: str
    robots: tuple[str, str]
    by_person: bool


@dataclass(frozen=True)
class Taken:
    """What one body is in, and the way that it goes."""

    places: frozenset[str] = frozenset()
    leg: Leg | None = None


@dataclass
class Judge:
    """`now_s`: the time. `met`: how often two bodies did, by the kind of place. `arrivals`: at crossings. `stuck`: who
    waited too long, and when that ended; `in_the_way`: who stood on a crossing for too long, where and until when."""

    track: CampusMap
    now_s: Callable[[], float]
    meetings: list[Meeting] = field(default_factory=list)
    met: Counter[str] = field(default_factory=Counter)
    arrivals: int = 0
    waits_s: list[float] = field(default_factory=list)
    stuck: list[tuple[str, float]] = field(default_factory=list)
    in_the_way: list[tuple[str, str, float]] = field(default_factory=list)
    _taken: dict[str, Taken] = field(default_factory=dict)
    _carried: dict[str, str] = field(default_factory=dict)
    _waits_since_s: dict[str, float] = field(default_factory=dict)
    _crosses_since_s: dict[tuple[str, str], float] = field(default_factory=dict)
    _off: set[str] = field(default_factory=set)

    # Where bodies are.

    def is_in(self, robot: str, places: Iterable[str], leg: Leg | None = None) -> None:
        """It is in all of these and in nothing else, by its own wheels."""
        self._settle(robot, Taken(frozenset(places), leg))
        if self._carried.get(robot) not in self._taken[robot].places:
            self._carried.pop(robot, None)

    def is_put(self, robot: str, place: str) -> None:
        """A person has put it down there: whom it meets there is that person's doing, until it has left."""
        self._carried[robot] = place
        self._settle(robot, Taken(frozenset({place})))

    def is_taken(self, robot: str) -> None:
        """A person holds it in their hands."""
        self._settle(robot, Taken())
        self.goes_on(robot)

    def places_of(self, robot: str) -> frozenset[str]:
        return self._taken.get(robot, Taken()).places

    def is_free(self, place: str) -> bool:
        """As a person sees it who comes near."""
        return all(place not in taken.places for taken in self._taken.values())

    def _settle(self, robot: str, now: Taken) -> None:
        before = self.places_of(robot)
        self._taken[robot] = now
        self._note_crossings(robot, before, now.places)
        for place in sorted(now.places - before):
            for other, its in self._taken.items():
                if other != robot and place in its.places and not self._follows(place, now.leg, its.leg):
                    self._meet(robot, other, place)

    def _follows(self, place: str, leg: Leg | None, other: Leg | None) -> bool:
        if leg is None or leg != other or place != corridor(leg):
            return False
        return self.track.corridor(leg.from_post, leg.to_post).following_s is not None

    def _meet(self, robot: str, other: str, place: str) -> None:
        by_person = not {robot, other}.isdisjoint(self._carried)
        self.met["by a person" if by_person else place.partition(" ")[0]] += 1
        if len(self.meetings) < SHOWN:
            self.meetings.append(Meeting(round(self.now_s(), 1), place, (robot, other), by_person))

    def _note_crossings(self, robot: str, before: frozenset[str], now: frozenset[str]) -> None:
        for place in sorted(one for one in now - before if one.startswith(CROSSING)):
            self.arrivals += 1
            self._crosses_since_s[robot, place] = self.now_s()
        for place in sorted(one for one in before - now if one.startswith(CROSSING)):
            self._note_crossed(robot, place)

    def _note_crossed(self, robot: str, place: str) -> None:
        since_s = self._crosses_since_s.pop((robot, place))
        if self.now_s() - since_s > ON_CROSSING_S and robot not in self._off:
            self.in_the_way.append((robot, place, round(self.now_s(), 1)))
        self._off.discard(robot)

    def is_off(self, robot: str) -> None:
        """Its computer is off, as people or chance have it: if it is on a crossing that is not its own doing."""
        if any(place.startswith(CROSSING) for place in self.places_of(robot)):
            self._off.add(robot)

    # Who waits.

    def waits(self, robot: str) -> None:
        """It wants to go on, and may not."""
        self._waits_since_s.setdefault(robot, self.now_s())

    def goes_on(self, robot: str) -> None:
        """It moves, or wants nothing."""
        since_s = self._waits_since_s.pop(robot, None)
        if since_s is not None:
            self._note_wait(robot, self.now_s() - since_s)

    def ends(self) -> None:
        for robot in list(self._waits_since_s):
            self.goes_on(robot)
        for robot, place in list(self._crosses_since_s):
            self._note_crossed(robot, place)

    def _note_wait(self, robot: str, waited_s: float) -> None:
        self.waits_s.append(waited_s)
        if waited_s > STUCK_S:
            self.stuck.append((robot, round(self.now_s(), 1)))
