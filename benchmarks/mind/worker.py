"""The conversation with an interpreter in a process of its own: a line with a command comes in, a line of JSON out.

    script NAME CYCLES    run the program NAME so many cycles on its script; the agent is kept for the next time
    each NAME CYCLES      the same, every cycle by the clock on the wall
    goal NAME GOAL        a new agent gets the goal; until it does the action `done`
    traced NAME CYCLES    as script, by a second agent that is listened to (ours alone)
    memory NAME CYCLES    how much memory a run needs, its percepts read line by line
    growth NAME CYCLES    what a run has grown by after its first tenth

Times are CPU time of the whole process in seconds, without reading programs and percepts; of scripts also without the
loop around the engine. The module is all that
the two interpreters written in Python share, and needs nothing but Python.
"""

import gc
import json
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from itertools import chain, islice, repeat
from pathlib import Path
from typing import Any, Protocol, TypeAlias

Row: TypeAlias = tuple[list[str], str]
# Takes the percepts of one cycle and the goal to achieve ('' for none).
Cycle: TypeAlias = Callable[[frozenset[str], str], None]


class Interpreter(Protocol):
    """`acted` counts the actions of all its agents: what shows that the work was done."""

    acted: int

    def start(self, name: str, *, traced: bool = False) -> Cycle:
        """A new agent of the program NAME: what gives it one cycle."""

    def prepare(self, name: str, goal: str) -> Callable[[], None]:
        """A new agent of the program NAME: what gives it the goal and runs it until `done`."""


def rows_of(path: Path) -> Iterator[Row]:
    with path.open() as lines:
        for line in lines:
            percepts, _, goal = line.rstrip("\n").partition("\t")
            yield percepts.split(), goal


def for_ever(rows: Iterable[Row]) -> Iterator[Row]:
    return chain.from_iterable(repeat(rows))


class Worker:
    """Measures one interpreter."""

    def __init__(self, interpreter: Interpreter, folder: Path) -> None:
        self.interpreter = interpreter
        self.folder = folder
        self._rows: dict[str, list[Row]] = {}
        self._cycles: dict[str, Cycle] = {}

    def script(self, name: str, cycles: str) -> dict[str, Any]:
        return self._script(name, int(cycles), traced=False)

    def traced(self, name: str, cycles: str) -> dict[str, Any]:
        return self._script(name, int(cycles), traced=True)

    def _script(self, name: str, cycles: int, traced: bool) -> dict[str, Any]:
        cycle = self._agent(name, traced)
        inputs = self._inputs(name, cycles)
        before = self.interpreter.acted
        gc.collect()
        cpu_s = _loop_s(cycle, inputs) - _loop_s(_nothing, inputs)
        return {"cpu_s": cpu_s, "actions": self.interpreter.acted - before}

    def each(self, name: str, cycles: str) -> dict[str, Any]:
        cycle = self._agent(name, traced=False)
        inputs = self._inputs(name, int(cycles))
        times = []
        clock = time.perf_counter_ns
        gc.collect()
        for percepts, goal in inputs:
            start = clock()
            cycle(percepts, goal)
            times.append(clock() - start)
        empty = []
        for _ in inputs:
            start = clock()
            empty.append(clock() - start)
        times.sort()
        return {
            "p50_us": times[len(times) // 2] / 1e3,
            "p99_us": times[len(times) * 99 // 100] / 1e3,
            "max_us": times[-1] / 1e3,
            "clock_us": sorted(empty)[len(empty) // 2] / 1e3,
        }

    def goal(self, name: str, goal: str) -> dict[str, Any]:
        run = self.interpreter.prepare(name, goal)
        gc.collect()
        start = time.process_time()
        run()
        return {"cpu_s": time.process_time() - start}

    def memory(self, name: str, cycles: str) -> dict[str, Any]:
        cycle = self.interpreter.start(name)
        path = self.folder / f"{name}.script"
        for percepts, goal in islice(chain.from_iterable(rows_of(path) for _ in repeat(None)), int(cycles)):
            cycle(frozenset(percepts), goal)
        return {"peak_mib": resident_mib("VmHWM")}

    def growth(self, name: str, cycles: str) -> dict[str, Any]:
        cycle = self.interpreter.start(name)
        rows = for_ever(self._script_rows(name))
        readings = []
        for number in (int(cycles) // 10, int(cycles) * 9 // 10):
            for percepts, goal in islice(rows, number):
                cycle(frozenset(percepts), goal)
            gc.collect()
            readings.append((resident_mib("VmRSS"), len(gc.get_objects())))
        (before_mib, before), (after_mib, after) = readings
        return {
            "grown_mib": round(after_mib - before_mib, 3),
            "grown_objects": after - before,
            "resident_mib": after_mib,
        }

    def _agent(self, name: str, traced: bool) -> Cycle:
        key = f"{name} {traced}"
        if key not in self._cycles:
            self._cycles[key] = self.interpreter.start(name, traced=True) if traced else self.interpreter.start(name)
        return self._cycles[key]

    def _script_rows(self, name: str) -> list[Row]:
        if name not in self._rows:
            self._rows[name] = list(rows_of(self.folder / f"{name}.script"))
        return self._rows[name]

    def _inputs(self, name: str, cycles: int) -> list[tuple[frozenset[str], str]]:
        """A set of its own for every cycle, as a body makes one: the engine must not recognise it."""
        return [(frozenset(percepts), goal) for percepts, goal in islice(for_ever(self._script_rows(name)), cycles)]


def _loop_s(cycle: Cycle, inputs: list[tuple[frozenset[str], str]]) -> float:
    start = time.process_time()
    for percepts, goal in inputs:
        cycle(percepts, goal)
    return time.process_time() - start


def _nothing(percepts: frozenset[str], goal: str) -> None:
    """Do nothing: the cost that is left is that of the loop around the engine."""


def resident_mib(field: str) -> float:
    """VmRSS (now) or VmHWM (at most) of this process in MiB. Raises OSError where the system has no /proc."""
    status = Path("/proc/self/status").read_text()
    return next(int(line.split()[1]) / 1024 for line in status.splitlines() if line.startswith(field))


def serve(worker: Worker) -> None:
    """Answer until the input ends. A command that fails is answered by its error, the next one is tried."""
    for line in sys.stdin:
        command, *arguments = line.split()
        try:
            answer = getattr(worker, command)(*arguments)
        except Exception as error:
            answer = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps(answer), flush=True)
