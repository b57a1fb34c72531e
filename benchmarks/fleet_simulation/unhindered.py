"""What robots would deliver that could pass through each other: the measure of what single lines cost.

It runs nothing of the product: each robot goes to the nearest order that waits, carries it and takes the next. What
its moves and people take is drawn from the table of the simulation.
"""

import heapq
from itertools import pairwise
from random import Random

from benchmarks.fleet_simulation.driving import is_spur, parts_of
from benchmarks.fleet_simulation.durations import FITTED, Taking
from benchmarks.fleet_simulation.figures import AGE_LIMIT_S
from maps import CampusMap, shortest_route
from protocol.parts import Leg, Purpose


class Unhindered:
    """`free`: so many orders always wait that no robot has gone for."""

    def __init__(self, campus: CampusMap, free: int, seed: int) -> None:
        self._track = campus.track
        self._posts, self._orders = sorted(campus.posts), Random(f"{seed} orders")
        self._taking, self._rng = Taking(campus, FITTED, seed), Random(f"{seed} unhindered")
        self._waiting = [(0.0, *self._orders.sample(self._posts, 2)) for _ in range(free)]

    def delivered(self, homes: list[str], hours: float) -> int:
        """Return how many orders so many robots deliver from these homes on, each with one letter at a time."""
        until_s, count = hours * 3600.0, 0
        free = [(0.0, number, home) for number, home in enumerate(homes)]
        heapq.heapify(free)
        while free[0][0] < until_s:
            now_s, robot, place = heapq.heappop(free)
            start, end = self._take(place, now_s)
            loaded_s = self._served_s(now_s + self.drive_s(place, start), Purpose.LOAD)
            done_s = self._served_s(loaded_s + self.drive_s(start, end), Purpose.RECEIVE)
            count += done_s <= until_s
            heapq.heappush(free, (done_s, robot, end))
        return count

    def drive_s(self, start: str, end: str) -> float:
        """From bay to bay: as a body does it, with a turn at each post."""
        table, took_s, came_by = self._taking.table, 0.0, None
        if self._track.address_of(start) == self._track.address_of(end):
            return 0.0
        for leg in (Leg(from_post=a, to_post=b) for a, b in pairwise(self._way(start, end))):
            if came_by is not None:
                through = not (is_spur(self._track, came_by) or is_spur(self._track, leg))
                took_s += (table.straight_on if through else table.turn).draw_s(self._rng)
            took_s += sum(part.left_s for part in parts_of(self._track, self._taking, leg, self._rng))
            came_by = leg
        return took_s

    def _take(self, place: str, now_s: float) -> tuple[str, str]:
        oldest = min(self._waiting)
        is_late = now_s - oldest[0] > AGE_LIMIT_S
        order = oldest if is_late else min(self._waiting, key=lambda one: (self._way_m(place, one[1]), one))
        self._waiting.remove(order)
        self._waiting.append((now_s, *self._orders.sample(self._posts, 2)))
        return order[1], order[2]

    def _way_m(self, place: str, post: str) -> float:
        return shortest_route(self._track, place, post).length_m

    def _served_s(self, at_s: float, purpose: Purpose) -> float:
        return at_s + self._taking.person_s(purpose, at_s, self._rng) + self._taking.table.reached_in_s

    def _way(self, start: str, end: str) -> tuple[str, ...]:
        return shortest_route(self._track, self._a_bay(start), self._a_bay(end)).posts

    def _a_bay(self, place: str) -> str:
        passing = [bay.name for bay in self._track.bays_of(place) if bay.is_for_passing]
        return place if self._track.post(place).bay_of else passing[0]
