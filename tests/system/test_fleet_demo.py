"""The demonstration of the fleet: real daemons and the real service in the tunnels of Carleton."""

import json
import os
import queue
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import suppress

import psutil
import pytest

from tests.system.rig import ROOT

pytestmark = [pytest.mark.system, pytest.mark.timeout(500)]

COMMAND = [sys.executable, "-m", "demo", "fleet", "--port", "0", "--robots", "2", "--scale", "0.05"]


@pytest.mark.nightly
def test_two_robots_of_the_fleet_deliver_an_order_each_and_never_meet() -> None:
    ran = subprocess.run(
        [*COMMAND, "--once", "--json"], cwd=ROOT, capture_output=True, text=True, check=False, timeout=180
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    summary = json.loads(ran.stdout)
    assert summary["ended"] == {"delivered": 2}
    assert summary["delivered_by"] == {"r1": 1, "r2": 1}
    assert summary["died"] == {}
    assert (summary["two_in_one_corridor"], summary["bodies_overlapped"]) == (0, 0)
    assert summary["corridors_entered_or_left"] >= 2 * 2
    assert summary["looks_at_true_places"] > 20


class Watched:
    """A demonstration that goes on, and what it has said."""

    def __init__(self, *options: str) -> None:
        self.process = subprocess.Popen(
            [*COMMAND, *options], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        self._said: list[str] = []
        self._lines: queue.Queue[str] = queue.Queue()
        self._reading = threading.Thread(target=self._read, daemon=True)
        self._reading.start()

    def close(self) -> None:
        self._reading.join()
        if self.process.stdout:
            self.process.stdout.close()

    def rest(self) -> str:
        """What it has said since, once it has ended."""
        return "".join(self._lines.get() for _ in range(self._lines.qsize()))

    def _read(self) -> None:
        for line in self.process.stdout or ():
            self._lines.put(line)

    def says(self, pattern: str, limit_s: float = 200.0) -> re.Match[str]:
        """The next line that has `pattern`."""
        until_s = time.monotonic() + limit_s
        with suppress(queue.Empty):
            while True:
                self._said.append(self._lines.get(timeout=max(0.0, until_s - time.monotonic())))
                if found := re.search(pattern, self._said[-1]):
                    return found
        raise AssertionError(f"{pattern} was not said within {limit_s:.0f} s:\n{''.join(self._said)}")


@pytest.fixture
def watched() -> Iterator[Watched]:
    demo = Watched("--speed", "30", "--restart-after", "4")
    yield demo
    if demo.process.poll() is None:
        demo.process.kill()
        demo.process.wait()
    demo.close()


@pytest.mark.nightly
@pytest.mark.alone
def test_when_a_robot_dies_it_goes_on_until_the_robot_is_back_and_it_ends_when_the_service_dies(
    watched: Watched,
) -> None:
    number = int(watched.says(r"Their processes: .*\br2 (\d+)")[1])
    watched.says(r"at sender \(r2\)")
    os.kill(number, signal.SIGKILL)
    watched.says(r"r2: its process was killed by signal 9; it is started again in 4 min")
    watched.says(r"ALARM r2: vanished, nothing has been heard of the robot")
    again = int(watched.says(r"r2: started again, process (\d+)")[1])
    assert again != number
    watched.says(r"delivered \(r2\)")
    children = psutil.Process(watched.process.pid).children()
    service = next(child for child in children if child.cmdline()[1:3] == ["-m", "app"])
    service.kill()
    watched.says(r"Failed: The service ended with exit code -9")
    assert watched.process.wait(20) == 1
    assert not any(child.is_running() for child in children)
