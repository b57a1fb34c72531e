"""Docks: which one is near, where a robot in one is, and the way out of it."""

import math

from maps import CampusMap, NoRoute, shortest_route
from maps.geometry import wrapped

from ..drivers.interfaces import Odometry
from .position import Position

STRAIGHT_ON_RAD = math.radians(30)


def nearest_dock(campus: CampusMap, here: str, avoid: frozenset[str]) -> str | None:
    """The post of the dock with the shortest way; None where no way is open."""
    reachable: list[tuple[float, str]] = []
    for dock in campus.docks():
        try:
            reachable.append((shortest_route(campus, here, dock.name, avoid).length_m, dock.name))
        except NoRoute:
            continue
    return min(reachable)[1] if reachable else None


def in_dock(campus: CampusMap, position: Position, home: str | None, odometry: Odometry) -> Position:
    """In a dock the robot knows its place, whatever it believed: the last post seen if that has one, else home."""
    here = campus.posts.get(position.current or "")
    post = here if here and here.dock else campus.posts.get(home or "")
    if post is None or post.dock is None:
        return position
    return Position(
        current=post.name,
        previous=position.previous if position.current == post.name else position.current,
        facing_rad=post.dock.heading_rad,
        spot_turn_rad=odometry.spot_turn_rad,
        post_at_mm=odometry.ahead_mm,
    )


def way_out(campus: CampusMap, here: str | None, towards: str | None) -> tuple[float | None, bool]:
    """From a dock to its post, in mm (None where none is), and whether the line that is taken leads straight on."""
    post = campus.posts.get(here or "")
    if post is None or post.dock is None:
        return None, True
    way_mm = 1000 * math.dist((post.dock.x_m, post.dock.y_m), post.point)
    away_rad = post.dock.heading_rad + math.pi
    ways = [corridor for other, corridor in campus.neighbours(post.name) if towards in (None, other.name)]
    leaving = [corridor.heading_leaving(post.name) for corridor in ways]
    return way_mm, any(abs(wrapped(heading - away_rad)) < STRAIGHT_ON_RAD for heading in leaving)
