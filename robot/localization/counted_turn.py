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
