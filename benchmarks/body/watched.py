"""The cost of watching a robot's mind, and of not watching: processor time of the mind's thread, in simulated time.

The same errands twice. What the link's thread does with a report is measured apart: it delays no other thread.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

from benchmarks.body.errands import Errands
from benchmarks.body.report import Samples, Wanted
from protocol.clock import SteppedClock
from protocol.diagnostics import MAX_DIAGNOSTICS_BYTES, Diagnostics
from robot.core.config import load_settings
from robot.ops.assembly import Simulation, assemble
from robot.ops.diagnostics import DiagnosticsReporter
from robot.ops.runners import LockstepRunner

LONGEST_S: Final = 600.0
SIMULATED_LINE_HZ: Final = 50.0
FOR_EVER_S: Final = 1e6

WANTED = (
    Wanted("unwatched.look_us_p99", at_most=10.0, unit="µs a tick"),
    Wanted("watched.tell_ms_p50", at_most=1.0, unit="ms, twice a second"),
    Wanted("watched.largest_bytes", at_most=MAX_DIAGNOSTICS_BYTES, unit="bytes"),
)


@dataclass
class Outlet:
    """A link that takes everything at once."""

    sizes: list[int] = field(default_factory=list)
    making_s: float = 0.0

    def has_room_for_diagnostics(self) -> bool:
        return True

    def tell_diagnostics(self, diagnostics: Callable[[], Diagnostics]) -> None:
        began_s = time.thread_time()
        self.sizes.append(len(diagnostics().model_dump_json().encode()))
        self.making_s += time.thread_time() - began_s


def measure(samples: Samples) -> dict[str, Any]:
    duration_s = min(LONGEST_S, samples.hour_s)
    return {name: lived(duration_s, samples.first_seed, name == "watched") for name in ("unwatched", "watched")}


def lived(duration_s: float, seed: int, is_watched: bool) -> dict[str, Any]:
    """Some minutes of errands; what each tick of the mind took, and what was added for those who watch."""
    clock, outlet = SteppedClock(), Outlet()
    with TemporaryDirectory(prefix="watched-") as folder:
        settings = load_settings(None, {"data": Path(folder), "rates.line_hz": SIMULATED_LINE_HZ})
        parts = assemble(settings, clock, Simulation(seed=seed, in_memory=True))
        runner = LockstepRunner(parts.daemon.loops(), clock)
        reporter = DiagnosticsReporter(parts.mind, outlet, runner.lags, clock.utc, clock.now)
        if is_watched:
            reporter.watch(FOR_EVER_S, whole=True)
        looks, tells, ticks = list[float](), list[float](), list[float]()
        parts.mind.tick = _timed(parts.mind.tick, ticks)  # type: ignore[method-assign]

        def look(now: float) -> None:
            told, making_s, began_s = len(outlet.sizes), outlet.making_s, time.thread_time()
            reporter.look(now)
            taken_s = time.thread_time() - began_s - (outlet.making_s - making_s)
            (tells if len(outlet.sizes) > told else looks).append(taken_s)
            if now >= duration_s:
                runner.stop()

        parts.daemon.watchers = (Errands(parts, clock, seed).look, look)
        runner.run()
        parts.daemon.close(runner.now_s)
    return {
        "mind_tick_us_mean": 1e6 * sum(ticks) / len(ticks),
        "look_us_p99": 1e6 * _share(looks, 0.99),
        "insights": len(tells),
        "tell_ms_p50": 1e3 * _share(tells, 0.5),
        "tell_ms_p99": 1e3 * _share(tells, 0.99),
        "link_ms_each": 1e3 * outlet.making_s / max(1, len(tells)),
        "largest_bytes": max(outlet.sizes, default=0),
    }


def _timed(tick: Callable[[float], None], taken_s: list[float]) -> Callable[[float], None]:
    def timed(now: float) -> None:
        began_s = time.thread_time()
        tick(now)
        taken_s.append(time.thread_time() - began_s)

    return timed


def _share(values: Sequence[float], share: float) -> float:
    return sorted(values)[min(len(values) - 1, int(share * len(values)))] if values else 0.0
