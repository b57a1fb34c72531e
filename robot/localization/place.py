"""Where the robot is, in words of the map: one place at a time, and none that the map does not have.

| place     | it is                                                                 |
|-----------|-----------------------------------------------------------------------|
| `Unknown` | anywhere: it was lifted, or nothing has told it yet                   |
| `AtPost`  | with its axle on a post, or within a hand's breadth of it             |
| `Leaving` | on one of the lines of a post; which one is not known                 |
| `Coming`  | before a post whose marker it has read; where it came from is unknown |
| `Between` | in a corridor of the map, with one end ahead and the other behind     |

A corridor is the map's own `Corridor`: a way between posts that are no neighbours cannot be written down. Distances are
readings of `Odometry.ahead_mm`. Places are never changed: `steps.py` says which one follows.
"""

from dataclasses import dataclass
from typing import TypeAlias

from maps import Corridor
from maps.geometry import wrapped
from robot.drivers.interfaces import Odometry


@dataclass(frozen=True, slots=True)
class Unknown:
    """`here`: the last post reached; `was`: the posts around it when it was lifted, to which it may have been put
    back."""

    here: str | None = None
    was: frozenset[str] = frozenset()
    lifted: bool = False

    @property
    def towards(self) -> None:
        return None


@dataclass(frozen=True, slots=True)
class AtPost:
    """`at_mm`: the reading with the axle on the post; `since_mm`: the reading when it counted as reached."""

    here: str
    at_mm: float
    since_mm: float
    came_by: Corridor | None = None
    by_marker: bool = True
    """Its marker told how exactly it stands there; without that, one that is read later may send it on a little."""
    docked: bool = False

    @property
    def towards(self) -> None:
        return None


@dataclass(frozen=True, slots=True)
class Leaving:
    """`begin_mm`: the reading on the post; None: not known."""

    here: str
    begin_mm: float | None = None
    doubted: bool = False
    """It was switched off just before that post, on its way back, and may have passed it."""
    blind: bool = False
    """As in `Between`."""

    @property
    def towards(self) -> None:
        return None


@dataclass(frozen=True, slots=True)
class Coming:
    """`at_mm`: the reading with the axle on the post."""

    towards: str
    at_mm: float

    @property
    def here(self) -> None:
        return None


@dataclass(frozen=True, slots=True)
class Between:
    """`here`: the end at which it came in, from which it was granted; the other end is `far`."""

    corridor: Corridor
    here: str
    towards: str
    begin_mm: float | None = None
    """The reading with the axle on the end behind; None after a restart: then it may look either way."""
    ahead_mm: float | None = None
    """The reading with the axle on the end ahead, by the map or by its marker."""
    by_marker: bool = False
    meant: str | None = None
    """The post that it was going to when it came in here by mistake; None: it is where it was granted."""
    doubted: bool = False
    """It was switched off just before the end ahead, and may have passed it; or it is `blind` and cannot tell how far
    that is."""
    blind: bool = False
    """It has turned round so near to the end ahead that the marker of that may lie behind it, beside what it turned
    back from."""

    def __post_init__(self) -> None:
        if not {self.here, self.towards} <= {self.corridor.a, self.corridor.b}:
            raise ValueError(f"{self.here} and {self.towards} are not both ends of {self.corridor.name}")

    @property
    def far(self) -> str:
        return self.corridor.other(self.here)

    @property
    def behind(self) -> str:
        return self.corridor.other(self.towards)

    @property
    def turned_round(self) -> bool:
        return self.towards == self.here

    @property
    def astray(self) -> bool:
        return self.meant is not None


Place: TypeAlias = Unknown | AtPost | Leaving | Coming | Between


@dataclass(frozen=True, slots=True)
class Facing:
    """The way the robot looked, in the map's frame, when odometry's `spot_turn_rad` was read. Turns on the spot are
    added; bends of the line are not, so that it stays what it was at the post."""

    facing_rad: float
    spot_turn_rad: float

    @classmethod
    def of(cls, facing_rad: float | None, odometry: Odometry) -> "Facing | None":
        """None: not known."""
        return None if facing_rad is None else cls(facing_rad, odometry.spot_turn_rad)

    def curved(self, before: Odometry, now: Odometry) -> "Facing":
        """After a curve that was no bend of a corridor."""
        curves_rad = (now.heading_rad - now.spot_turn_rad) - (before.heading_rad - before.spot_turn_rad)
        return Facing(self.facing_rad + curves_rad, self.spot_turn_rad)

    def now_rad(self, odometry: Odometry) -> float:
        """At posts and on straight corridors."""
        return wrapped(self.facing_rad + odometry.spot_turn_rad - self.spot_turn_rad)
