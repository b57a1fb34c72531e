"""Messages to systemd over a real datagram socket: ready, alive, ending; and nothing when a part hangs."""

import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from robot.core.service_manager import ServiceManager, SignsOfLife, Watchdog

ROOT = Path(__file__).parents[3]
WATCHDOG_S = 0.2


class Systemd:
    """Listens as systemd does."""

    def __init__(self, address: str) -> None:
        self.address = address
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._socket.bind(f"\0{address[1:]}" if address.startswith("@") else address)

    def hears(self, for_s: float) -> list[str]:
        """Everything that is said in this time."""
        until_s, heard = time.monotonic() + for_s, []
        while (left_s := until_s - time.monotonic()) > 0:
            self._socket.settimeout(left_s)
            try:
                heard.append(self._socket.recv(4096).decode())
            except TimeoutError:
                break
        return heard

    def close(self) -> None:
        self._socket.close()


class Robot:
    """Three parts that go on by themselves, each until a test stops it."""

    def __init__(self) -> None:
        self.counts: dict[str, int | None] = {"serial": None, "control": 0, "mind": 0}
        self.hanging: set[str] = {"serial"}
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._live)
        self._thread.start()

    def _live(self) -> None:
        while not self._ending.wait(0.01):
            for part in self.counts.keys() - self.hanging:
                self.counts[part] = (self.counts[part] or 0) + 1

    def signs(self) -> dict[str, object]:
        return dict(self.counts)

    def close(self) -> None:
        self._ending.set()
        self._thread.join()


@pytest.fixture
def systemd(tmp_path: Path) -> Iterator[Systemd]:
    systemd = Systemd(str(tmp_path / "notify"))
    yield systemd
    systemd.close()


@pytest.fixture
def robot() -> Iterator[Robot]:
    robot = Robot()
    yield robot
    robot.close()


def told(systemd: Systemd, robot: Robot) -> SignsOfLife:
    return SignsOfLife(ServiceManager(systemd.address, WATCHDOG_S), robot.signs, lambda: "Driving towards post3.")


@pytest.mark.alone
def test_ready_is_said_once_and_only_when_the_base_has_spoken(systemd: Systemd, robot: Robot) -> None:
    signs = told(systemd, robot)
    waiting = systemd.hears(0.5)
    assert waiting
    assert {line for text in waiting for line in text.splitlines()} == {"STATUS=No sign of life from: serial"}
    robot.hanging.clear()
    heard = systemd.hears(0.6)
    assert sum("READY=1" in text.splitlines() for text in heard) == 1
    assert "WATCHDOG=1\nSTATUS=Driving towards post3." in heard[-1]
    signs.close()
    assert systemd.hears(0.1)[-1] == "STOPPING=1"


@pytest.mark.alone
@pytest.mark.parametrize("part", ["serial", "control", "mind"])
def test_a_part_that_hangs_starves_the_watchdog_and_is_named(systemd: Systemd, robot: Robot, part: str) -> None:
    robot.hanging.clear()
    signs = told(systemd, robot)
    assert any("WATCHDOG=1" in text for text in systemd.hears(0.25))
    robot.hanging.add(part)
    systemd.hears(0.15)  # what was still owed from before it hung
    heard = systemd.hears(2 * WATCHDOG_S)
    assert not any("WATCHDOG=1" in text for text in heard)
    assert f"STATUS=No sign of life from: {part}" in heard
    robot.hanging.clear()
    assert any("WATCHDOG=1" in text for text in systemd.hears(0.25))
    signs.close()


def test_a_sign_that_was_given_before_the_last_feeding_does_not_count_again() -> None:
    watchdog = Watchdog()
    assert watchdog.all_alive({"serial": 1, "control": 1, "mind": 1})
    assert not watchdog.all_alive({"serial": 2, "control": 2, "mind": 1})
    assert watchdog.silent({"serial": 2, "control": 2, "mind": 1}) == ["mind"]
    assert watchdog.all_alive({"serial": 3, "control": 2, "mind": 2})


def test_without_systemd_nothing_is_said_and_nothing_runs(robot: Robot) -> None:
    before = set(threading.enumerate())
    signs = SignsOfLife(ServiceManager.of_environment({}), robot.signs, lambda: "")
    assert "signs of life" not in {thread.name for thread in set(threading.enumerate()) - before}
    signs.close()


def test_a_manager_that_has_gone_stops_nobody(tmp_path: Path) -> None:
    ServiceManager(str(tmp_path / "absent")).say("READY=1")


def test_an_abstract_socket_is_found_and_the_limit_read_from_the_environment() -> None:
    name = f"@campus-mail-test-{os.getpid()}"
    systemd = Systemd(name)
    manager = ServiceManager.of_environment({"NOTIFY_SOCKET": name, "WATCHDOG_USEC": "5000000"})
    assert manager.watchdog_s == 5.0
    manager.say("READY=1")
    assert systemd.hears(0.5) == ["READY=1"]
    systemd.close()


@pytest.mark.parametrize("environment", [{"WATCHDOG_PID": "1"}, {"WATCHDOG_USEC": "soon"}, {"WATCHDOG_USEC": "0"}])
def test_a_watchdog_that_is_not_meant_for_us_is_not_fed(environment: dict[str, str]) -> None:
    given = {"NOTIFY_SOCKET": "/run/notify", "WATCHDOG_USEC": "5000000", **environment}
    assert ServiceManager.of_environment(given).watchdog_s is None


@pytest.mark.system
@pytest.mark.nightly
def test_a_whole_daemon_says_that_it_is_ready_alive_and_ending(tmp_path: Path, systemd: Systemd) -> None:
    environment = {**os.environ, "NOTIFY_SOCKET": systemd.address, "WATCHDOG_USEC": "1000000"}
    command = [sys.executable, "-m", "robot", "--simulated", "--data", str(tmp_path)]
    with subprocess.Popen(command, cwd=ROOT, env=environment, stderr=subprocess.DEVNULL) as process:
        heard: list[str] = []
        until_s = time.monotonic() + 20
        while sum("WATCHDOG=1" in text for text in heard) < 3 and time.monotonic() < until_s:
            heard += systemd.hears(0.3)
        process.terminate()
        assert process.wait(10) == 0
    said = [line for text in heard for line in text.splitlines()]
    assert said.count("READY=1") == 1
    assert said.count("WATCHDOG=1") >= 3
    assert any("Battery" in line for line in said)
    assert "STOPPING=1" in systemd.hears(0.5)
