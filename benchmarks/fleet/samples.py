"""The amount of simulation of the fleet."""

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from typing import TypeVar

Job = TypeVar("Job")
Result = TypeVar("Result")


@dataclass(frozen=True, slots=True)
class Samples:
    """`seeds` of each fleet, for so many `days`; `posts` of the largest maps that are looked at exhaustively.
    `workers`: processes at the same time."""

    seeds: int = 5
    posts: int = 5
    days: float = 5.0
    first_seed: int = 1
    workers: int = os.cpu_count() or 1

    def with_workers(self, workers: int) -> "Samples":
        return replace(self, workers=workers)

    def some_seeds(self) -> range:
        return range(self.first_seed, self.first_seed + self.seeds)

    def each(self, work: Callable[[Job], Result], jobs: Iterable[Job]) -> Iterator[Result]:
        """In the order of the jobs, several at the same time."""
        if self.workers < 2:
            yield from map(work, jobs)
            return
        with ProcessPoolExecutor(self.workers) as processes:
            yield from processes.map(work, jobs)
