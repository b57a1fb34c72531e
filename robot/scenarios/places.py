"""Where on the map something is: in a circle, in a corridor, at a post."""

import math
from itertools import pairwise

from maps import CampusMap, Corridor, Point
from maps.geometry import distance_to_path_m
from robot.scenarios.scenario import Place, Stander

AT_POST_M = 0.25
"""So near to a post, a robot stands at it as far as people are concerned."""
IN_CORRIDOR_M = 0.15
"""So near to the tape, a robot is in its corridor."""
POST_ROOM_M = 0.45
"""So far around a post, the room is the post's: who turns, stops or leaves a dock there is in no corridor yet."""


def is_in(place: Place, campus: CampusMap, x_m: float, y_m: float) -> bool:
    """Return whether the place covers this spot."""
    if place.corridor is not None:
        tape = campus.corridor_named(place.corridor).tape
        return distance_to_path_m(Point(x_m, y_m), tape) <= IN_CORRIDOR_M
    return place.at is None or math.dist(place.at, (x_m, y_m)) <= place.radius_m


def post_at(track: CampusMap, x_m: float, y_m: float, within_m: float = AT_POST_M) -> str | None:
    """The post or bay at which a person at this spot stands."""
    near = [(math.dist(post.point, (x_m, y_m)), post.name) for post in track.posts.values()]
    distance_m, name = min(near)
    return name if distance_m <= within_m else None


def corridor_at(track: CampusMap, x_m: float, y_m: float) -> str | None:
    """The corridor or spur in which a robot at this spot is; None at posts, in docks and away from every tape."""
    if post_at(track, x_m, y_m, POST_ROOM_M):
        return None
    here = Point(x_m, y_m)
    near = [(distance_to_path_m(here, one.tape), one.name) for one in track.corridors]
    distance_m, name = min(near)
    return name if distance_m <= IN_CORRIDOR_M else None


def stands_at(stander: Stander, campus: CampusMap) -> Point:
    """Where a person stands in the way."""
    if stander.at is not None:
        return Point(*stander.at)
    corridor = campus.corridor_named(stander.corridor or "")
    return along(corridor, stander.along)


def along(corridor: Corridor, share: float) -> Point:
    """The point of the tape at this share of its length, from `corridor.a`."""
    legs = list(pairwise(corridor.tape))
    left_m = share * sum(math.dist(a, b) for a, b in legs)
    for a, b in legs:
        length_m = math.dist(a, b)
        if left_m <= length_m:
            part = left_m / length_m
            return Point(a.x_m + (b.x_m - a.x_m) * part, a.y_m + (b.y_m - a.y_m) * part)
        left_m -= length_m
    return corridor.tape[-1]
