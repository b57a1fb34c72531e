"""The daemon at real time, with threads and a pseudo-terminal: python -m benchmarks.body.real_time SECONDS SEED.

The simulated world lives in threads of the same process. What it takes is measured thread by thread and told beside
what the daemon takes: the thread that moves it, and the drawing of frames, which a camera's driver does elsewhere. The
memory is that of both together. Prints one JSON object.
"""

import json
import sys
import threading
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import psutil

from benchmarks.body.errands import Errands
from benchmarks.body.report import log_to_error_stream
from benchmarks.mind.worker import resident_mib
from protocol.clock import RealClock
from robot.core.config import load_settings
from robot.drivers.interfaces import Frame
from robot.ops.assembly import Simulation, assemble
from robot.ops.runners import Loop, ThreadedRunner
from robot.simulated.live import Live

WORLD = "simulated world"
DRAWING = "drawing of frames"
WARM_UP_S = 2.0


class Drawn:
    """A camera; `cpu_s` is what its frames have taken of the processor."""

    def __init__(self, camera: Any) -> None:
        self._camera = camera
        self.cpu_s = 0.0

    def read(self) -> tuple[bool, Frame | None]:
        before_s = time.thread_time()
        try:
            there_is_one, frame = self._camera.read()
            return there_is_one, frame
        finally:
            self.cpu_s += time.thread_time() - before_s


def measure(duration_s: float, seed: int) -> dict[str, Any]:
    clock = RealClock()
    with TemporaryDirectory(prefix="real-time-") as folder:
        parts = assemble(load_settings(None, {"data": Path(folder)}), clock, Simulation(seed=seed))
        assert parts.robot is not None
        drawn = Drawn(parts.robot.camera)
        parts.daemon.camera._camera = drawn  # type: ignore[assignment]  # nothing else of the robot is different
        errands = Errands(parts, clock, seed)
        parts.daemon.watchers = (errands.look,)
        loops = [loop for loop in parts.daemon.loops() if loop.name != "world"]
        runner = ThreadedRunner(loops, clock)
        with Live(parts.robot, clock):
            running = threading.Thread(target=runner.run, name="runner")
            running.start()
            figures = _watch(duration_s, drawn)
            figures |= {"driven_m": parts.robot.driven_mm / 1000, "loops": _lags(loops, runner)}
            runner.stop()
            running.join()
        parts.daemon.close(clock.now())  # which ends its world too: no thread may still be stepping it
    figures["worst_lag_p99"] = max(loop["lag_p99_s"] / loop["period_s"] for loop in figures["loops"].values())
    return figures


def _watch(duration_s: float, drawn: Drawn) -> dict[str, Any]:
    time.sleep(WARM_UP_S)
    before, drawn_s, began_s = _cpu_s_of_threads(), drawn.cpu_s, time.monotonic()
    time.sleep(duration_s)
    past_s = time.monotonic() - began_s
    shares = {name: (cpu_s - before.get(name, 0.0)) / past_s for name, cpu_s in _cpu_s_of_threads().items()}
    drawing = (drawn.cpu_s - drawn_s) / past_s
    world = shares.pop(WORLD)
    shares["camera"] -= drawing
    return {
        "real_s": past_s,
        "daemon_cpu": sum(shares.values()),
        "daemon_cpu_of_threads": {name: share for name, share in shares.items() if share >= 0.001},
        "simulation_cpu": {WORLD: world, DRAWING: drawing},
        "resident_mib": resident_mib("VmHWM"),
    }


def _cpu_s_of_threads() -> dict[str, float]:
    """Of every thread of this process, the libraries' own ones included."""
    names = {thread.native_id: thread.name for thread in threading.enumerate()}
    taken: dict[str, float] = {}
    for thread in psutil.Process().threads():
        name = names.get(thread.id, "other")
        taken[name] = taken.get(name, 0.0) + thread.user_time + thread.system_time
    return taken


def _lags(loops: list[Loop], runner: ThreadedRunner) -> dict[str, dict[str, float]]:
    return {
        loop.name: {
            "period_s": 1 / loop.rate_hz,
            "ticks": runner.lags[loop.name].ticks,
            "lag_p50_s": runner.lags[loop.name].share_s(0.5),
            "lag_p99_s": runner.lags[loop.name].share_s(0.99),
            "lag_worst_s": runner.lags[loop.name].worst_s,
        }
        for loop in loops
    }


if __name__ == "__main__":
    log_to_error_stream()
    print(json.dumps(measure(float(sys.argv[1]), int(sys.argv[2]))))
