"""Orders that wait: always the same few (saturated), or as they come in the course of a day (rush hours)."""

from collections.abc import Iterator
from math import inf
from random import Random
from typing import Final, NamedTuple, Protocol

HANDLING_S: Final = 60.0
"""Assumed for loading and for handing over."""
A_DAY_H: Final = (0, 0, 0, 0, 0, 0, 0, 1, 3, 4, 3, 2, 2, 2, 3, 4, 3, 1, 0, 0, 0, 0, 0, 0)
"""How many orders come in each hour of a day, as parts of the whole: two rush hours."""


class Order(NamedTuple):
    number: int
    start: int
    end: int
    placed_s: float


class Demand(Protocol):
    waiting: list[Order]
    next_s: float

    def pass_time(self, now_s: float) -> None:
        """Orders placed by then are waiting."""

    def take(self, order: Order, now_s: float) -> None:
        """A robot carries it."""


class Saturated:
    """So many orders are always waiting: one more comes when one is taken. What comes depends on the seed alone."""

    next_s = inf

    def __init__(self, posts: int, seed: int, waiting: int = 5) -> None:
        self._coming = trips(posts, Random(seed))
        self._number = 0
        self.waiting: list[Order] = []
        for _ in range(waiting):
            self._place(0.0)

    def pass_time(self, now_s: float) -> None:
        pass

    def take(self, order: Order, now_s: float) -> None:
        self.waiting.remove(order)
        self._place(now_s)

    def _place(self, now_s: float) -> None:
        self.waiting.append(Order(self._number, *next(self._coming), now_s))
        self._number += 1


class RushHours:
    """Orders placed at random moments, so many a day, most of them in the rush hours."""

    def __init__(self, posts: int, seed: int, orders_a_day: float) -> None:
        rng = Random(seed)
        self._coming = self._orders(posts, rng, orders_a_day)
        self._next = next(self._coming)
        self.waiting: list[Order] = []

    @property
    def next_s(self) -> float:
        return self._next.placed_s

    def pass_time(self, now_s: float) -> None:
        while self._next.placed_s <= now_s:
            self.waiting.append(self._next)
            self._next = next(self._coming)

    def take(self, order: Order, now_s: float) -> None:
        self.waiting.remove(order)

    def _orders(self, posts: int, rng: Random, orders_a_day: float) -> Iterator[Order]:
        """Moments of the highest rate, of which in quieter hours only a share is kept."""
        most_an_hour = orders_a_day * max(A_DAY_H) / sum(A_DAY_H)
        at_s = 0.0
        for number, (start, end) in enumerate(trips(posts, rng)):
            keep = 0.0
            while rng.random() >= keep:
                at_s += rng.expovariate(most_an_hour / 3600.0)
                keep = A_DAY_H[int(at_s // 3600) % 24] / max(A_DAY_H)
            yield Order(number, start, end, at_s)


def trips(posts: int, rng: Random) -> Iterator[tuple[int, int]]:
    """From any post to any other."""
    while True:
        start, end = rng.sample(range(posts), 2)
        yield start, end
