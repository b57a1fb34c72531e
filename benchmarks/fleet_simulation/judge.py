"""Judges where bodies are, by their own word alone: two in one place, and who waits too long.

A place is a corridor, the crossing of a post, or a dock. Until posts have bays on the floor a robot that stops at a
post stands on its crossing, as all that pass do: two may well be there.
"""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from maps import CampusMap, corridor_name
from protocol.parts import Leg

STUCK_S: Final = 2 * 3600.0
"""A robot that wants to go on and is not let for so long."""
SHOWN: Final = 20
"""So many meetings are told in words."""
CROSSING, DOCK = "crossing", "dock"


@dataclass(frozen=True)
class Meeting:
    """Two bodies in one place. `by_person`: a person has put one of them there."""

    at_s: float
    place: str
    robots: tuple[str, str]
    by_person: bool


@dataclass
class Judge:
    """`now_s`: the time. `met`: how often two bodies did, by the kind of place. `arrivals`: at crossings. `stuck`: who
    waited too long, and when that ended."""

    campus: CampusMap
    now_s: Callable[[], float]
    meetings: list[Meeting] = field(default_factory=list)
    met: Counter[str] = field(default_factory=Counter)
    arrivals: int = 0
    waits_s: list[float] = field(default_factory=list)
    stuck: list[tuple[str, float]] = field(default_factory=list)
    _places: dict[str, tuple[str, Leg | None]] = field(default_factory=dict)
    _carried: set[str] = field(default_factory=set)
    _waits_since_s: dict[str, float] = field(default_factory=dict)

    # Where bodies are.

    def enters(self, robot: str, leg: Leg) -> None:
        self._moves(robot, f"corridor {corridor_name(leg.from_post, leg.to_post)}", leg)

    def crosses(self, robot: str, post: str) -> None:
        """It is on the crossing of this post, to stop there or to go on."""
        self.arrivals += 1
        self._moves(robot, f"{CROSSING} {post}")

    def docks(self, robot: str, post: str) -> None:
        self._moves(robot, f"{DOCK} {post}")

    def is_put(self, robot: str, post: str, *, in_dock: bool = False) -> None:
        """A person has put it down there: whom it meets there is that person's doing, until it has left."""
        self._carried.add(robot)
        self._settle(robot, f"{DOCK if in_dock else CROSSING} {post}", None)

    def is_taken(self, robot: str) -> None:
        """A person holds it in their hands."""
        self._places.pop(robot, None)
        self.goes_on(robot)

    def place_of(self, robot: str) -> str | None:
        there = self._places.get(robot)
        return None if there is None else there[0]

    def is_free(self, place: str) -> bool:
        """As a robot feels it that comes near."""
        return all(taken != place for taken, _ in self._places.values())

    def _moves(self, robot: str, place: str, leg: Leg | None = None) -> None:
        self._carried.discard(robot)
        self.goes_on(robot)
        self._settle(robot, place, leg)

    def _settle(self, robot: str, place: str, leg: Leg | None) -> None:
        self._places[robot] = (place, leg)
        for other, (its, its_leg) in self._places.items():
            if other != robot and its == place and not self._follows(leg, its_leg):
                self._meet(robot, other, place)

    def _follows(self, leg: Leg | None, other: Leg | None) -> bool:
        if leg is None or leg != other:
            return False
        return self.campus.corridor(leg.from_post, leg.to_post).following_s is not None

    def _meet(self, robot: str, other: str, place: str) -> None:
        by_person = not self._carried.isdisjoint((robot, other))
        self.met["by a person" if by_person else place.partition(" ")[0]] += 1
        if len(self.meetings) < SHOWN:
            self.meetings.append(Meeting(round(self.now_s(), 1), place, (robot, other), by_person))

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

    def _note_wait(self, robot: str, waited_s: float) -> None:
        self.waits_s.append(waited_s)
        if waited_s > STUCK_S:
            self.stuck.append((robot, round(self.now_s(), 1)))
