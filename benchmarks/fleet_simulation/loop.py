"""Simulated time: an event loop that leaps to the next thing that happens, and the clock that goes by it.

Whatever waits by `asyncio`, the product's own workers among it, waits in simulated seconds. Nothing waits for real.
"""

import asyncio
import selectors
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from functools import partial
from time import perf_counter
from typing import Any, TypeVar

Answer = TypeVar("Answer")


class NothingHappensError(RuntimeError):
    """Every task waits for another, and no time limit ends it."""


class _Leaps(selectors.BaseSelector):
    """Where an event loop waits for its sockets, of which there are none: the time is over at once."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self._keys: dict[Any, selectors.SelectorKey] = {}

    def register(self, fileobj: Any, events: int, data: Any = None) -> selectors.SelectorKey:
        number = fileobj if isinstance(fileobj, int) else fileobj.fileno()
        self._keys[fileobj] = selectors.SelectorKey(fileobj, number, events, data)
        return self._keys[fileobj]

    def unregister(self, fileobj: Any) -> selectors.SelectorKey:
        return self._keys.pop(fileobj)

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        if timeout is None:
            raise NothingHappensError("every task waits, and for no moment: something has stopped without a word")
        self.now_s += max(0.0, timeout)
        return []

    def get_map(self) -> Mapping[Any, selectors.SelectorKey]:
        return self._keys


class SimulatedLoop(asyncio.SelectorEventLoop):
    """Time passes only while no task has anything to do. Work for threads is done at once, at no time; `beside_s`: how
    long each took by the clock on the wall, by the name of what was called."""

    def __init__(self) -> None:
        self.beside_s: dict[str, list[float]] = {}
        self._leaps = _Leaps()
        super().__init__(self._leaps)

    def time(self) -> float:
        return self._leaps.now_s

    def run_in_executor(  # type: ignore[override]
        self, executor: Any, func: Callable[..., Answer], *args: Any
    ) -> "asyncio.Future[Answer]":
        future: asyncio.Future[Answer] = self.create_future()
        begun_s = perf_counter()
        try:
            future.set_result(func(*args))
        except Exception as error:
            future.set_exception(error)
        self.beside_s.setdefault(_name_of(func), []).append(perf_counter() - begun_s)
        return future


def _name_of(func: Callable[..., Any]) -> str:
    """Of what `asyncio.to_thread` was given, behind the context that it runs in."""
    within = func.args[0] if isinstance(func, partial) and func.args else func
    return getattr(within, "__name__", type(within).__name__)


@dataclass(frozen=True)
class LoopClock:
    """The clock of service and robots alike."""

    loop: asyncio.AbstractEventLoop
    started_at: datetime = datetime(2026, 1, 5, tzinfo=UTC)
    """A Monday."""

    def now(self) -> float:
        return self.loop.time()

    def utc(self) -> datetime:
        return self.started_at + timedelta(seconds=self.loop.time())

    def real_s(self, duration_s: float) -> float:
        return duration_s
