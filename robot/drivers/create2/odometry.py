"""Where the encoders say the robot is."""

import math

from robot.drivers.interfaces import BaseState, BodyShape, Odometry

SPOT_RATIO = 0.25
"""Movement of the centre under this share of the wheels' own is a turn on the spot (an arc round one wheel has 0.5)."""


def counts_between(old: int, new: int) -> int:
    """Encoder counts are 16 bits and wrap about every 14.5 m, in either direction."""
    return ((new - old + 32768) % 65536) - 32768


def advanced(odometry: Odometry, old: BaseState, new: BaseState, shape: BodyShape) -> Odometry:
    """After the wheels went from `old` to `new` (midpoint rule; a frame is 15 ms, so an arc and a chord are one)."""
    left_mm = counts_between(old.left_count, new.left_count) * shape.mm_per_count
    right_mm = counts_between(old.right_count, new.right_count) * shape.mm_per_count
    if left_mm == 0 and right_mm == 0:
        return odometry
    ahead_mm = (left_mm + right_mm) / 2
    turned_rad = (right_mm - left_mm) / shape.wheel_base_mm
    middle_rad = odometry.heading_rad + turned_rad / 2
    on_the_spot = abs(ahead_mm) <= SPOT_RATIO * (abs(left_mm) + abs(right_mm))
    return Odometry(
        odometry.x_mm + ahead_mm * math.cos(middle_rad),
        odometry.y_mm + ahead_mm * math.sin(middle_rad),
        odometry.heading_rad + turned_rad,
        odometry.travelled_mm + abs(ahead_mm),
        odometry.ahead_mm + ahead_mm,
        odometry.spot_turn_rad + (turned_rad if on_the_spot else 0.0),
    )
