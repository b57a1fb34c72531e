"""Robots without a schedule: they lock corridors and bays as they come to them, or a whole way before they leave."""

import heapq
from collections import Counter
from dataclasses import dataclass, field

from benchmarks.fleet.demand import HANDLING_S, Order, Saturated
from benchmarks.fleet.grounds import Ground
from benchmarks.fleet.world import DeadlockError


@dataclass
class Driver:
    """`way`: posts to come. `locked`: corridors that are its own. `stops`: where it handles something, in order."""

    post: int
    stops: list[int] = field(default_factory=list)
    way: list[int] = field(default_factory=list)
    locked: set[int] = field(default_factory=set)
    in_a_bay: bool = False
    busy_until_s: float = 0.0


class Locks:
    """First come first served. `whole_way`: all corridors to the next stop and a bay there are locked at once, the
    corridors until it is reached; else the next corridor, until it is left, and the bay behind it."""

    def __init__(self, ground: Ground, robots: int, seed: int, *, whole_way: bool) -> None:
        self.network = ground.network
        self._whole_way = whole_way
        self._demand = Saturated(len(ground.network.posts), seed)
        self._drivers = [Driver(home) for home in ground.homes(robots).values()]
        self._bays: Counter[int] = Counter()
        self._locked: set[int] = set()
        self.now_s = 0.0
        self.delivered = 0

    def run(self, until_s: float) -> None:
        """Raises DeadlockError when no robot can go on."""
        ends = [(0.0, number) for number in range(len(self._drivers))]
        while self.now_s < until_s:
            waiting = [number for number, driver in enumerate(self._drivers) if driver.busy_until_s <= self.now_s]
            went = [number for number in waiting if self._go_on(self._drivers[number])]
            for number in went:
                heapq.heappush(ends, (self._drivers[number].busy_until_s, number))
            ends = [end for end in ends if end[0] > self.now_s]
            heapq.heapify(ends)
            if not went:
                if not ends:
                    raise DeadlockError(f"no robot can go on at {self.now_s:.0f} s")
                self.now_s = ends[0][0]

    def _go_on(self, driver: Driver) -> bool:
        """Go on with the robot; return whether it has begun something: a stop, or a way."""
        self._give_back(driver)  # it has arrived
        if not driver.way:
            self._next_way(driver)
            if driver.stops[0] == driver.post:
                return self._handle(driver)
        needed = driver.way if self._whole_way else driver.way[:1]
        lanes = [self.network.lane(*pair) for pair in zip([driver.post, *needed], needed, strict=False)]
        corridors = {lane.corridor for lane in lanes}
        if corridors & self._locked or self._bays[needed[-1]] >= self.network.bays[needed[-1]]:
            return False
        self._leave(driver, corridors, needed[-1])
        driver.busy_until_s = self.now_s + sum(lane.travel_s for lane in lanes)
        driver.post, driver.way = needed[-1], driver.way[len(needed) :]
        return True

    def _leave(self, driver: Driver, corridors: set[int], to: int) -> None:
        if driver.in_a_bay:
            self._bays[driver.post] -= 1
        self._bays[to] += 1
        driver.in_a_bay, driver.locked = True, corridors
        self._locked |= corridors

    def _give_back(self, driver: Driver) -> None:
        self._locked -= driver.locked
        driver.locked = set()

    def _handle(self, driver: Driver) -> bool:
        driver.stops.pop(0)
        self.delivered += not driver.stops
        driver.busy_until_s = self.now_s + HANDLING_S
        return True

    def _next_way(self, driver: Driver) -> None:
        if not driver.stops:
            order: Order = self._demand.waiting[0]
            self._demand.take(order, self.now_s)
            driver.stops = [order.start, order.end]
        driver.way = self._shortest(driver.post, driver.stops[0])

    def _shortest(self, start: int, end: int) -> list[int]:
        way, to_s = [], self.network.shortest_s
        while start != end:
            start = min(self.network.lanes[start], key=lambda lane: lane.travel_s + to_s[lane.end][end]).end
            way.append(start)
        return way
