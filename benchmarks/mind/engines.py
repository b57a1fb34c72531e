"""The interpreters, each in a process of its own: ours, python-agentspeak in its own environment, Jason on Java."""

import json
import os
import subprocess
import sys
import threading
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

HERE = Path(__file__).parent
CHECKOUT = HERE.parents[1]
PYTHON_AGENTSPEAK = "0.2.2"
COMPILED = CHECKOUT / "var" / "bench" / "compiled"
LONGEST_ANSWER_S = 300


class EngineFailed(Exception):
    """A worker ended, did not answer in time, or answered with an error."""


class Engine:
    """One interpreter. `warm_ups` is how many unmeasured rounds it needs before it runs at its full speed."""

    def __init__(self, name: str, worker: list[str], first_action: list[str], warm_ups: int = 1) -> None:
        self.name = name
        self.warm_ups = warm_ups
        self._worker = worker
        self._first_action = first_action
        self._process: subprocess.Popen[str] | None = None

    def ask(self, command: str) -> dict[str, Any]:
        """Ask the warm worker. Raises EngineFailed."""
        if self._process is None:
            self._process = self._start()
        return self._answer(self._process, command)

    def ask_afresh(self, command: str) -> dict[str, Any]:
        """Ask a worker that has just been started. Raises EngineFailed."""
        process = self._start()
        try:
            return self._answer(process, command)
        finally:
            _end(process)

    def first_action(self, compiled: bool) -> dict[str, Any]:
        """A whole process from its start to the first action: CPU time and time on the wall, in seconds.

        Python keeps what it has compiled of a module; with `compiled` False it may not use that, as at the very first
        start on a machine.
        """
        with TemporaryDirectory() as empty:
            environment = _environment() if compiled else {**_environment(), "PYTHONPYCACHEPREFIX": empty}
            return self._first_action_in(environment)

    def _first_action_in(self, environment: dict[str, str]) -> dict[str, Any]:
        start = time.perf_counter()
        process = subprocess.Popen(self._first_action, cwd=CHECKOUT, env=environment, stderr=subprocess.DEVNULL)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            raise EngineFailed(f"{self.name} ended with {process.returncode} before its first action")
        return {"cpu_s": used.ru_utime + used.ru_stime, "wall_s": time.perf_counter() - start}

    def close(self) -> None:
        if self._process is not None:
            _end(self._process)
            self._process = None

    def _start(self) -> subprocess.Popen[str]:
        return subprocess.Popen(
            self._worker,
            cwd=CHECKOUT,
            env=_environment(),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def _answer(self, process: subprocess.Popen[str], command: str) -> dict[str, Any]:
        assert process.stdin
        assert process.stdout
        alarm = threading.Timer(LONGEST_ANSWER_S, process.kill)
        alarm.start()
        try:
            process.stdin.write(command + "\n")
            process.stdin.flush()
            line = process.stdout.readline()
        except OSError:
            line = ""
        finally:
            alarm.cancel()
        answer = json.loads(line) if line else {"error": f"no answer (ended, or longer than {LONGEST_ANSWER_S} s)"}
        if "error" in answer:
            raise EngineFailed(f"{self.name}: {command}: {answer['error']}")
        return dict(answer)


def _environment() -> dict[str, str]:
    """Compiled modules are kept in a folder of the benchmark, also where the machine is set up to keep none."""
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    return {**kept, "PYTHONPATH": str(CHECKOUT), "PYTHONPYCACHEPREFIX": str(COMPILED)}


def _end(process: subprocess.Popen[str]) -> None:
    assert process.stdin
    process.stdin.close()
    process.wait(10)
    assert process.stdout
    process.stdout.close()


def ours(folder: Path) -> Engine:
    worker = [sys.executable, "-m", "benchmarks.mind.ours", str(folder)]
    return Engine("ours", worker, [sys.executable, str(HERE / "first_ours.py"), str(folder)])


def python_agentspeak(folder: Path) -> Engine:
    """Fetches it from the package index into an environment of its own, once. Raises EngineFailed."""
    home = folder.parent / f"python-agentspeak-{PYTHON_AGENTSPEAK}"
    python = home / "bin" / "python"
    if not (home / "ready").exists():
        _run(sys.executable, "-m", "venv", str(home))
        _run(str(python), "-m", "pip", "install", "--quiet", f"agentspeak=={PYTHON_AGENTSPEAK}")
        (home / "ready").touch()
    worker = [str(python), str(HERE / "python_agentspeak.py"), str(folder)]
    first_action = [str(python), str(HERE / "first_python_agentspeak.py"), str(folder)]
    return Engine("python-agentspeak", worker, first_action)


def jason(folder: Path) -> Engine:
    """Compiles the driver against the archive that JASON_JAR names. Raises EngineFailed."""
    archive = os.environ.get("JASON_JAR", "")
    if not archive:
        raise EngineFailed("set JASON_JAR")
    classes = folder.parent / "jason-classes"
    _run("javac", "-cp", archive, "-d", str(classes), str(HERE / "JasonWorker.java"))
    worker = ["java", "-cp", os.pathsep.join((archive, str(classes))), "JasonWorker", str(folder)]
    return Engine("jason", worker, [*worker, "first"], warm_ups=20)


def _run(*command: str) -> None:
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise EngineFailed(f"{command[0]}: {error.strerror}") from None
    if done.returncode:
        raise EngineFailed((done.stderr.strip().splitlines() or [f"{command[0]} failed"])[-1])
