"""Where the simulated robots drive: the two maps that come with the project, and shapes that are hard in other ways."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from random import Random
from typing import Final

from fleet.schedule.network import Lane, Network, network_of
from maps import CampusMap, builtin_map

TRAVEL_S: Final = 300.0
"""Assumed for every corridor of every map: the tunnels have not been driven yet."""
CLEARANCE_S: Final = 0.1


@dataclass(frozen=True)
class Ground:
    """`docks`: posts beside which robots have their home places, in turn."""

    name: str
    network: Network
    docks: tuple[int, ...]

    def homes(self, robots: int) -> dict[str, int]:
        return {f"r{number}": self.docks[number % len(self.docks)] for number in range(robots)}


def tunnels(bays: int = 2, following_s: float | None = None) -> Ground:
    return _of_map("carleton", bays, following_s)


def track(bays: int = 1, following_s: float | None = None) -> Ground:
    return _of_map("test_track", bays, following_s)


def loop(bays: int = 1, following_s: float | None = None, posts: int = 8) -> Ground:
    edges = [(post, (post + 1) % posts) for post in range(posts)]
    return _of_edges("loop", posts, edges, bays, following_s)


def grid(bays: int = 1, following_s: float | None = None, wide: int = 4, high: int = 3) -> Ground:
    along = [(post, post + 1) for post in range(wide * high) if (post + 1) % wide]
    across = [(post, post + wide) for post in range(wide * (high - 1))]
    return _of_edges("grid", wide * high, [*along, *across], bays, following_s)


def tree(bays: int = 1, following_s: float | None = None, posts: int = 10, seed: int = 0) -> Ground:
    rng = Random(seed)
    edges = [(rng.randrange(post), post) for post in range(1, posts)]
    return _of_edges("tree", posts, edges, bays, following_s)


GROUNDS: Final[dict[str, Callable[[int, float | None, int], Ground]]] = {
    "tunnels": lambda bays, following_s, _: tunnels(bays, following_s),
    "track": lambda bays, following_s, _: track(bays, following_s),
    "loop": lambda bays, following_s, _: loop(bays, following_s),
    "grid": lambda bays, following_s, _: grid(bays, following_s),
    "tree": lambda bays, following_s, seed: tree(bays, following_s, seed=seed),
}
"""By name: made of the number of bays at each post, the seconds of following, and a seed for what is random."""


def _of_map(name: str, bays: int, following_s: float | None) -> Ground:
    campus = builtin_map(name)
    network = network_of(campus, lambda *_: TRAVEL_S, lambda _: following_s, CLEARANCE_S)
    docks = tuple(map(network.number_of, home_docks(campus)))
    return Ground(name, replace(network, bays=(bays,) * len(network.posts)), docks)


def home_docks(campus: CampusMap) -> list[str]:
    """The posts with a dock in which a robot has its home."""
    return [campus.address_of(home.name) for home in campus.track.home_bays if home.dock]


def _of_edges(name: str, posts: int, edges: Iterable[tuple[int, int]], bays: int, following_s: float | None) -> Ground:
    lanes: list[list[Lane]] = [[] for _ in range(posts)]
    corridors = []
    for number, (a, b) in enumerate(edges):
        lanes[a].append(Lane(number, 0, a, b, TRAVEL_S, following_s))
        lanes[b].append(Lane(number, 1, b, a, TRAVEL_S, following_s))
        corridors.append(f"p{a}-p{b}")
    names = tuple(f"p{post}" for post in range(posts))
    network = Network(names, (bays,) * posts, tuple(corridors), tuple(map(tuple, lanes)), CLEARANCE_S)
    return Ground(name, network, (0, posts // 2))
