"""The charging station: its infrared, its contacts, and what the firmware's Seek Dock does near it.

Characters 160 to 173 of the 600 series' drive-on dock [S]; lengths and widths of the beams, the touch, and the way the
firmware drives are assumptions [A].
"""

import math
from dataclasses import dataclass

from maps import Dock

TOUCH_LEFT_M = 0.020
TOUCH_AHEAD_M = 0.010
TOUCH_TURNED_RAD = math.radians(10)
BODY_HALF_WIDTH_M = 0.2
BODY_DEPTH_M = 0.15
# The infrared window stands this far behind the middle of a docked robot.
WINDOW_AHEAD_M = 0.22
BEAM_M = 2.2
BEAM_OUTER_RAD = math.radians(25)
BEAM_OVERLAP_RAD = math.radians(5)
FORCE_FIELD_M = 0.5
RESERVED, FORCE_FIELD, GREEN, RED = 160, 1, 4, 8


@dataclass(frozen=True)
class Beside:
    """A robot as its dock sees it: 0, 0, 0 is docked. `ahead_m` is negative before it, left is the robot's left."""

    ahead_m: float
    left_m: float
    turned_rad: float

    @property
    def aligned(self) -> bool:
        return abs(self.left_m) < TOUCH_LEFT_M and abs(self.turned_rad) < TOUCH_TURNED_RAD

    @property
    def touching(self) -> bool:
        return self.aligned and -TOUCH_AHEAD_M < self.ahead_m < BODY_DEPTH_M

    @property
    def held(self) -> bool:
        """The body of the dock stands in the way."""
        return 0.0 <= self.ahead_m < BODY_DEPTH_M and abs(self.left_m) < BODY_HALF_WIDTH_M


def beside(dock: Dock, x_m: float, y_m: float, heading_rad: float) -> Beside:
    dx, dy = x_m - dock.x_m, y_m - dock.y_m
    along, across = math.cos(dock.heading_rad), math.sin(dock.heading_rad)
    turned = (heading_rad - dock.heading_rad + math.pi) % math.tau - math.pi
    return Beside(dx * along + dy * across, dy * along - dx * across, turned)


def ir_character(place: Beside) -> int:
    """Return the character that reaches a robot here: 0, or 160 and the bits of force field, green and red buoy.

    A robot that approaches has the green beam on the left, the red one on the right, both on the middle line.
    """
    before_m = WINDOW_AHEAD_M - place.ahead_m
    off_rad = math.atan2(place.left_m, before_m)
    distance_m = math.hypot(before_m, place.left_m)
    bits = FORCE_FIELD if distance_m < FORCE_FIELD_M + WINDOW_AHEAD_M else 0
    if distance_m < BEAM_M:
        bits += GREEN if -BEAM_OVERLAP_RAD < off_rad < BEAM_OUTER_RAD else 0
        bits += RED if -BEAM_OUTER_RAD < off_rad < BEAM_OVERLAP_RAD else 0
    return RESERVED + bits if bits else 0


def bearing_rad(place: Beside) -> float:
    """Where the robot sees the dock's window, left positive."""
    bearing = math.atan2(-place.left_m, WINDOW_AHEAD_M - place.ahead_m) - place.turned_rad
    return (bearing + math.pi) % math.tau - math.pi


SEEK_RANGE_M = 1.6
SEEK_LIMIT_S = 60.0
TRIES = 3
TURN_MM_S = 60.0
FAR_MM_S = 150.0
NEAR_MM_S = 60.0
Wheels = tuple[float, float]


class SeekDock:
    """The firmware's own drive onto a dock. `wheels` gives (left, right) in mm/s, or nothing when it has given up.

    It finds a dock whose beams it stands in, up to 1.6 m away; elsewhere it circles, and gives up after a minute.
    """

    def __init__(self, started_s: float) -> None:
        self._started_s = started_s
        self._backing = False
        self._tries = 0

    def wheels(self, place: Beside | None, now: float) -> Wheels | None:
        if now - self._started_s > SEEK_LIMIT_S or self._tries >= TRIES:
            return None
        if place is None or not self._in_reach(place):
            return FAR_MM_S / 3, FAR_MM_S
        if place.held and not place.aligned:
            self._backing = True
            self._tries += 1
        if self._backing:
            self._backing = place.ahead_m > -0.35
            return -FAR_MM_S, -FAR_MM_S
        return _approach(place)

    def _in_reach(self, place: Beside) -> bool:
        in_beam = ir_character(place) & (GREEN | RED) and place.ahead_m > -SEEK_RANGE_M
        return self._backing or bool(in_beam)


def _approach(place: Beside) -> Wheels:
    """Towards a point on the middle line a little ahead, slower and straighter near the dock."""
    look_m = min(max(-place.ahead_m * 0.5, 0.12), 0.4)
    wanted_rad = math.atan2(-place.left_m, look_m)
    error_rad = wanted_rad - place.turned_rad
    error_rad = (error_rad + math.pi) % math.tau - math.pi
    if abs(error_rad) > math.radians(40):
        return (-TURN_MM_S, TURN_MM_S) if error_rad > 0 else (TURN_MM_S, -TURN_MM_S)
    speed = FAR_MM_S if place.ahead_m < -0.3 else NEAR_MM_S
    steer = speed * error_rad * 1.2
    return speed - steer, speed + steer
