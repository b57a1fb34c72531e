"""What a newcomer sees: the demonstration, and the paper's own run."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import pytest

from tests.system.rig import ROOT, free_port, wait_for

pytestmark = [pytest.mark.system, pytest.mark.timeout(200)]

WAY = ["queued", "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered"]
PAPERS_AGENT = ROOT.parent / "shared" / "cases" / "paper" / "mail.asl"


def demo(*options: str) -> dict[str, Any]:
    command = [sys.executable, "-m", "app", "demo", "--once", "--json", "--port", str(free_port()), *options]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=180)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    summary: dict[str, Any] = json.loads(ran.stdout)
    return summary


@pytest.mark.parametrize("options", [(), ("--low-battery",)], ids=["plain", "low battery"])
def test_the_demo_ends_delivered_with_each_person_told_each_thing_once(options: tuple[str, ...]) -> None:
    summary = demo(*options)
    assert [state["state"] for state in summary["states"]] == WAY
    assert summary["notifications"] == {
        "sender@campus.example": {"accepted": 1, "robot_near": 1, "robot_here": 1, "delivered": 1},
        "recipient@campus.example": {"on_its_way": 1, "robot_here_for_you": 1, "delivered": 1},
    }
    assert summary["robot"]["charges"] == len(options)
    assert summary["robot"]["distance_m"] > 6.0


@pytest.fixture
def serving_demo() -> Iterator[tuple[subprocess.Popen[str], int]]:
    port = free_port()
    command = [sys.executable, "-m", "app", "demo", "--port", str(port), "--speed", "10"]
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    yield process, port
    if process.poll() is None:
        process.kill()
        process.wait()


def test_ctrl_c_stops_everything_within_three_seconds_an_open_event_stream_included(
    serving_demo: tuple[subprocess.Popen[str], int],
) -> None:
    process, port = serving_demo
    assert process.stdout is not None
    os.set_blocking(process.stdout.fileno(), False)
    said = ""

    def the_address_is_printed() -> bool:
        nonlocal said
        said += process.stdout.read() or "" if process.stdout else ""
        return f"127.0.0.1:{port}" in said

    wait_for(f"the page's address, not only: {said}", the_address_is_printed)
    process.send_signal(signal.SIGINT)
    assert process.wait(3) == 0


@pytest.mark.skipif(not PAPERS_AGENT.exists(), reason="the paper's program lies in ../shared, which is absent here")
@pytest.mark.parametrize("battery", [(), ("--battery", "0.26")], ids=["full battery", "low battery on the way"])
def test_the_papers_own_program_delivers_on_the_simulated_robot(battery: tuple[str, ...]) -> None:
    command = [sys.executable, "-m", "robot", "--simulated", "--agent", str(PAPERS_AGENT), "--json", *battery]
    command += ["--tell", "dockStation(post5)", "--achieve", "collectAndDeliverMail(post1,post4)"]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=180)
    assert ran.returncode == 0, ran.stdout[-3000:] + ran.stderr[-3000:]
    summary = json.loads(ran.stdout)
    posts = summary["posts"]
    assert posts[-1] == "post4"
    assert "post1" in posts
    assert ("post5" in posts[posts.index("post1") :]) == bool(battery)
