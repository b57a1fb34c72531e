"""Time until the wheels stop: real time, a real pseudo-terminal, the daemon's own threads, a mind that never rests.

The robot's world lives in a process of its own, so that it does not share the interpreter's lock with the daemon. The
daemon is put together from its own parts; the mind has a program that computes without pause.

- *bump*: from just before the first frame that shows it is written to the end of the write of the stop.
- *deadline*: the loop that drives hangs; the driver's own thread stops the wheels (0.4 s after the last speed).
- *drive_dies*: the loop that drives raises; its last act is to stop the wheels.
- *agent_silent*, *camera_stale*: mind or camera hang; judged by the time of the fault table.

Each from the cause to the stop on the wire, and to standing wheels (under 1 mm/s).
"""

import multiprocessing
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median, quantiles
from typing import Any

import numpy as np
import serial
import structlog
from gpiozero.pins.mock import MockFactory

from benchmarks.body.report import Samples, Wanted, say
from benchmarks.body.stops_world import STOP, live
from maps import builtin_map
from protocol.clock import RealClock
from robot.core.config import load_settings
from robot.drivers.create2.create2 import Create2
from robot.drivers.create2.serial_port import open_serial
from robot.drivers.interfaces import Frame, WheelSpeeds
from robot.drivers.line_sensor import ThreeDiodes
from robot.drivers.port_thread import PortThread
from robot.mission.store import Store
from robot.ops.assembly import Devices, join, load_program
from robot.ops.runners import Loop, ThreadedRunner
from robot.reflexes import FAULTS
from robot.simulated import Faults
from robot.simulated.host import SimulatedHost
from robot.skills.interfaces import Done, Failed, Running, View

BUMPS_PER_SEED = 5
SEEDS_PER_CAUSE = 4
SETTLES_S = 0.3
STANDS_WITHIN_S = {fault.name: fault.stands_within_s for fault in FAULTS}
THINKS = """
!think(0).
+!think(N) <- .findall(X*Y, .range(X,1,12) & .range(Y,1,12) & X*Y mod 7 == 3, L); .length(L,K); !!think(N+K).
"""

WANTED = (
    Wanted("bump.p99_ms", at_most=40.0, unit="ms"),
    Wanted("mind_busy_share", at_least=0.9, unit="of the time"),
    Wanted("deadline.stop_worst_s", at_most=0.5, unit="s"),
    Wanted("deadline.standing_worst_s", at_most=1.0, unit="s"),
    Wanted("drive_dies.stop_worst_s", at_most=0.1, unit="s"),
    Wanted("agent_silent.standing_worst_s", at_most=STANDS_WITHIN_S["agent_silent"], unit="s"),
    Wanted("camera_stale.standing_worst_s", at_most=STANDS_WITHIN_S["camera_stale"], unit="s"),
)


class Circle:
    """A skill that drives a circle for ever: it stays in the room."""

    name, moves, limit_s, on_timeout = "circle", True, 1e6, "timeout"

    def start(self, view: View, now: float) -> None:
        """There is nothing to prepare."""

    def step(self, view: View, now: float) -> Running | Done | Failed:
        return Running(WheelSpeeds(100, 140))


class NoisyCamera:
    """640 × 480 of noise, ten times a second: as much for the decoder to look through as a tunnel gives."""

    def __init__(self) -> None:
        self._frames = [np.random.default_rng(i).integers(0, 255, (480, 640), np.uint8) for i in range(4)]
        self._number = 0

    def read(self) -> tuple[bool, Frame | None]:
        self._number += 1
        return True, self._frames[self._number % 4]

    def close(self) -> None:
        """Nothing to give back."""


class StampingPort:
    """The daemon's end of the cable; notes when the first stop after `begin` had been written."""

    def __init__(self, port: serial.SerialBase) -> None:
        self._port = port
        self.baudrate = port.baudrate
        self.stop_written_s: float | None = None

    def read(self, size: int = 1) -> bytes:
        return bytes(self._port.read(size))

    def write(self, data: bytes, /) -> int | None:
        written = self._port.write(data)
        if STOP in data and self.stop_written_s is None:
            self.stop_written_s = time.monotonic()
        return int(written or 0)

    def fileno(self) -> int:
        return int(self._port.fileno())

    def close(self) -> None:
        self._port.close()


class Rig:
    """A daemon on threads at one end of the cable, the world's process at the other."""

    def __init__(self, folder: Path, seed: int) -> None:
        self._connection, theirs = multiprocessing.Pipe()
        context = multiprocessing.get_context("spawn")
        self._world = context.Process(target=live, args=(theirs, seed), daemon=True)
        self._world.start()
        port = self._connection.recv()
        program = folder / "thinks.asl"
        program.write_text(THINKS)
        settings = load_settings(
            None,
            {
                "data": folder / "data",
                "serial_port": port,
                "mind.program": program,
                "mind.percepts": "latest",
                "mind.steps_per_tick": 40,
                "rates.mind_hz": 200.0,
            },
        )
        settings.data.mkdir()
        clock = RealClock()
        self.url = port
        self.base = PortThread(Create2(self._open), clock.now)
        self._pins = MockFactory()
        line = settings.line
        self._centre = self._pins.pin(line.centre_pin)
        sensor = ThreeDiodes(line.left_pin, line.centre_pin, line.right_pin, self._pins, line.line_is_low)
        host = SimulatedHost(Faults(), clock)
        self._store = Store(settings.data / "robot.db")
        devices = Devices(self.base, sensor, NoisyCamera(), host)
        parts = join(settings, builtin_map("test_track"), clock, self._store, devices, program=load_program(settings))
        self.daemon, self.drive = parts.daemon, parts.daemon.drive
        self.daemon.watchers = (self._see_the_line_change,)
        self.spoil: dict[str, Callable[[], object]] = {}
        self.spoilt_s = 0.0
        self.mind_busy_s = 0.0
        self._runner = ThreadedRunner([self._spoilt(loop) for loop in self.daemon.loops()], clock)
        self._thread = threading.Thread(target=self._run)
        self._began_s = time.monotonic()
        self._thread.start()
        self.base.start()
        self.drive.start(Circle(), clock.now())

    def _open(self) -> StampingPort:
        self.port = StampingPort(open_serial(self.url))
        return self.port

    def _see_the_line_change(self, now: float) -> None:
        """Diodes that never change would count as broken after some metres."""
        over = int(now * 2) % 2
        self._centre.drive_low() if over else self._centre.drive_high()

    def _spoilt(self, loop: Loop) -> Loop:
        """The same loop, with something that happens before its next tick once it is asked for."""

        def tick(now: float) -> None:
            if loop.name in self.spoil:
                self.spoilt_s = time.monotonic()
                self.spoil[loop.name]()
            began_s = time.monotonic()
            loop.tick(now)
            if loop.name == "mind":
                self.mind_busy_s += time.monotonic() - began_s

        return Loop(loop.name, loop.rate_hz, loop.feeds, tick, loop.at_end, loop.woken_by)

    def _run(self) -> None:
        try:
            self._runner.run()
        except Broken:
            """As asked."""

    def until_driving(self, limit_s: float = 20.0) -> None:
        """The wheels turn, and no fault is left from before."""
        until_s = time.monotonic() + limit_s
        while self.seen()["standing"] or self.drive.view.faults:
            if time.monotonic() > until_s:
                raise TimeoutError(f"the robot does not drive: {self.drive.view.faults}, {self.base.health}")
            time.sleep(0.05)

    def seen(self) -> dict[str, Any]:
        self._connection.send("seen")
        seen: dict[str, Any] = self._connection.recv()
        return seen

    def after(self, cause: str, until: str = "standing_s", limit_s: float = 6.0) -> dict[str, Any]:
        """Let the world do this (`begin`, `bump soon`), and say what it saw, once it has seen what is waited for."""
        self.port.stop_written_s = None
        self._connection.send(cause)
        until_s = time.monotonic() + limit_s
        while (seen := self.seen())[until] is None:
            if time.monotonic() > until_s:
                raise TimeoutError(f"no {until} after {cause}: {seen}, {self.drive.view.faults}")
            time.sleep(0.02)
        return seen

    @property
    def lag_p99_ms(self) -> float:
        return 1000 * self._runner.lags["line and drive"].share_s(0.99)

    @property
    def mind_busy_share(self) -> float:
        return self.mind_busy_s / (time.monotonic() - self._began_s)

    def close(self) -> None:
        self._runner.stop()
        self._thread.join()
        self.daemon.close(time.monotonic())
        self._store.close()
        self._connection.send("end")
        self._world.join(5)


class Broken(Exception):
    """The error that a loop dies of."""


@contextmanager
def rig(seed: int) -> Iterator[Rig]:
    with tempfile.TemporaryDirectory(prefix="campus-mail-stops-") as folder:
        made = Rig(Path(folder), seed)
        try:
            yield made
        finally:
            made.close()


def bumps(seeds: range) -> dict[str, Any]:
    """From the first frame to the stop, in milliseconds. The wheels hardly stand before the robot backs off."""
    took_ms, heard_ms = [], []
    with rig(seeds.start) as made:
        made.mind_busy_s, made._began_s = 0.0, time.monotonic()
        for _ in range(BUMPS_PER_SEED * len(seeds)):
            time.sleep(SETTLES_S)  # the view shows a fault one tick after it stopped the wheels
            made.until_driving()
            seen = made.after("bump soon", "stop_heard_s")
            # The world's process may be late to read what the daemon has long written.
            on_the_wire_s = min(seen["stop_heard_s"], made.port.stop_written_s or seen["stop_heard_s"])
            took_ms.append(1000 * (on_the_wire_s - seen["bump_shown_s"]))
            heard_ms.append(1000 * (seen["stop_heard_s"] - seen["bump_shown_s"]))
        busy = made.mind_busy_share
        lag, gap_s = made.lag_p99_ms, made.drive.worst_gap_s
    return {
        "mind_busy_share": round(busy, 3),
        "drive_lag_p99_ms": round(lag, 2),
        "drive_worst_gap_s": round(gap_s, 3),
        "bump": {
            "samples": len(took_ms),
            "p50_ms": round(median(took_ms), 2),
            "p99_ms": round(quantiles(took_ms, n=100, method="inclusive")[98], 2),
            "worst_ms": round(max(took_ms), 2),
            "heard_by_the_world_p99_ms": round(quantiles(heard_ms, n=100, method="inclusive")[98], 2),
            "all_ms": [round(one, 1) for one in took_ms],
        },
    }


def hangs(loop: str, seeds: range) -> dict[str, Any]:
    """A loop hangs until the wheels stand, then goes on."""
    stops_s, stood_s = [], []
    with rig(seeds.start) as made:
        for _ in seeds:
            made.until_driving()
            gate = threading.Event()
            made.spoil[loop] = gate.wait
            seen = made.after("begin")
            stops_s.append(seen["stop_heard_s"] - made.spoilt_s)
            stood_s.append(seen["standing_s"] - made.spoilt_s)
            del made.spoil[loop]
            gate.set()
            time.sleep(0.5)
    return _figures(stops_s, stood_s)


def dies(loop: str, seeds: range) -> dict[str, Any]:
    """A loop raises, which ends the daemon."""

    def breaks() -> None:
        raise Broken

    stops_s, stood_s = [], []
    for seed in seeds:
        with rig(seed) as made:
            made.until_driving()
            made.spoil[loop] = breaks
            seen = made.after("begin")
            stops_s.append(seen["stop_heard_s"] - made.spoilt_s)
            stood_s.append(seen["standing_s"] - made.spoilt_s)
    return _figures(stops_s, stood_s)


def _figures(stops_s: list[float], stood_s: list[float]) -> dict[str, Any]:
    return {
        "samples": len(stops_s),
        "stop_median_s": round(median(stops_s), 3),
        "stop_worst_s": round(max(stops_s), 3),
        "standing_worst_s": round(max(stood_s), 3),
    }


def measure(samples: Samples) -> dict[str, Any]:
    """About 4 s for each bump (a bump has to be over before the next), 2 to 5 s for each of the others."""
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(50))  # what dies here is meant to
    figures = bumps(samples.some_seeds())
    say(f"  bump: {figures}")
    few = samples.some_seeds(max(1, samples.seeds // SEEDS_PER_CAUSE))
    causes = {
        "deadline": lambda: hangs("line and drive", few),
        "drive_dies": lambda: dies("line and drive", few),
        "agent_silent": lambda: hangs("mind", few),
        "camera_stale": lambda: hangs("camera", few),
    }
    for name, cause in causes.items():
        figures[name] = cause() | {"table_s": STANDS_WITHIN_S.get(name)}
        say(f"  {name}: {figures[name]}")
    return figures
