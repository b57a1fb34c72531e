"""Gone into another corridor than the one that was meant.

At a crossing a turn that begins a hand's breadth beside the post may meet the wrong tape. Nothing but the way the robot
looks can tell: wheels that err by some degrees in a turn still tell corridors apart that lie a quarter apart.
"""

import math

from maps import CampusMap
from maps.geometry import wrapped
from robot.drivers.interfaces import Odometry

SURE_RAD = math.radians(30)
"""It looks along another corridor to within this, and so much less along the one that was meant."""
TRUSTED_RAD = math.radians(20)
"""A line met within this of where it should be is the one that was meant, and straightens the reckoning up."""
FROM_MM, TO_MM = 120.0, 400.0
"""So far beyond the post the robot looks along its line, and no bend is counted in yet."""


class Compass:
    """The way the robot looks on the map by its wheels alone, from the last place where that was sure."""

    def __init__(self) -> None:
        self._turned_rad: float | None = None

    def set(self, looks_rad: float | None, odometry: Odometry) -> None:
        """It looks this way (None: unknown)."""
        self._turned_rad = None if looks_rad is None else looks_rad - odometry.heading_rad

    def confirm(self, looks_rad: float, odometry: Odometry) -> None:
        """It should look this way, along a line that it has just met."""
        known_rad = self.looks_rad(odometry)
        if known_rad is not None and abs(wrapped(looks_rad - known_rad)) <= TRUSTED_RAD:
            self.set(looks_rad, odometry)

    def looks_rad(self, odometry: Odometry) -> float | None:
        return None if self._turned_rad is None else wrapped(self._turned_rad + odometry.heading_rad)


def really_towards(campus: CampusMap, here: str, meant: str, looks_rad: float) -> str | None:
    """The neighbour whose corridor it has gone into instead of the meant one's; None: none for sure."""
    off_rad = {
        post.name: abs(wrapped(corridor.heading_leaving(here) - looks_rad))
        for post, corridor in campus.neighbours(here)
    }
    nearest = min(off_rad, key=off_rad.__getitem__, default=meant)
    sure = off_rad.get(nearest, math.pi) <= SURE_RAD and off_rad.get(meant, 0.0) - off_rad[nearest] > SURE_RAD
    return nearest if sure else None
