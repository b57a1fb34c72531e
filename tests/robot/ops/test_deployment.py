"""The files that a maintainer puts on a robot: systemd accepts the unit, and the shell stops the base by itself."""

import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from maps import find_map
from protocol.clock import RealClock
from robot.core.errors import PortAbsent
from robot.drivers.create2.last_resort import STOP_BYTES, stop_base
from robot.drivers.create2.serial_port import open_serial
from robot.simulated import SimulatedRobot
from robot.simulated.live import Live

ROOT = Path(__file__).parents[3]
DEPLOY = ROOT / "deploy"
DRIVING = bytes((128, 131)) + bytes((145, 0, 150, 0, 150))


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="NOT RUN: there is no systemd-analyze here")
def test_systemd_finds_nothing_wrong_with_the_unit(tmp_path: Path) -> None:
    unit = (DEPLOY / "campus-mail-robot.service").read_text()
    (tmp_path / "venv" / "bin").mkdir(parents=True)
    (tmp_path / "venv" / "bin" / "python").symlink_to(sys.executable)
    here = unit.replace("/opt/campus-mail/.venv", str(tmp_path / "venv")).replace(
        "/opt/campus-mail/deploy", str(DEPLOY)
    )
    (tmp_path / "campus-mail-robot.service").write_text(here)
    verify = ["systemd-analyze", "verify", "--man=no", str(tmp_path / "campus-mail-robot.service")]
    found = subprocess.run(verify, capture_output=True, text=True, check=False)
    assert (found.returncode, found.stdout + found.stderr) == (0, "")


def test_the_unit_waits_for_a_sign_of_life_and_stops_the_base_however_it_ends() -> None:
    unit = (DEPLOY / "campus-mail-robot.service").read_text().splitlines()
    for line in (
        "Type=notify",
        "WatchdogSec=5",
        "Restart=always",
        "ExecStopPost=/opt/campus-mail/deploy/stop-base /dev/campus-mail-base",
        "UMask=0077",
    ):
        assert line in unit


def test_shell_and_python_send_the_same_bytes() -> None:
    script = (DEPLOY / "stop-base").read_text()
    octal = script.split("printf '")[1].split("'")[0]
    assert bytes(int(digits, 8) for digits in octal.split("\\")[1:]) == STOP_BYTES


class DrivingRobot:
    """A base that drives, while the program that told it so holds the port and does nothing more."""

    def __init__(self, half_said: bytes = b"") -> None:
        clock = RealClock()
        self.robot = SimulatedRobot(find_map("test_track"), clock.now(), "post3:post2")
        self._life = Live(self.robot, clock)
        self._life.__enter__()
        self._port = open_serial(self.robot.port_path)
        for data in (DRIVING[:2], DRIVING[2:]):
            self._port.write(data)
            time.sleep(0.1)
        self._port.write(half_said)
        time.sleep(0.3)
        assert self.speed_mm_s > 100

    @property
    def speed_mm_s(self) -> float:
        return max(map(abs, self.robot.state()["wheels_mm_s"]))

    def stands_within_s(self, limit_s: float = 1.0) -> bool:
        until_s = time.monotonic() + limit_s
        while self.speed_mm_s > 1 and time.monotonic() < until_s:
            time.sleep(0.02)
        return self.speed_mm_s <= 1

    def close(self) -> None:
        self._port.close()
        self._life.__exit__(None, None, None)
        self.robot.close()


@pytest.mark.alone
@pytest.mark.parametrize("half_said", [b"", b"\x91", b"\x91\x00", b"\x91\x00\x96", b"\x91\x00\x96\x00"])
def test_the_stop_goes_past_a_daemon_that_holds_the_port_whatever_it_left_half_said(half_said: bytes) -> None:
    driving = DrivingRobot(half_said)
    stop_base(driving.robot.port_path)
    assert driving.stands_within_s()
    assert driving.robot.state()["mode"] == "passive"
    driving.close()


@pytest.mark.alone
def test_the_shell_alone_stops_the_base_and_leaves_it_in_passive() -> None:
    driving = DrivingRobot()
    ran = subprocess.run([DEPLOY / "stop-base", driving.robot.port_path], capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stderr) == (0, "")
    assert driving.stands_within_s()
    assert driving.robot.state()["mode"] == "passive"
    driving.close()


def test_an_absent_port_is_named_by_shell_and_python(tmp_path: Path) -> None:
    ran = subprocess.run([DEPLOY / "stop-base", tmp_path / "tty"], capture_output=True, text=True, check=False)
    assert ran.returncode == 1
    assert "NOT stopped" in ran.stderr
    with pytest.raises(PortAbsent, match="No such file"):
        stop_base(str(tmp_path / "tty"))
