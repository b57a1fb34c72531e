"""Every connected map of a few posts, and on it every place in which robots can stand and still all come home."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations, permutations, product

from fleet.schedule.network import Lane, Network

TRAVEL_S = 10.0
AT_HOME = -1
Edges = frozenset[tuple[int, int]]
Places = tuple[int, ...]
"""Of each robot: the post in whose bay it stands, or AT_HOME."""


def connected_maps(posts: int) -> Iterator[Edges]:
    """Every connected graph with so many posts, each shape once."""
    pairs = list(combinations(range(posts), 2))
    seen: set[Edges] = set()
    for chosen in product((False, True), repeat=len(pairs)):
        edges = frozenset(pair for pair, is_there in zip(pairs, chosen, strict=True) if is_there)
        if edges not in seen and _is_connected(posts, edges):
            yield edges
            seen.update(_renumbered(posts, edges))


def network_on(posts: int, edges: Edges, bays: tuple[int, ...]) -> Network:
    lanes: list[list[Lane]] = [[] for _ in range(posts)]
    for number, (a, b) in enumerate(sorted(edges)):
        lanes[a].append(Lane(number, 0, a, b, TRAVEL_S))
        lanes[b].append(Lane(number, 1, b, a, TRAVEL_S))
    names = tuple(f"p{post}" for post in range(posts))
    corridors = tuple(f"p{a}-p{b}" for a, b in sorted(edges))
    return Network(names, bays, corridors, tuple(tuple(out) for out in lanes))


@dataclass(frozen=True)
class Fleet:
    """A network with the home of each robot."""

    network: Network
    homes: tuple[int, ...]

    def places_that_come_home(self) -> Mapping[Places, int]:
        """Return the places from which every robot can come home by one move after another, with the number of moves:
        found backwards from all at home, with nothing of the code that is tested."""
        home = tuple(AT_HOME for _ in self.homes)
        known, ahead = {home: 0}, [home]
        for places in ahead:
            for before in self._moves_back(places):
                if before not in known:
                    known[before] = known[places] + 1
                    ahead.append(before)
        return known

    def _moves_back(self, places: Places) -> Iterator[Places]:
        for robot, place in enumerate(places):
            for came_from in self._could_have_been(robot, place):
                before = (*places[:robot], came_from, *places[robot + 1 :])
                if self._have_room(before):
                    yield before

    def _could_have_been(self, robot: int, place: int) -> Iterator[int]:
        """Where it was one move ago: at a neighbour, or at its own post in the bay or at home."""
        home = self.homes[robot]
        if place in (AT_HOME, home):
            yield home if place == AT_HOME else AT_HOME
        for lane in self.network.lanes[home if place == AT_HOME else place]:
            yield lane.end
            if lane.end == home:
                yield AT_HOME

    def _have_room(self, places: Places) -> bool:
        return all(places.count(post) <= bays for post, bays in enumerate(self.network.bays))


def _is_connected(posts: int, edges: Edges) -> bool:
    reached, ahead = {0}, [0]
    for post in ahead:
        for a, b in edges:
            if post in (a, b) and (other := a + b - post) not in reached:
                reached.add(other)
                ahead.append(other)
    return len(reached) == posts


def _renumbered(posts: int, edges: Edges) -> Iterator[Edges]:
    for order in permutations(range(posts)):
        yield frozenset((min(order[a], order[b]), max(order[a], order[b])) for a, b in edges)
