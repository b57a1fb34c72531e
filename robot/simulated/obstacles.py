"""Obstacles: people as circles, walls as lines. Contact is where the bumper's circle overlaps one."""

import math
from dataclasses import dataclass
from typing import Protocol

BUMPER_RADIUS_M = 0.3485 / 2
BASE_HEIGHT_M = 0.092
# The letter box upon the base, with the mast of the camera [A].
BOX_RADIUS_M, BOX_HEIGHT_M = 0.125, 0.30
# The bumper is the front half; a touch within this angle of straight ahead presses both ends [A].
BOTH_ENDS_RAD = math.radians(12)
BUMPER_RAD = math.radians(95)
LIGHT_RANGE_M = 0.12
# Bearing of each light bumper from straight ahead, left positive, in the order of packets 46 to 51 [A].
LIGHTS_RAD = tuple(math.radians(angle) for angle in (65, 38, 13, -13, -38, -65))
LIGHT_BEAMS_RAD = tuple(math.radians(angle) for angle in (-10, 0, 10))  # how wide each looks [A]
BEAM_ENDS_M = 0.002


@dataclass(frozen=True)
class Person:
    """A person who stands in the way."""

    x_m: float
    y_m: float
    radius_m: float = 0.2

    def nearest(self, x_m: float, y_m: float) -> tuple[float, float, float]:
        """(x, y) of the nearest point to measure from, and how far the surface stands out from it."""
        return self.x_m, self.y_m, self.radius_m


@dataclass(frozen=True)
class Wall:
    """A straight wall between two points."""

    ax_m: float
    ay_m: float
    bx_m: float
    by_m: float

    def nearest(self, x_m: float, y_m: float) -> tuple[float, float, float]:
        """(x, y) of the nearest point of the wall; it has no thickness."""
        dx, dy = self.bx_m - self.ax_m, self.by_m - self.ay_m
        share = ((x_m - self.ax_m) * dx + (y_m - self.ay_m) * dy) / (dx * dx + dy * dy or 1.0)
        share = min(max(share, 0.0), 1.0)
        return self.ax_m + share * dx, self.ay_m + share * dy, 0.0


class Obstacle(Protocol):
    """An object that a bumper can touch."""

    def nearest(self, x_m: float, y_m: float) -> tuple[float, float, float]:
        """(x, y) of the point nearest to here, and how far the surface stands out from it."""
        ...


@dataclass(frozen=True)
class Contact:
    """`gap_m` between bumper and obstacle (negative: overlapping), `bearing_rad` to it, left positive."""

    gap_m: float
    bearing_rad: float
    obstacle: Obstacle

    @property
    def pressed(self) -> tuple[bool, bool]:
        """(left, right) of the bumper."""
        if abs(self.bearing_rad) > BUMPER_RAD:
            return False, False
        return self.bearing_rad > -BOTH_ENDS_RAD, self.bearing_rad < BOTH_ENDS_RAD


def contact(obstacle: Obstacle, x_m: float, y_m: float, heading_rad: float) -> Contact:
    """Return the obstacle's relation to a robot at this pose."""
    near_x, near_y, radius = obstacle.nearest(x_m, y_m)
    bearing = math.atan2(near_y - y_m, near_x - x_m) - heading_rad
    gap = math.hypot(near_x - x_m, near_y - y_m) - radius - BUMPER_RADIUS_M
    return Contact(gap, (bearing + math.pi) % math.tau - math.pi, obstacle)


def light_signals(contacts: list[Contact], x_m: float, y_m: float, heading_rad: float) -> tuple[int, ...]:
    """Packets 46 to 51 at this pose: brighter the nearer, 0 to 4095 [A]."""
    within = [one.obstacle for one in contacts if one.gap_m <= LIGHT_RANGE_M]
    if not within:
        return (0,) * len(LIGHTS_RAD)
    return tuple(
        max(_signal(one, x_m, y_m, heading_rad + at_rad + beam) for one in within for beam in LIGHT_BEAMS_RAD)
        for at_rad in LIGHTS_RAD
    )


def _signal(obstacle: Obstacle, x_m: float, y_m: float, beam_rad: float) -> int:
    """Along the beam, outwards from the bumper: nothing is nearer than the nearest point, so it leaps that far."""
    out_m = 0.0
    while out_m <= LIGHT_RANGE_M:
        from_m = BUMPER_RADIUS_M + out_m
        at_x, at_y = x_m + from_m * math.cos(beam_rad), y_m + from_m * math.sin(beam_rad)
        near_x, near_y, radius_m = obstacle.nearest(at_x, at_y)
        free_m = math.hypot(near_x - at_x, near_y - at_y) - radius_m
        if free_m < BEAM_ENDS_M:
            return round(2000 * (1 - out_m / LIGHT_RANGE_M))
        out_m += free_m
    return 0
