"""How far a robot has turned since it began to, through a restart: its base goes on counting without the computer."""

import math
from dataclasses import dataclass
from typing import Final

from maps.geometry import wrapped
from robot.drivers.create2.odometry import advanced
from robot.drivers.interfaces import BaseState, BodyShape, Odometry

MOST_TURNED_RAD: Final = math.tau
"""Beyond that the base has turned on without end, and neither its counts, which wrap, nor its wheels tell a heading."""
MOST_MOVED_MM: Final = 150.0
"""A turn and its search for the line end so near to where they began. A base that was reset counts from anywhere."""


@dataclass(frozen=True, slots=True)
class TurnBegun:
    """The way the robot looked, in the map's frame, and the counts of its wheels then."""

    looks_rad: float
    left_count: int
    right_count: int

    def looks_now_rad(self, base: BaseState, shape: BodyShape) -> float | None:
        """The way it looks now; None: the counts cannot be of this turn."""
        begun = BaseState(0.0, self.left_count, self.right_count)
        turned = advanced(Odometry(), begun, base, shape)
        is_of_this_turn = turned.travelled_mm <= MOST_MOVED_MM and abs(turned.heading_rad) <= MOST_TURNED_RAD
        return wrapped(self.looks_rad + turned.heading_rad) if is_of_this_turn else None


@dataclass(frozen=True, slots=True)
class Turned:
    """What a robot keeps of its turns through a restart."""

    begun: TurnBegun | None = None
    """At a post; None: none is under way, or the way it looked was not known."""
    back_from: str | None = None
    """The far end of the corridor in which it has turned round; None: it goes the way that it was granted."""


NOT_TURNED: Final = Turned()


class CountedTurn:
    """The newest turn that was written down, and the base that counts it. `not_yet_known`: it was under way when the
    robot was switched off, and the base has not been heard since."""

    def __init__(self, kept: TurnBegun | None, shape: BodyShape, now: float) -> None:
        self._kept, self._shape, self._base = kept, shape, BaseState(now)

    @property
    def not_yet_known(self) -> bool:
        return self._kept is not None

    def hear(self, base: BaseState) -> float | None:
        """The way it looks after a restart in a turn, told once; None: there is nothing to tell."""
        kept, self._kept, self._base = self._kept, None, base
        return kept.looks_now_rad(base, self._shape) if kept else None

    def begun(self, looks_rad: float | None) -> TurnBegun | None:
        """What to write down of a turn that begins now; None: the way the robot looks is not known."""
        return None if looks_rad is None else TurnBegun(looks_rad, self._base.left_count, self._base.right_count)
