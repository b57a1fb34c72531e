"""Carried somewhere else: which markers cannot be next, and what one that was not expected tells."""

import math

from maps import CampusMap, Marker
from maps.geometry import seen_from, wrapped

from ..drivers.interfaces import Odometry, Sighting
from .approach import marker_point, post_ahead_mm, robot_heading_rad
from .position import Position

BESIDE_MM = 250.0
"""A marker farther from where it hangs beside the line is seen across a room, and tells nothing of this line."""
NEAR_RAD = math.radians(50)
"""The way the robot looks by odometry picks one of a post's markers, if it is so near to one of them."""


def cannot_be_next(campus: CampusMap, position: Position, sighting: Sighting) -> bool:
    """Whether nobody who was at `position.current` could come to this marker without passing another post."""
    here = position.current
    if here is None or sighting.text == here or sighting.text not in campus.posts:
        return False
    beside = {post.name for post, _ in campus.neighbours(here)}
    return sighting.text not in beside and _hangs_beside_this_line(campus, sighting)


def _hangs_beside_this_line(campus: CampusMap, sighting: Sighting) -> bool:
    markers = campus.post(sighting.text).markers
    return any(abs(sighting.left_mm - 1000 * _left_m(campus, marker)) < BESIDE_MM for marker in markers)


def _left_m(campus: CampusMap, marker: Marker) -> float:
    """How far to the left of the line to its post a marker hangs."""
    _, right_m = seen_from(marker_point(marker), robot_heading_rad(marker), campus.post(marker.post).point)
    return -right_m


def facing_by(campus: CampusMap, sighting: Sighting, facing_rad: float | None) -> float | None:
    """The way a robot looks along the line when it sees this marker; None where several would look the same.

    `facing_rad`: what odometry says, None after a lift. All markers of a post carry the same text, so only at a post
    with one way in the marker itself tells.
    """
    headings = {round(robot_heading_rad(marker), 3): marker for marker in campus.post(sighting.text).markers}
    if len(headings) == 1:
        return robot_heading_rad(next(iter(headings.values())))
    if facing_rad is None:
        return None
    off = {abs(wrapped(robot_heading_rad(marker) - facing_rad)): marker for marker in headings.values()}
    return robot_heading_rad(off[min(off)]) if off and min(off) < NEAR_RAD else None


def found_at(campus: CampusMap, position: Position, sighting: Sighting, odometry: Odometry, lifted: bool) -> Position:
    """Nothing of before holds; the post of this marker lies ahead. `odometry` is that of the sighting."""
    facing = facing_by(campus, sighting, None if lifted else position.facing_now_rad(odometry))
    ahead_mm = post_ahead_mm(campus, sighting, facing) or 0.0
    return Position(
        facing_rad=facing,
        spot_turn_rad=odometry.spot_turn_rad,
        approaching=sighting.text,
        post_at_mm=odometry.ahead_mm + ahead_mm,
        seen_at_s=sighting.at_s,
        has_left=True,
    )


def nowhere(position: Position) -> Position:
    """Somebody holds the robot in their hands: what it knew of its place is only where it was last."""
    return Position(position.current, position.previous, has_left=True, seen_at_s=position.seen_at_s)
