"""The distance to a post whose marker the camera sees."""

import math

from maps import CampusMap, Marker, Point, Post
from maps.geometry import seen_from, wrapped
from robot.drivers.interfaces import Sighting

FARTHEST_MM = 1500.0
"""A marker that puts the post farther off was misread, or hangs elsewhere than the map says."""
ASLANT_RAD = math.radians(30)
"""A marker that hangs turned so far from the robot says nothing about the way that is left to its post."""


def is_aslant(sighting: Sighting) -> bool:
    """Seen from a turn, or from beside the line that it hangs at."""
    return sighting.turned_rad is not None and abs(sighting.turned_rad) > ASLANT_RAD


def arrival_heading_rad(campus: CampusMap, came_from: str | None, post: str) -> float | None:
    """The way a robot looks that arrives at `post` from `came_from`; None unless they are neighbours."""
    neighbours = {other.name: corridor for other, corridor in campus.neighbours(post)}
    return neighbours[came_from].heading_arriving(post) if came_from in neighbours else None


def robot_heading_rad(marker: Marker) -> float:
    """The way a robot looks that has this marker abreast: the camera looks left, the printed face looks back."""
    return wrapped(marker.heading_rad + math.pi / 2)


def seen_marker(post: Post, facing_rad: float | None) -> Marker | None:
    """Which of the post's markers a robot sees that looks this way; the first when that is not known."""
    if facing_rad is None or not post.markers:
        return next(iter(post.markers), None)
    return min(post.markers, key=lambda marker: round(abs(wrapped(robot_heading_rad(marker) - facing_rad)), 3))


def post_ahead_mm(campus: CampusMap, sighting: Sighting, facing_rad: float | None) -> float | None:
    """From the axle to the post along the line at the moment of the sighting; negative: it lies behind.

    None when the marker cannot be this post's, or the post has none on the map.
    """
    post = campus.post(sighting.text)
    marker = seen_marker(post, facing_rad)
    if marker is None:
        return None
    beyond_m, _ = seen_from(marker_point(marker), robot_heading_rad(marker), post.point)
    ahead_mm = sighting.ahead_mm + beyond_m * 1000
    return ahead_mm if abs(ahead_mm) <= FARTHEST_MM else None


def marker_point(marker: Marker) -> Point:
    return Point(marker.x_m, marker.y_m)
