"""A demonstration in which something dies ends with a reason, and leaves nothing running."""

import json
import socket
import subprocess
import sys
import time

import psutil
import pytest

from app.core.database.schema_version import INI

pytestmark = pytest.mark.system


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def child(demo: subprocess.Popen[str], package: str, limit_s: float = 60.0) -> psutil.Process:
    """The demonstration's own child that runs `python -m package`."""
    until_s = time.monotonic() + limit_s
    while time.monotonic() < until_s:
        for process in psutil.Process(demo.pid).children():
            if process.cmdline()[1:3] == ["-m", package]:
                return process
        time.sleep(0.05)
    raise AssertionError(f"no child runs {package}")


@pytest.mark.parametrize("victim", ["app", "robot"])
@pytest.mark.nightly
def test_when_a_process_dies_the_demonstration_says_so_and_stops_the_other(victim: str) -> None:
    command = [sys.executable, "-m", "demo", "letter", "--once", "--json", "--port", str(free_port())]
    demo = subprocess.Popen(command, cwd=INI.parent, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        others = [child(demo, "app"), child(demo, "robot")]
        child(demo, victim).kill()
        said, complaint = demo.communicate(timeout=60)
    finally:
        demo.kill()
    name = {"app": "service", "robot": "robot"}[victim]
    assert demo.returncode == 1
    summary = json.loads(said)
    assert summary["ok"] is False
    assert f"The {name} ended with exit code -9" in summary["reason"]
    assert name in complaint
    assert not any(psutil.pid_exists(other.pid) for other in others)
