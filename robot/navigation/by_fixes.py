"""What position sources other than markers tell a robot that does not know where it is."""

from collections.abc import Iterable
from dataclasses import replace

from maps import CampusMap

from ..drivers.interfaces import Fix, Odometry
from .position import Position

FRESH_S = 2.0


def near_dock(
    campus: CampusMap, position: Position, fixes: Iterable[tuple[Fix, Odometry]], home: str | None, now: float
) -> Position:
    """Whoever sees a dock's infrared is within a few steps of its post; which way it looks, the next marker will tell.

    All docks send the same, so this needs the only dock of the map, or the robot's own.
    """
    if position.current is not None or not any(fix.source == "dock" and now - fix.at_s < FRESH_S for fix, _ in fixes):
        return position
    docks = [post.name for post in campus.docks()]
    post = docks[0] if len(docks) == 1 else home
    return replace(position, current=post, has_left=True) if post in docks else position
