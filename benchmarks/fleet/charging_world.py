"""A campus on which robots run low: orders by the hour, ways that take longer than they should, corridors that fail.

Traffic is simulated only as waits (see `benchmarks/fleet/charging.py` for what that leaves out). Robots carry one item.
"""

import heapq
from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from math import inf
from random import Random
from typing import Final

from benchmarks.fleet.grounds import home_docks
from benchmarks.fleet.packs import Pack, some_pack
from fleet.charging.energy import Use
from fleet.schedule.network import Lane, Network, network_of
from maps import CampusMap, builtin_map
from maps.ways import Ways

SPEED_M_S: Final = 0.2
HANDLING_S: Final = 60.0
BEGINS: Final = datetime(2026, 1, 5, tzinfo=UTC)
"""A Monday."""
DAY_S: Final = 86400.0
BY_HOUR: Final = (0.1,) * 7 + (0.6, 1.6, 2.0, 1.8, 1.2, 1.0, 1.6, 1.8, 1.6, 1.2, 0.7, 0.3) + (0.1,) * 5
"""How many orders come in an hour, as a multiple of the usual: nights are quiet, mornings and afternoons are not."""
WEEKEND: Final = 0.2
CLOSED_EVERY_S: Final = 12 * 3600.0
CLOSED_S: Final = (600.0, 3600.0)
OWN_LOW, OWN_FULL, OWN_BEGIN = 0.25, 0.99, 0.53
"""The robot's own battery plan (robot/core/config.py)."""
EMPTY: Final = 0.01
WORTH_A_WAY_ROUND_S: Final = 600.0

Task = Generator[float, None, None]


@dataclass
class Job:
    """An order. `unplanned`: its robot broke off to charge; `planned`: it charged on the way, as was meant."""

    number: int
    from_post: int
    to_post: int
    placed_s: float
    robot: str = ""
    begun_s: float = inf
    done_s: float = inf
    unplanned: bool = False
    planned: bool = False
    kept_waiting_by_charge: bool = False

    @property
    def is_done(self) -> bool:
        return self.done_s < inf


@dataclass
class Robot:
    """`task`: what it does (None: nothing). `at_s`: until when its pack is up to date."""

    name: str
    post: int
    pack: Pack
    at_s: float = 0.0
    dock: str | None = None
    bound_for: str | None = None
    until: float = OWN_BEGIN
    task: Task | None = None
    job: Job | None = None
    recharging: bool = False
    driven_m: float = 0.0


@dataclass
class Campus:
    """The map, with corridors that are closed at times."""

    campus: CampusMap
    network: Network
    length_m: Mapping[int, float]
    docks: Mapping[str, int]
    ways: Ways
    closed: set[str] = field(default_factory=set)
    _open: dict[frozenset[str], Network] = field(default_factory=dict)

    @property
    def now_open(self) -> Network:
        shut = frozenset(self.closed)
        if shut not in self._open:
            self._open[shut] = self.network.without(shut) if shut else self.network
        return self._open[shut]

    def next_lane(self, post: int, to: int) -> Lane | None:
        """Of the shortest way; None while it is closed and no way round is short: then waiting costs less charge."""
        network = self.now_open
        way_s = network.shortest_s[post][to]
        if way_s == inf or way_s > self.network.shortest_s[post][to] + WORTH_A_WAY_ROUND_S:
            return None
        return min(network.lanes[post], key=lambda lane: lane.travel_s + network.shortest_s[lane.end][to])

    def use(self, post: int, to: int) -> Use:
        """A way as the service expects it; where a corridor is closed, by another way (infinite, if there is none)."""
        time_s = self.now_open.shortest_s[post][to]
        return Use(time_s * SPEED_M_S, time_s)

    def ways_to_docks(self, post: int) -> dict[str, Use]:
        return {name: use for name, at in self.docks.items() if (use := self.use(post, at)).time_s < inf}


def carleton() -> Campus:
    campus = builtin_map("carleton")
    network = network_of(campus, lambda corridor, _: corridor.length_m / SPEED_M_S)
    lengths = {number: corridor.length_m for number, corridor in enumerate(campus.corridors)}
    docks = {post: network.number_of(post) for post in home_docks(campus)}
    return Campus(campus, network, lengths, docks, Ways(campus))


class Clockwork:
    """Events by time, in seconds; tasks say for how long they do something."""

    def __init__(self) -> None:
        self.now_s, self.events = 0.0, 0
        self._ahead: list[tuple[float, int, Callable[[], None]]] = []
        self._count = 0

    def at(self, time_s: float, call: Callable[[], None]) -> None:
        self._count += 1
        heapq.heappush(self._ahead, (time_s, self._count, call))

    def run(self, until_s: float) -> None:
        while self._ahead and self._ahead[0][0] <= until_s:
            self.now_s, _, call = heapq.heappop(self._ahead)
            self.events += 1
            call()
        self.now_s = until_s

    @property
    def local(self) -> datetime:
        return BEGINS + timedelta(seconds=self.now_s)


def some_robots(rng: Random, campus: Campus, number: int) -> dict[str, Robot]:
    posts = range(len(campus.network.posts))
    return {name: Robot(name, rng.choice(posts), some_pack(rng)) for name in (f"r{at}" for at in range(number))}


def orders_an_hour(at: datetime, mean: float) -> float:
    rate = BY_HOUR[at.hour] / (sum(BY_HOUR) / 24)
    return mean * rate * (WEEKEND if at.weekday() >= 5 else 1.0)
