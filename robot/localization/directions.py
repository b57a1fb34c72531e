"""Which way: turns derived from the map's geometry, never from a table kept by hand."""

import math
from enum import StrEnum

from maps import CampusMap, Corridor, corridor_name, shortest_route
from maps.geometry import wrapped
from protocol.parts import Leg

PLAIN_TURNS = {"left": math.pi / 2, "right": -math.pi / 2, "behind": math.pi}

SAME_WAY_RAD = math.radians(60)
"""A robot that looks along a corridor to within this is taken to be going there."""


class Way(StrEnum):
    """The paper's words for a direction, as seen from the robot."""

    FORWARD = "forward"
    LEFT = "left"
    RIGHT = "right"
    BEHIND = "behind"
    ARRIVED = "arrived"


def sector(turn_rad: float) -> Way:
    """The word for a turn (positive to the left). Sectors of a quarter, as in the paper's prototype: bearing clockwise
    from the heading, within 45° forward, 45 to 135 right, 135 to 225 behind, else left."""
    clockwise_deg = round(math.degrees(-turn_rad), 6) % 360
    if clockwise_deg <= 45 or clockwise_deg > 315:
        return Way.FORWARD
    if clockwise_deg <= 135:
        return Way.RIGHT
    return Way.BEHIND if clockwise_deg <= 225 else Way.LEFT


def turn_towards_rad(campus: CampusMap, facing_rad: float, post: str, neighbour: str) -> float:
    """Return how far a robot that stands at `post` has to turn (positive to the left) to leave for `neighbour`."""
    return wrapped(campus.corridor(post, neighbour).heading_leaving(post) - facing_rad)


def corridor_ahead(campus: CampusMap, post: str, looks_rad: float) -> Corridor | None:
    """The corridor of `post` that a robot there looks along, if any."""
    turns = [(abs(turn_towards_rad(campus, looks_rad, post, one.name)), by) for one, by in campus.neighbours(post)]
    turn_rad, corridor = min(turns, key=lambda one: one[0], default=(math.inf, None))
    return corridor if turn_rad < SAME_WAY_RAD else None


def looks_otherwise(corridor: Corridor, post: str, looks_rad: float | None) -> bool:
    """Return whether it is known that a robot at `post` does not look as one that came along this corridor: it has
    backed up, turned, or was on another line."""
    return looks_rad is not None and abs(wrapped(looks_rad - corridor.heading_arriving(post))) > SAME_WAY_RAD


def turn_at_rad(campus: CampusMap, came_from: str, post: str, neighbour: str) -> float:
    """The turn at `post` of a robot that has just arrived from `came_from`. Back again is half a turn to the left."""
    return turn_towards_rad(campus, campus.corridor(came_from, post).heading_arriving(post), post, neighbour)


def next_post(campus: CampusMap, post: str, destination: str, avoid: frozenset[str] = frozenset()) -> str | None:
    """The neighbour to drive to, None when already there. Raises UnknownPost, NoRoute."""
    route = shortest_route(campus, post, destination, avoid).posts
    return route[1] if len(route) > 1 else None


def kept_from(
    campus: CampusMap, aside: Leg | None, here: str | None, destination: str | None, avoided: frozenset[str]
) -> frozenset[str]:
    """Return `avoided`, and for a robot that is sent `aside`, straight to its destination, every other corridor here.

    The shortest way there may begin with another corridor, or one with another be as short: that one is not granted.
    """
    if aside is None or (aside.from_post, aside.to_post) != (here, destination):
        return avoided
    others = frozenset(one.name for post, one in campus.neighbours(aside.from_post) if post.name != destination)
    return avoided if corridor_name(aside.from_post, aside.to_post) in avoided else avoided | others
