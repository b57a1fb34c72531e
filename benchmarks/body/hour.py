"""One simulated hour of a robot with missions and decoding, as fast as it goes; then the daemon at real time.

The hour is stepped in one thread: rendered frames are decoded, reports go to the disk. For the second part the same
daemon runs as on hardware, a thread for each loop on the machine's own clock (benchmarks/body/real_time.py).
"""

import json
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from benchmarks.body.errands import Errands
from benchmarks.body.report import Samples, Wanted, say
from benchmarks.mind.engines import CHECKOUT
from protocol.clock import SteppedClock
from robot.core.config import load_settings
from robot.ops.assembly import Simulation, assemble
from robot.ops.runners import LockstepRunner, Loop

HOUR_S = 3600.0
REAL_TIME_OF_AN_HOUR_S = 120.0
SHORTEST_REAL_TIME_S = 8.0
TOLD_EVERY_S = 600.0
SIMULATED_LINE_HZ = 50.0
"""As `python -m robot --simulated`: simulated diodes do not flicker between two ticks."""

WANTED = (
    Wanted("stepped.wall_s_per_hour", at_most=180.0, unit="s"),
    Wanted("real_time.daemon_cpu", at_most=0.5, unit="of a core"),
    Wanted("real_time.resident_mib", at_most=200.0, unit="MiB"),
    Wanted("real_time.worst_lag_p99", at_most=1.0, unit="of the loop's period"),
)


def measure(samples: Samples) -> dict[str, Any]:
    real_s = max(SHORTEST_REAL_TIME_S, samples.hour_s / HOUR_S * REAL_TIME_OF_AN_HOUR_S)
    return {
        "stepped": stepped(samples.hour_s, samples.first_seed),
        "real_time": real_time(real_s, samples.first_seed),
    }


def stepped(duration_s: float, seed: int) -> dict[str, Any]:
    """Letters one after the other for `duration_s` of simulated time; what each loop took of the time on the wall."""
    clock = SteppedClock()
    with TemporaryDirectory(prefix="hour-") as folder:
        settings = load_settings(None, {"data": Path(folder), "rates.line_hz": SIMULATED_LINE_HZ})
        parts = assemble(settings, clock, Simulation(seed=seed, in_memory=True))
        errands = Errands(parts, clock, seed)
        taken_s: dict[str, float] = {}
        runner = LockstepRunner(_timed(parts.daemon.loops(), taken_s), clock)
        parts.daemon.watchers = (errands.look, _ends(runner, duration_s))
        began_s, cpu_began_s = time.perf_counter(), time.process_time()
        runner.run()
        wall_s, cpu_s = time.perf_counter() - began_s, time.process_time() - cpu_began_s
        parts.daemon.close(runner.now_s)
    return {
        "simulated_s": duration_s,
        "wall_s": wall_s,
        "cpu_s": cpu_s,
        "wall_s_per_hour": wall_s / duration_s * HOUR_S,
        "wall_s_of_loops": taken_s,
        "letters_delivered": errands.delivered,
        "driven_m": parts.robot.driven_mm / 1000 if parts.robot else 0.0,
        "frames_looked_at": parts.robot.camera.frames_read if parts.robot else 0,
    }


def _timed(loops: Sequence[Loop], taken_s: dict[str, float]) -> list[Loop]:
    """The same loops; `taken_s` adds up the time on the wall that each takes."""

    def timed(loop: Loop) -> Callable[[float], None]:
        def tick(now: float) -> None:
            began_s = time.perf_counter()
            loop.tick(now)
            taken_s[loop.name] += time.perf_counter() - began_s

        taken_s[loop.name] = 0.0
        return tick

    return [replace(loop, tick=timed(loop)) for loop in loops]


def _ends(runner: LockstepRunner, duration_s: float) -> Callable[[float], None]:
    began_s, told_s = time.perf_counter(), 0.0

    def look(now: float) -> None:
        nonlocal told_s
        if now - told_s >= TOLD_EVERY_S:
            told_s = now
            say(f"  {now / 60:.0f} simulated minutes in {time.perf_counter() - began_s:.1f} s")
        if now >= duration_s:
            runner.stop()

    return look


def real_time(duration_s: float, seed: int) -> dict[str, Any]:
    """In a process of its own: memory and processor are those of one daemon."""
    say(f"  {duration_s:.0f} s of real time")
    command = [sys.executable, "-m", "benchmarks.body.real_time", f"{duration_s:g}", str(seed)]
    finished = subprocess.run(command, cwd=CHECKOUT, stdout=subprocess.PIPE, check=True, text=True)
    return dict(json.loads(finished.stdout))
