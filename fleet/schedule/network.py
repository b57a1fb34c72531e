"""The campus as a schedule sees it: posts with bays, and each corridor as two lanes, all by number.

Numbers instead of names, since a search looks at them some thousand times for one decision.
"""

import heapq
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf
from typing import NamedTuple

from maps import CampusMap, Corridor, Post


class Lane(NamedTuple):
    """One corridor in one direction. `backwards` is 1 from the corridor's b to its a, else 0; `following_s`: see
    `Network`."""

    corridor: int
    backwards: int
    start: int
    end: int
    travel_s: float
    following_s: float | None = None


@dataclass(frozen=True)
class Network:
    """`bays[p]` robots can stand at post p at the same time, those at home there not counted. `lanes[p]` lead away from
    post p.

    A corridor is for one robot at a time; where its lanes have a `following_s`, further ones may enter in the same
    direction so many seconds after each other. `clearance_s` lies between a robot's leaving and another's entering.

    The crossing of a post is where its lines meet, those of its bays and homes too: one robot at a time, and
    `crossing_s[p]` seconds for one move over it. 0.0 where bays have no place on the floor: such a crossing is
    held by no robot. No robot can move over a crossing that is `shut`.
    """

    posts: tuple[str, ...]
    bays: tuple[int, ...]
    corridors: tuple[str, ...]
    lanes: tuple[tuple[Lane, ...], ...]
    clearance_s: float = 0.1
    crossing_s: tuple[float, ...] = ()
    shut: frozenset[int] = frozenset()
    _number: Mapping[str, int] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_number", {name: number for number, name in enumerate(self.posts)})
        if not self.crossing_s:
            object.__setattr__(self, "crossing_s", (0.0,) * len(self.posts))

    def number_of(self, post: str) -> int:
        """Raises KeyError for a post that is not on the map."""
        return self._number[post]

    def lane(self, start: int, end: int) -> Lane:
        """The lane between two neighbours. Raises LookupError if they are none."""
        for lane in self.lanes[start]:
            if lane.end == end:
                return lane
        raise LookupError(f"no corridor leads from {self.posts[start]} to {self.posts[end]}")

    def takes_s(self, lane: Lane) -> float:
        """Seconds from a stay to the end of the lane: over the crossing, and through."""
        return self.crossing_s[lane.start] + lane.travel_s

    @cached_property
    def has_crossings(self) -> bool:
        return any(self.crossing_s)

    @cached_property
    def shortest_s(self) -> tuple[tuple[float, ...], ...]:
        """Seconds from a stay to a stay on empty corridors, row by start; infinite where no way leads. No way leads
        through a post without a bay."""
        return tuple(_shortest_from(start, self) for start in range(len(self.posts)))

    def next_post(self, post: int, goal: int) -> int:
        """The next one on the quickest way on empty corridors. Raises ValueError where no way leads."""
        shortest_s, crossing_s = self.shortest_s, self.crossing_s
        ways = ((crossing_s[post] + lane.travel_s + shortest_s[lane.end][goal], lane.end) for lane in self.lanes[post])
        least_s, end = min(ways, default=(inf, post))
        if least_s == inf:
            raise ValueError(f"no way leads from {self.posts[post]} to {self.posts[goal]}")
        return end

    def without(self, closed: Collection[str], shut: Collection[int] = ()) -> "Network":
        """The same with some corridors closed, named as the map names them, and the crossings of some posts shut."""
        closed_too = {number for number, name in enumerate(self.corridors) if name in closed}
        open_lanes = tuple(
            tuple(lane for lane in out if lane.corridor not in closed_too and not {lane.start, lane.end} & {*shut})
            for out in self.lanes
        )
        return replace(self, lanes=open_lanes, shut=self.shut | {*shut})


def network_of(
    campus: CampusMap,
    travel_s: Callable[[Corridor, str], float],
    following_s: Callable[[Corridor], float | None] = lambda _: None,
    clearance_s: float = 0.1,
    crossing_s: Callable[[Post], float] = lambda _: 0.0,
) -> Network:
    """The network of a campus map; `travel_s` says how long a corridor takes that is entered at a post, `crossing_s`
    how long one move over the crossing of a post."""
    posts = tuple(campus.posts)
    number = {name: at for at, name in enumerate(posts)}
    lanes: list[list[Lane]] = [[] for _ in posts]
    for at, corridor in enumerate(campus.corridors):
        for backwards, start in enumerate((corridor.a, corridor.b)):
            end = corridor.other(start)
            time_s, after_s = travel_s(corridor, start), following_s(corridor)
            lanes[number[start]].append(Lane(at, backwards, number[start], number[end], time_s, after_s))
    return Network(
        posts,
        tuple(campus.posts[name].bays for name in posts),
        tuple(corridor.name for corridor in campus.corridors),
        tuple(tuple(out) for out in lanes),
        clearance_s,
        tuple(crossing_s(campus.posts[name]) for name in posts),
    )


def _shortest_from(start: int, network: Network) -> tuple[float, ...]:
    lanes, bays, crossing_s = network.lanes, network.bays, network.crossing_s
    time_s = [inf] * len(lanes)
    time_s[start] = 0.0
    ahead = [(0.0, start)]
    while ahead:
        so_far_s, post = heapq.heappop(ahead)
        if so_far_s > time_s[post] or (bays[post] < 1 and post != start):
            continue
        for lane in lanes[post]:
            there_s = so_far_s + crossing_s[post] + lane.travel_s
            if there_s < time_s[lane.end]:
                time_s[lane.end] = there_s
                heapq.heappush(ahead, (there_s, lane.end))
    # The last crossing leads into the bay.
    return tuple(one if post == start else one + crossing_s[post] for post, one in enumerate(time_s))
