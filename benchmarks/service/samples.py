"""The amount measured, and a room for each part to measure it in."""

import asyncio
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from benchmarks.service.figures import times


@dataclass(frozen=True, slots=True)
class Samples:
    """The sizes that the issue names, unless others are given."""

    seconds: float = 20.0
    rounds: int = 5
    robots: int = 100
    followers: int = 500
    history: int = 100_000
    backlog: int = 2000
    first_seed: int = 1
    data: Path | None = None

    @contextmanager
    def folder(self) -> Iterator[Path]:
        """On the disk whose syncs are part of what is measured: a folder in memory would make them free."""
        if self.data is not None:
            self.data.mkdir(parents=True, exist_ok=True)
        with TemporaryDirectory(prefix="bench-service-", dir=self.data) as name:
            yield Path(name)


@dataclass
class Punctuality:
    """The lateness of the load generator itself: what it calls slow must be the service's doing and not its own."""

    late_s: list[float] = field(default_factory=list)

    async def watch(self) -> None:
        while True:
            due_s = time.perf_counter() + 0.01
            await asyncio.sleep(0.01)
            self.late_s.append(time.perf_counter() - due_s)

    def figures(self) -> dict[str, Any]:
        return times(self.late_s)


async def until(what: Callable[[], bool], limit_s: float) -> None:
    """Look every now and then, for no longer than this: what has not come by then is counted."""
    end_s = time.perf_counter() + limit_s
    while not what() and time.perf_counter() < end_s:  # noqa: ASYNC110  # another process rings no bell of ours
        await asyncio.sleep(0.02)
