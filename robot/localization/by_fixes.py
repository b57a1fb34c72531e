"""Fixes from position sources other than markers, for a robot that does not know where it is."""

from collections.abc import Iterable

from maps import CampusMap
from robot.drivers.interfaces import Fix, Odometry
from robot.localization.place import Leaving, Place, Unknown

FRESH_S = 2.0


def near_dock(
    campus: CampusMap, place: Place, fixes: Iterable[tuple[Fix, Odometry]], home: str | None, now: float
) -> Place:
    """A robot that sees a dock's infrared is within a few steps of its post; which way it looks, the next marker tells.

    All docks send the same, so this needs the only dock of the map, or the robot's own.
    """
    if not (isinstance(place, Unknown) and place.here is None):
        return place
    if not any(fix.source == "dock" and now - fix.at_s < FRESH_S for fix, _ in fixes):
        return place
    docks = [post.name for post in campus.docks()]
    post = docks[0] if len(docks) == 1 else home
    return Leaving(post) if post is not None and post in docks else place
