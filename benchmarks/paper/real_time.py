"""Perception and reasoning at real time: python -m benchmarks.paper.real_time NAME SECONDS SEED [PROGRAM].

Threads, a pseudo-terminal and the machine's own clock, as on hardware. Prints one JSON object of samples in
milliseconds: between two views of the body, between two sets of percepts for the mind, and of each reasoning cycle.
"""

import json
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.body.report import log_to_error_stream
from benchmarks.paper.contenders import contenders
from benchmarks.paper.logged_run import TimedAgent
from protocol.clock import RealClock
from robot.mind import Mind
from robot.runners import Loop, ThreadedRunner
from robot.simulated.live import Live

WARM_UP_S = 2.0


def measure(name: str, duration_s: float, seed: int, program: Path | None) -> dict[str, list[float]]:
    clock = RealClock()
    contender = next(one for one in contenders(program) if one.name == name)
    samples: dict[str, list[float]] = {"view_ms": [], "percepts_ms": [], "cycle_ms": []}
    with TemporaryDirectory(prefix="paper-") as folder:
        parts = contender.assembled(Path(folder), clock, seed, in_memory=False)
        assert parts.robot is not None
        mind = parts.mind
        mind.agent = TimedAgent(mind.agent, samples["cycle_ms"], time.perf_counter)  # type: ignore[assignment]
        watch = {"view_ms": _Period(samples["view_ms"]), "percepts_ms": _Period(samples["percepts_ms"])}
        loops = [_watched(loop, mind, watch) for loop in parts.daemon.loops() if loop.name != "world"]
        runner = ThreadedRunner(loops, clock)
        with Live(parts.robot, clock):
            running = threading.Thread(target=runner.run, name="runner")
            running.start()
            time.sleep(WARM_UP_S)
            for values in samples.values():
                values.clear()
            time.sleep(duration_s)
            runner.stop()
            running.join()
            parts.daemon.close(clock.now())
    return samples


class _Period:
    """Writes down how long it was from one change to the next."""

    def __init__(self, samples_ms: list[float]) -> None:
        self._samples_ms = samples_ms
        self._seen: object = None
        self._at_s: float | None = None

    def look(self, what: object) -> None:
        if what == self._seen:
            return
        self._seen, before_s, self._at_s = what, self._at_s, time.monotonic()
        if before_s is not None:
            self._samples_ms.append((self._at_s - before_s) * 1e3)


def _watched(loop: Loop, mind: Mind, watch: dict[str, _Period]) -> Loop:
    """A view is new when its time is; the mind is given percepts in each of its ticks."""

    def tick(now: float) -> None:
        loop.tick(now)
        if loop.name == "mind":
            watch["percepts_ms"].look(now)
        elif "drive" in loop.name:
            watch["view_ms"].look(mind.hands.body.view.at_s)

    return replace(loop, tick=tick)


if __name__ == "__main__":
    log_to_error_stream()
    name, duration_s, seed = sys.argv[1], float(sys.argv[2]), int(sys.argv[3])
    print(json.dumps(measure(name, duration_s, seed, Path(sys.argv[4]) if sys.argv[4:] else None)))
