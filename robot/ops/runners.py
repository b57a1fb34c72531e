"""Two ways to run the same table of loops.

`ThreadedRunner` is for hardware: a thread for each loop, on the machine's own time. `LockstepRunner` is for a simulated
world: one thread, every tick at exactly its simulated time and in the order of the table, chasing a clock that may run
faster than the machine can follow; then it is this runner that slows the clock down.
"""

import math
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from heapq import heapify, heapreplace
from typing import Protocol

import structlog

from protocol.clock import Clock, SharedClock, SteppedClock

log = structlog.get_logger("robot.runner")

SLOWEST = 0.25
LOOK_REAL_S = 0.2
CATCH_UP = 0.75
LAG_REAL_S = 0.25
"""A clock that is ahead by more than passes in this time is slowed down."""
LONGEST_NAP_S = 0.02
STOP_WITHIN_S = 1.0
SWITCH_INTERVAL_S = 0.0005
KEPT_LAGS = 4000
"""20 s of the quickest loop."""


@dataclass(frozen=True)
class Loop:
    """Something that is done `rate_hz` times a second. `feeds` says who lives on it."""

    name: str
    rate_hz: float
    feeds: str
    tick: Callable[[float], None]
    at_end: Callable[[], None] = lambda: None
    """Done by the loop's own thread when it ends, whatever ended it: it waits for no other thread."""
    woken_by: threading.Event | None = None
    """On threads: tick at once when this is set, not only when the loop is due; the tick clears it."""


@dataclass
class Lag:
    """The punctuality of a loop: seconds of the daemon's clock. Shares are of the newest `KEPT_LAGS` ticks."""

    ticks: int = 0
    worst_s: float = 0.0
    newest_s: deque[float] = field(default_factory=lambda: deque(maxlen=KEPT_LAGS))

    def note(self, late_s: float) -> None:
        self.ticks += 1
        self.worst_s = max(self.worst_s, late_s)
        self.newest_s.append(late_s)

    def share_s(self, share: float) -> float:
        """So late were at most this share of the ticks: 0.5 the median, 0.99 nearly all. Any thread may ask."""
        newest_s = sorted(self.newest_s)
        return newest_s[min(len(newest_s) - 1, math.floor(share * len(newest_s)))] if newest_s else 0.0


class Runner(Protocol):
    """Runs until told to stop, or until a loop raises: then it stops all of them and raises that."""

    lags: dict[str, Lag]
    now_s: float
    """The daemon's time that the loops have reached."""

    def run(self) -> None: ...

    def stop(self) -> None: ...


class LockstepRunner:
    """One thread. The clock decides what time it is; a SteppedClock is moved along, as fast as it goes."""

    def __init__(self, loops: Sequence[Loop], clock: Clock, max_speed: float = 1.0) -> None:
        self.lags = {loop.name: Lag() for loop in loops}
        self._loops = tuple(loops)
        self._clock = clock
        self._stopping = threading.Event()
        self.now_s = clock.now()
        self._due = [(self.now_s, number) for number in range(len(loops))]
        heapify(self._due)
        self._governor = Governor(max_speed)

    def stop(self) -> None:
        self._stopping.set()

    def restart(self) -> None:
        """`run` may be called again, and goes on where it stopped."""
        self._stopping.clear()

    def run(self) -> None:
        while not self._stopping.is_set():
            if isinstance(self._clock, SteppedClock):
                self._step_free(self._clock)
            else:
                self._chase()

    def _step_free(self, clock: SteppedClock) -> None:
        clock.now_s = max(clock.now_s, self._due[0][0])
        self._tick_next()

    def _chase(self) -> None:
        began_s, begun_at_s = time.perf_counter(), self.now_s
        until_s = self._clock.now()
        while self._due[0][0] <= until_s and not self._stopping.is_set():
            self._tick_next()
            if time.perf_counter() - began_s > LOOK_REAL_S:
                break
        self._govern(self.now_s - begun_at_s, time.perf_counter() - began_s)
        ahead_s = self._due[0][0] - self._clock.now()
        if ahead_s > 0:
            time.sleep(min(self._clock.real_s(ahead_s), LONGEST_NAP_S))

    def _tick_next(self) -> None:
        due_s, number = self._due[0]
        loop = self._loops[number]
        self.now_s = due_s
        loop.tick(due_s)
        self.lags[loop.name].note(max(0.0, self._clock.now() - due_s))
        heapreplace(self._due, (due_s + 1.0 / loop.rate_hz, number))

    def _govern(self, done_s: float, worked_s: float) -> None:
        if not isinstance(self._clock, SharedClock):
            return
        lag_s = self._clock.now() - self._due[0][0]
        speed = self._governor.speed(self._clock.speed, lag_s, done_s, worked_s, time.perf_counter())
        if speed != self._clock.speed:
            self._clock.set_speed(speed)


@dataclass
class Governor:
    """The speed limit of a shared clock, so that the world keeps up with it.

    A short lag is made up for by working on; only one that lasts slows the clock down, since other programs on the
    same machine take their turns too. With time to spare the clock goes faster again, up to what was asked.
    """

    max_speed: float
    _worked_s: float = 0.0
    _done_s: float = 0.0
    _since_s: float = field(default_factory=time.perf_counter)

    def speed(self, speed: float, lag_s: float, done_s: float, worked_s: float, real_s: float) -> float:
        """The speed from now on. `done_s` of the scaled clock were worked off in `worked_s` of the machine's."""
        self._worked_s += worked_s
        self._done_s += done_s
        elapsed_s = real_s - self._since_s
        if elapsed_s < LOOK_REAL_S:
            return speed
        possible = self._done_s / self._worked_s if self._worked_s else math.inf
        busy = self._worked_s / elapsed_s
        self._worked_s, self._done_s, self._since_s = 0.0, 0.0, real_s
        if lag_s > speed * LAG_REAL_S:
            # A little slower than what is possible, so that the lag melts away.
            return min(speed, max(SLOWEST, CATCH_UP * possible))
        return min(self.max_speed, speed * 1.25) if busy < 0.85 else speed


class ThreadedRunner:
    """A thread for each loop. A late loop never runs twice to catch up: the wheels need the present, not the past.

    A thread that hangs does not hold up the others: they end without it, each with its `at_end`.
    """

    def __init__(self, loops: Sequence[Loop], clock: Clock) -> None:
        self.lags = {loop.name: Lag() for loop in loops}
        self.now_s = clock.now()
        self._clock = clock
        self._stopping = threading.Event()
        self._failure: BaseException | None = None
        self._wakers = [loop.woken_by for loop in loops if loop.woken_by]
        self._threads = [
            threading.Thread(target=self._run_loop, args=(loop,), name=loop.name, daemon=True) for loop in loops
        ]

    def stop(self) -> None:
        self._stopping.set()
        for event in self._wakers:
            event.set()

    def run(self) -> None:
        # A thread that computes hands over after so long: the wheels' loop must not wait for the mind's.
        sys.setswitchinterval(SWITCH_INTERVAL_S)
        for thread in self._threads:
            thread.start()
        self._stopping.wait()
        until_s = time.monotonic() + STOP_WITHIN_S
        for thread in self._threads:
            thread.join(max(0.0, until_s - time.monotonic()))
        if self._failure:
            raise self._failure

    def _run_loop(self, loop: Loop) -> None:
        try:
            self._tick_until_stopped(loop)
        except BaseException as failure:
            self._failure = self._failure or failure
            self._end(loop)
            log.exception("loop_failed", loop=loop.name)  # last: a log that hangs must not keep the wheels turning
        else:
            self._end(loop)

    def _tick_until_stopped(self, loop: Loop) -> None:
        period_s, due_s = 1.0 / loop.rate_hz, self._clock.now()
        while True:
            (loop.woken_by or self._stopping).wait(max(0.0, due_s - self._clock.now()))
            if self._stopping.is_set():
                return
            now = self.now_s = self._clock.now()
            self.lags[loop.name].note(max(0.0, now - due_s))
            loop.tick(now)
            due_s = max(due_s + period_s, self._clock.now())

    def _end(self, loop: Loop) -> None:
        self.stop()
        loop.at_end()
