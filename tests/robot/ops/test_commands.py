"""`status`, `stop`, `rearm` and `logs`, typed beside a daemon that runs as a process of its own."""

import json
import os
import re
import signal
import struct
import subprocess
import sys
import time
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from robot.__main__ import cli
from robot.drive_loop.black_box import BlackBox
from robot.drivers.create2.open_interface import STREAMED

ROOT = Path(__file__).parents[3]


class Daemon:
    """A simulated robot that drives from post3 to post1."""

    def __init__(self, data: Path) -> None:
        self.data, self.door, self.log_file = data, data / "door", data / "robot.log"
        (data / "robot.toml").write_text(f'log_file = "{self.log_file}"\n')
        arguments = ["--simulated", "--config", data / "robot.toml", "--data", data, "--door", self.door]
        arguments += ["--start", "post3:post2", "--achieve", "visit(post1)", "--speed", "1"]
        command = [sys.executable, "-m", "robot", *map(str, arguments)]
        self.process = subprocess.Popen(command, cwd=ROOT, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)

    def types(self, *arguments: str) -> Result:
        return CliRunner().invoke(cli, [arguments[0], "--data", str(self.data), *arguments[1:]])

    def until(self, wanted: str, limit_s: float = 30.0) -> Result:
        """Until `status` says so."""
        until_s = time.monotonic() + limit_s
        while not re.search(wanted, (ran := self.types("status")).output):
            assert time.monotonic() < until_s, ran.output
            time.sleep(0.1)
        return ran

    def close(self) -> None:
        self.process.terminate()
        self.process.wait(10)


@pytest.fixture(scope="module")
def daemon(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Daemon]:
    daemon = Daemon(tmp_path_factory.mktemp("robot"))
    yield daemon
    daemon.close()


def test_a_maintainer_sees_what_it_does_stops_it_and_lets_it_go_again(daemon: Daemon) -> None:
    said = daemon.until("Driving towards post2")
    assert said.exit_code == 0
    assert re.search(r"battery +\d+% \(\w+\), \d+ mV", said.output)
    assert re.search(r"mind +\d+ +[\d.]+ ms", said.output)
    assert daemon.types("stop").output.startswith("The wheels stand.")
    stopped = daemon.types("status")
    assert stopped.exit_code == 1
    assert "FAULT        emergency_stop: " in stopped.output
    told = json.loads(daemon.types("status", "--json").output)
    assert told["base"]["wheels_mm_s"] == [0, 0]
    assert daemon.types("rearm").output == "The robot may drive again.\n"
    assert daemon.types("status").exit_code == 0


@pytest.mark.slow
def test_the_log_is_read_from_its_file(daemon: Daemon) -> None:
    daemon.until("Driving")
    subprocess_output = subprocess.run(
        [sys.executable, "-m", "robot", "logs", "--config", str(daemon.data / "robot.toml")],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    assert "follow_line" in subprocess_output
    assert all(json.loads(line)["timestamp"] for line in subprocess_output.splitlines())


def test_a_black_box_is_shown_as_a_table_of_what_changed(tmp_path: Path) -> None:
    box, frames = BlackBox(tmp_path), frames_of_a_bump()
    box.heard(frames[0], 0.5)
    box.note("percepts", 1.0, ("+fault(bump)", "-line(center)"))
    box.heard(frames[1] + frames[1], 1.2)
    box.sent(b"\x91\x00\x64\xff\x9c", 1.5)
    file = str(box.write("bump"))
    shown = CliRunner().invoke(cli, ["logs", "--black-box", file])
    assert shown.exit_code == 0
    assert re.search(r"-0.500 s +percepts +\+fault\(bump\), -line\(center\)", shown.output)
    assert re.search(r"-0.300 s +heard +bumps_and_drops 2\n", shown.output), "only what changed"
    assert re.search(r"0.000 s +sent +drive_direct left -100 right 100", shown.output)
    assert "91 00 64 ff 9c" in CliRunner().invoke(cli, ["logs", "--raw", "--black-box", file]).output


def frames_of_a_bump() -> tuple[bytes, bytes]:
    """One frame of the stream without, one with a touch on the left."""

    def frame(bumps: int) -> bytes:
        values = [0 if name != "bumps_and_drops" else bumps for _, name in STREAMED.values()]
        payload = struct.pack(
            ">" + "".join(f"B{kind}" for kind, _ in STREAMED.values()),
            *chain.from_iterable(zip(STREAMED, values, strict=True)),
        )
        framed = bytes((19, len(payload))) + payload
        return framed + bytes((-sum(framed) & 0xFF,))

    return frame(0), frame(2)


def test_what_is_no_black_box_is_refused(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("no black box")
    shown = CliRunner().invoke(cli, ["logs", "--black-box", str(tmp_path / "notes.txt")])
    assert shown.exit_code == 2
    assert "notes.txt" in shown.output


def test_without_a_daemon_status_says_so_and_rearm_does_nothing(tmp_path: Path) -> None:
    for command in ("status", "rearm"):
        ran = CliRunner().invoke(cli, [command, "--data", str(tmp_path)])
        assert ran.exit_code == 1
        assert "No robot answers" in ran.output


def test_a_stop_that_reaches_nobody_says_so_loudly(tmp_path: Path) -> None:
    ran = CliRunner().invoke(cli, ["stop", "--data", str(tmp_path), "--port", str(tmp_path / "tty")])
    assert ran.exit_code == 2
    assert "The robot was NOT stopped. Press Clean on it, or lift it." in ran.output


@pytest.mark.slow
def test_a_stop_beside_a_dead_daemon_holds_when_the_next_one_starts(tmp_path: Path) -> None:
    CliRunner().invoke(cli, ["stop", "--data", str(tmp_path), "--port", str(tmp_path / "tty")])
    daemon = Daemon(tmp_path)
    assert "FAULT        emergency_stop: " in daemon.until("FAULT").output
    assert json.loads(daemon.types("status", "--json").output)["base"]["wheels_mm_s"] == [0, 0]
    daemon.close()


@pytest.mark.slow
def test_a_stop_without_a_daemon_goes_to_the_base_itself(tmp_path: Path) -> None:
    port = tmp_path / "tty"
    with subprocess.Popen(
        [sys.executable, "-m", "robot.simulated", "--link", str(port)], cwd=ROOT, stdout=subprocess.PIPE
    ) as base:
        assert base.stdout
        base.stdout.readline()
        ran = CliRunner().invoke(cli, ["stop", "--data", str(tmp_path), "--port", str(port)])
        base.send_signal(signal.SIGINT)
    assert ran.exit_code == 1
    assert "written to the base" in ran.output


@pytest.mark.slow
def test_a_daemon_that_is_killed_is_no_longer_there_to_be_asked(tmp_path: Path) -> None:
    daemon = Daemon(tmp_path)
    daemon.until("Driving")
    os.kill(daemon.process.pid, signal.SIGKILL)
    daemon.process.wait(5)
    assert "No robot answers" in daemon.types("status").output
