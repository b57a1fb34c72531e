"""The shortest way between two posts, in metres: A* with the straight line as its estimate.

The straight line never overestimates, because a corridor shorter than it is refused when the map is read (the paper's
prototype gave corridors of 2 m the cost 1, and its search could return a detour).
"""

from collections.abc import Set
from dataclasses import dataclass
from heapq import heappop, heappush

from maps.campus_map import CampusMap
from maps.errors import NoRoute
from maps.geometry import distance_m


@dataclass(frozen=True)
class Route:
    """The posts from start to goal, both included, and the metres of corridor between them."""

    posts: tuple[str, ...]
    length_m: float


def shortest_route(campus: CampusMap, start: str, goal: str, avoid: Set[str] = frozenset()) -> Route:
    """The shortest route that uses no corridor named in `avoid`; of equally short ones always the same.

    Raises UnknownPost, UnknownCorridor (for a name in `avoid`) and NoRoute.
    """
    destination = campus.post(goal).point
    waiting: list[tuple[float, tuple[str, ...], float]] = [
        (distance_m(campus.post(start).point, destination), (start,), 0.0)
    ]
    for name in avoid:
        campus.corridor_named(name)
    settled: set[str] = set()
    while waiting:
        _, path, length_m = heappop(waiting)
        here = path[-1]
        if here == goal:
            return Route(path, length_m)
        if here in settled:
            continue
        settled.add(here)
        for post, corridor in campus.neighbours(here):
            if post.name not in settled and corridor.name not in avoid:
                so_far_m = length_m + corridor.length_m
                heappush(waiting, (so_far_m + distance_m(post.point, destination), (*path, post.name), so_far_m))
    raise NoRoute(start, goal, _reason(avoid))


def lengths_from(campus: CampusMap, start: str) -> dict[str, float]:
    """Return the metres to each post that can be reached, found in one search. Raises UnknownPost."""
    waiting, lengths_m = [(0.0, campus.post(start).name)], dict[str, float]()
    while waiting:
        length_m, here = heappop(waiting)
        if here not in lengths_m:
            lengths_m[here] = length_m
            for post, corridor in campus.neighbours(here):
                if post.name not in lengths_m:
                    heappush(waiting, (length_m + corridor.length_m, post.name))
    return lengths_m


def _reason(avoid: Set[str]) -> str:
    return (
        f"every way uses a corridor to be avoided ({', '.join(sorted(avoid))})" if avoid else "no corridors lead there"
    )
