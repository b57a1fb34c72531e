"""Which way: turns derived from the map's geometry, never from a table kept by hand."""

import math
from enum import StrEnum

from maps import CampusMap, corridor_name, shortest_route
from maps.geometry import wrapped
from protocol.parts import Leg

PLAIN_TURNS = {"left": math.pi / 2, "right": -math.pi / 2, "behind": math.pi}


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
