"""A newcomer's first runs: the demonstration, and the paper's own run."""

import json
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest
from playwright.sync_api import Page, expect, sync_playwright

from tests.system.rig import ROOT, free_port, wait_for

pytestmark = [pytest.mark.system, pytest.mark.timeout(200)]

WAY = ["queued", "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered"]
PAPERS_AGENT = ROOT.parent / "shared" / "cases" / "paper" / "mail.asl"


def demo(*options: str) -> dict[str, Any]:
    command = [sys.executable, "-m", "demo", "letter", "--once", "--json", "--port", str(free_port()), *options]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=180)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    summary: dict[str, Any] = json.loads(ran.stdout)
    return summary


@pytest.mark.parametrize(
    "options",
    [
        pytest.param((), id="plain", marks=pytest.mark.slow),
        pytest.param(("--low-battery",), id="low battery", marks=pytest.mark.nightly),
    ],
)
def test_the_demo_ends_delivered_with_each_person_told_each_thing_once(options: tuple[str, ...]) -> None:
    summary = demo(*options)
    assert [state["state"] for state in summary["states"]] == WAY
    assert summary["notifications"] == {
        "sender@campus.example": {"accepted": 1, "robot_near": 1, "robot_here": 1, "delivered": 1},
        "recipient@campus.example": {"on_its_way": 1, "robot_here_for_you": 1, "delivered": 1},
    }
    assert summary["robot"]["charges"] == len(options)
    assert summary["robot"]["distance_m"] > 6.0


class ServingDemo:
    """The demonstration that goes on serving; what it says goes to a file."""

    def __init__(self, folder: Path) -> None:
        self.port = free_port()
        self._said = folder / "said"
        command = [sys.executable, "-m", "demo", "letter", "--port", str(self.port), "--speed", "10"]
        with self._said.open("wb") as said:
            self.process = subprocess.Popen(command, cwd=ROOT, stdout=said, stderr=said)

    def said(self, pattern: str) -> str | None:
        assert self.process.poll() is None, self.words()
        found = re.search(pattern, self.words())
        return found.group(1) if found else None

    def words(self) -> str:
        return self._said.read_text()


@pytest.fixture
def serving_demo(tmp_path: Path) -> Iterator[ServingDemo]:
    demo = ServingDemo(tmp_path)
    yield demo
    if demo.process.poll() is None:
        demo.process.kill()
        demo.process.wait()


@pytest.fixture
def page(browser_type_launch_args: dict[str, Any]) -> Iterator[Page]:
    """A page whose event loop ends with the test: the plugin's own would keep one running for all that follow."""
    with sync_playwright() as playwright, playwright.chromium.launch(**browser_type_launch_args) as browser:
        yield browser.new_page()


WHAT_THEY_SEE = {
    "sender": "Send a letter",
    "recipient": "My mail",
    "mailroom": "Mailroom",
    "technician": "Robots",
}


@pytest.mark.slow
@pytest.mark.alone
@pytest.mark.browser
def test_a_link_opens_each_page_as_its_person_and_ctrl_c_ends_it_all_in_three_seconds_though_pages_are_open(
    serving_demo: ServingDemo, page: Page
) -> None:
    wait_for("the links", lambda: serving_demo.said(r"technician +(\S+)"))
    for part, heading in WHAT_THEY_SEE.items():
        page.goto(serving_demo.said(rf"{part} +(http://127\.0\.0\.1:\d+/\S+)") or "")
        expect(page.get_by_role("heading", name=heading, exact=True).first).to_be_visible()
        expect(page.locator(".account .address")).to_have_text(f"{part}@campus.example")
    assert serving_demo.said(r"(Sign-in code for)") is None, "no person has asked for one"
    children = psutil.Process(serving_demo.process.pid).children(recursive=True)
    serving_demo.process.send_signal(signal.SIGINT)
    assert serving_demo.process.wait(3) == 0
    assert "Stopping" in serving_demo.words()
    assert [child for child in children if child.is_running()] == []


@pytest.mark.skipif(not PAPERS_AGENT.exists(), reason="the paper's program lies in ../shared, which is absent here")
@pytest.mark.parametrize("battery", [(), ("--battery", "0.26")], ids=["full battery", "low battery on the way"])
@pytest.mark.nightly
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
