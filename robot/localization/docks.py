"""Docks: which one is near, where a robot in one is, and the way out of it."""

import math

from maps import CampusMap, NoRoute, Post, shortest_route
from maps.geometry import wrapped

STRAIGHT_ON_RAD = math.radians(30)


def nearest_dock(campus: CampusMap, here: str, home: str | None, avoid: frozenset[str]) -> str | None:
    """The place of the dock with the shortest way; None where no way is open. A bay that is another's home stays free
    for it."""
    reachable: list[tuple[float, str]] = []
    for dock in (one for one in campus.docks() if one.bay_of is None or one.is_lent or one.name == home):
        try:
            reachable.append((shortest_route(campus, here, dock.name, avoid).length_m, dock.name))
        except NoRoute:
            continue
    return min(reachable)[1] if reachable else None


def dock_post(campus: CampusMap, *posts: str | None) -> Post | None:
    """The first of these posts that has a dock: a robot that is docked is there, whatever it believed."""
    known = (campus.posts.get(post or "") for post in posts)
    return next((post for post in known if post and post.dock), None)


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
