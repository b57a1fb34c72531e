"""The way the robot looks, by a marker that was not expected."""

import math

from maps import CampusMap
from maps.geometry import wrapped
from robot.localization.approach import robot_heading_rad

NEAR_RAD = math.radians(50)
"""The way the robot looks by odometry picks one of a post's markers, if it is so near to one of them."""


def facing_by(campus: CampusMap, post: str, facing_rad: float | None) -> float | None:
    """The way a robot looks along the line when it sees a marker of this post; None where several would look the same.

    `facing_rad`: what odometry says, None after a lift. All markers of a post carry the same text, so only at a post
    with one way in the marker itself tells.
    """
    headings = {round(robot_heading_rad(marker), 3): marker for marker in campus.post(post).markers}
    if len(headings) == 1:
        return robot_heading_rad(next(iter(headings.values())))
    if facing_rad is None:
        return None
    off = {abs(wrapped(robot_heading_rad(marker) - facing_rad)): marker for marker in headings.values()}
    return robot_heading_rad(off[min(off)]) if off and min(off) < NEAR_RAD else None
