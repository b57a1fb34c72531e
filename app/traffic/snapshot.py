"""The traffic at one moment: where every robot is, what it holds, what it asks for and what it has before it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from itertools import takewhile
from typing import Final, NamedTuple

from maps import corridor_name

OF_ITS_OWN: Final = "own"
"""The key of a place that a robot goes to, or charges at, for reasons of its own."""


class Stop(NamedTuple):
    """A post that a robot has before it. `charges_to`: there it charges until it has this ratio."""

    key: str
    post: str
    charges_to: float | None = None


@dataclass(frozen=True)
class ReservationRequest:
    """A claim that waits. `first`: the corridors that the robot may enter first; several if it does not know which way
    it looks. `goal`: where it is going to now. `then`: the corridors after the first, as far as there."""

    claim_id: str
    first: tuple[tuple[str, str], ...]
    goal: str
    then: tuple[tuple[str, str], ...] = ()
    legs: tuple[tuple[str, str], ...] = ()
    """All of them, as the robot named them: spurs and corridors of the track."""
    place: str = ""
    """The goal as the robot named it: a post, or a bay there."""
    comes_in: bool = False
    """It asks to come into a bay at its goal."""

    @property
    def is_for_later(self) -> bool:
        """It asks on its way for what comes after the place where it is going to now."""
        return self.goal == self.first[0][0] and not self.comes_in


@dataclass(frozen=True)
class Hold:
    """A corridor that a robot may be in. `goal`: the place that it asked to go to."""

    from_post: str
    to_post: str
    grant_id: int = field(default=0, compare=False)
    goal: str | None = field(default=None, compare=False)

    @property
    def corridor(self) -> str:
        return corridor_name(self.from_post, self.to_post)


@dataclass(frozen=True)
class Occupied:
    """A bay, a crossing or a corridor that a robot says to be wholly in: `place`, see `OccupancyRow`."""

    kind: str
    place: str
    towards: str | None = None


@dataclass(frozen=True)
class RobotLocation:
    """One robot. `goals`: all that it has before it, in order. `stopped`: a person or something keeps it where it is,
    and it has said so. `occupies` and `home_bay`: on maps with bays. `home`: where it rests in the end, its own home or
    the dock that is lent to it."""

    robot: str
    post: str
    seen_at: datetime | None
    home: str | None
    at_home: bool
    online: bool
    holds: tuple[Hold, ...]
    goals: tuple[Stop, ...]
    request: ReservationRequest | None
    stopped: bool
    heard_at: datetime | None
    occupies: Occupied | None = None
    home_bay: str | None = None
    battery_ratio: float | None = field(default=None, compare=False)

    @property
    def way(self) -> tuple[Hold, ...]:
        """Those of its corridors that it goes through one after the other. What it holds besides is the other way out
        of where it stood, if it did not know which way it looks."""
        ends = [hold.to_post for hold in self.holds]
        further = takewhile(lambda pair: pair[0] == pair[1].from_post, zip(ends, self.holds[1:], strict=False))
        return (*self.holds[:1], *(hold for _, hold in further))

    def goes_into(self, bay: str) -> bool:
        """Tell if it asks for the way into this bay, or was let in."""
        asked = self.request.legs if self.request is not None else ()
        return any(leg[1] == bay for leg in asked) or any(hold.to_post == bay for hold in self.holds)


@dataclass(frozen=True)
class TrafficSnapshot:
    """A snapshot of the traffic: all robots whose place is known, by name, and the corridors that are closed."""

    robots: Mapping[str, RobotLocation]
    closed: frozenset[str]
