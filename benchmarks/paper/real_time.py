"""Perception and reasoning at real time: python -m benchmarks.paper.real_time NAME SECONDS SEED [PROGRAM].

Threads, a pseudo-terminal and the machine's own clock, as on hardware. Prints one JSON object of samples in
milliseconds: between two views of the body (what the paper's sensors published), of each reasoning cycle, and how old
the view is that a tick of the mind reasons about. `would_wait` are counts, not times: how many views would be waiting
after each tick if they were queued and each tick took one, as the paper's reasoner did.
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
from robot.agent.mind import Mind
from robot.ops.runners import Loop, ThreadedRunner
from robot.simulated.live import Live

WARM_UP_S = 2.0


def measure(name: str, duration_s: float, seed: int, program: Path | None) -> dict[str, list[float]]:
    clock = RealClock()
    contender = next(one for one in contenders(program) if one.name == name)
    samples: dict[str, list[float]] = {"view_ms": [], "cycle_ms": [], "view_age_ms": [], "would_wait": []}
    with TemporaryDirectory(prefix="paper-") as folder:
        parts = contender.assembled(Path(folder), clock, seed, in_memory=False)
        assert parts.robot is not None
        mind = parts.mind
        mind.agent = TimedAgent(mind.agent, samples["cycle_ms"], time.perf_counter)  # type: ignore[assignment]
        views = Views(samples)
        loops = [_watched(loop, mind, views) for loop in parts.daemon.loops() if loop.name != "world"]
        runner = ThreadedRunner(loops, clock)
        with Live(parts.robot, clock):
            running = threading.Thread(target=runner.run, name="runner")
            running.start()
            time.sleep(WARM_UP_S)
            views.begin()
            time.sleep(duration_s)
            runner.stop()
            running.join()
            parts.daemon.close(clock.now())
    return samples


class Views:
    """Writes down when the body's view was renewed, and what the mind made of it. Two threads tell it."""

    def __init__(self, samples: dict[str, list[float]]) -> None:
        self._samples = samples
        self._came = self._taken = 0
        self._newest_s: float | None = None

    def begin(self) -> None:
        """Forget what came while the robot started."""
        self._came = self._taken = 0
        for values in self._samples.values():
            values.clear()

    def renewed(self, at_s: float) -> None:
        """The view is of this moment; the same moment again is no new view."""
        if at_s == self._newest_s:
            return
        before_s, self._newest_s = self._newest_s, at_s
        self._came += 1
        if before_s is not None:
            self._samples["view_ms"].append((at_s - before_s) * 1e3)

    def reasoned(self, now: float, view_at_s: float) -> None:
        """The mind has ended a tick that began `now`, with the view of `view_at_s`."""
        self._taken = min(self._taken + 1, self._came)
        self._samples["view_age_ms"].append(max(0.0, now - view_at_s) * 1e3)
        self._samples["would_wait"].append(self._came - self._taken)


def _watched(loop: Loop, mind: Mind, views: Views) -> Loop:
    def tick(now: float) -> None:
        loop.tick(now)
        if loop.name == "mind":
            views.reasoned(now, mind.hands.view.at_s)
        elif "drive" in loop.name:
            views.renewed(mind.hands.body.view.at_s)

    return replace(loop, tick=tick)


if __name__ == "__main__":
    log_to_error_stream()
    name, duration_s, seed = sys.argv[1], float(sys.argv[2]), int(sys.argv[3])
    print(json.dumps(measure(name, duration_s, seed, Path(sys.argv[4]) if sys.argv[4:] else None)))
