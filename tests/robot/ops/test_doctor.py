"""The doctor: a whole simulated robot over a real PTY, then each thing that may be wrong, with its way out.

The computer's side is a made-up tree of /proc, /sys, /boot and /etc; the service is a real WebSocket server.
"""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from maps import find_map
from protocol.clock import RealClock
from robot.__main__ import cli
from robot.core.config import load_settings
from robot.drivers.create2.serial_port import open_serial
from robot.drivers.create2.wake_up import NoWakeUpLine, SerialRts
from robot.ops.doctor import cable, computer, senses, service
from robot.ops.doctor.findings import Finding, Grade, Subjects
from robot.ops.doctor.table import CHECKS, examine
from robot.ops.equipment import Equipment
from robot.ops.hardware import pin_factory
from robot.simulated import SimulatedRobot
from robot.simulated.live import Live


class World:
    """A simulated robot before the marker of post1, alive in real time."""

    def __init__(self) -> None:
        clock = RealClock()
        self.robot = SimulatedRobot(find_map("test_track"), clock.now(), "post1")
        self._life = Live(self.robot, clock)
        self._life.__enter__()

    def equipment(self) -> Equipment:
        robot = self.robot
        return Equipment(
            lambda: open_serial(robot.port_path), robot.brc, lambda: robot.pin_factory, lambda: robot.camera, robot
        )

    def close(self) -> None:
        self._life.__exit__(None, None, None)
        self.robot.close()


@pytest.fixture
def world() -> Iterator[World]:
    world = World()
    yield world
    world.close()


def nothing() -> Any:
    raise AssertionError("this check needs no device")


NO_EQUIPMENT = Equipment(nothing, NoWakeUpLine(), nothing, nothing)


def patient(root: Path, equipment: Equipment = NO_EQUIPMENT, **settings: object) -> Subjects:
    dotted = {name.replace("__", "."): value for name, value in settings.items()}
    return Subjects(load_settings(None, {"data": root / "data", **dotted}), None, equipment, root, patience=0.2)


def write(file: Path, text: str) -> Path:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)
    return file


def graded(finding: Finding) -> tuple[Grade, str]:
    """Return grade and text, after a check that what is wrong comes with a way out."""
    assert bool(finding.way_out) == (finding.grade in {Grade.WARN, Grade.FAIL})
    return finding.grade, f"{finding.said} → {finding.way_out}"


# A whole robot


def test_a_simulated_robot_is_fit_and_every_check_is_made() -> None:
    ran = CliRunner().invoke(cli, ["doctor", "--simulated", "--json"])
    found = json.loads(ran.stdout)
    rows = {row["check"]: row for row in found["checks"]}
    assert list(rows) == [name for name, _ in CHECKS]
    assert rows["base"]["grade"] == "ok", rows["base"]
    assert "6" in rows["base"]["said"].split(" frames/s")[0]
    assert "reads post1" in rows["camera"]["said"]
    assert "high" in rows["line"]["said"]
    assert [row for row in rows.values() if row["grade"] == "fail"] == []
    assert (ran.exit_code, found["ok"]) == (0, True)


def test_the_simulated_world_pushes_its_robot_over_the_tape_itself() -> None:
    ran = CliRunner().invoke(cli, ["doctor", "--simulated", "--push"])
    assert ran.exit_code == 0, ran.output
    (line,) = [row for row in ran.stdout.splitlines() if row.startswith("ok    line")]
    assert "left changed" in line
    assert "Push the robot" not in ran.output, "no person is needed"
    assert "reads post1" in ran.stdout, "it was put back before the marker"


@pytest.mark.slow
def test_only_our_own_words_come_out_where_no_camera_is(tmp_path: Path) -> None:
    config = write(tmp_path / "r.toml", f'serial_port = "{tmp_path}/tty"\ndata = "{tmp_path}"\ncamera.device = 63\n')
    command = [sys.executable, "-m", "robot", "doctor", "--config", str(config), "--root", str(tmp_path)]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert "FAIL  camera" in ran.stdout
    assert ran.stderr == ""


def test_a_robot_without_a_cable_is_not_fit_and_a_person_reads_why(tmp_path: Path) -> None:
    config = write(tmp_path / "r.toml", f'serial_port = "{tmp_path}/tty"\ndata = "{tmp_path}"\n')
    ran = CliRunner().invoke(cli, ["doctor", "--config", str(config), "--root", str(tmp_path)])
    assert ran.exit_code == 1
    assert f"FAIL  port      there is no {tmp_path}/tty" in ran.output
    assert "→ Plug the cable in, or set serial_port." in ran.output


def test_wrong_settings_are_named_before_anything_is_looked_at(tmp_path: Path) -> None:
    config = write(tmp_path / "r.toml", "battry = 1\n")
    ran = CliRunner().invoke(cli, ["doctor", "--config", str(config)])
    assert (ran.exit_code, "there is no such setting" in ran.output) == (2, True)


def test_a_check_that_breaks_is_a_finding_and_the_others_are_made(tmp_path: Path) -> None:
    found = dict(examine(patient(tmp_path, serial_port=str(tmp_path / "tty"))))
    assert len(found) == len(CHECKS)
    assert found["line"].grade is Grade.FAIL


# The base and its cable


def test_a_base_that_says_nothing_is_told_to_be_woken(world: World, tmp_path: Path) -> None:
    world.robot.set_fault("frozen", True)
    grade, said = graded(cable.base(patient(tmp_path, world.equipment())))
    assert (grade, "Press Clean" in said) == (Grade.FAIL, True)


def test_bytes_that_are_damaged_on_the_way_are_counted_and_blamed_on_the_cable(world: World, tmp_path: Path) -> None:
    world.robot.set_fault("flip_byte", 0.003)
    grade, said = graded(cable.base(patient(tmp_path, world.equipment())))
    assert grade is Grade.FAIL
    assert "Shorten the cable" in said


def test_a_port_that_another_program_holds_is_named_with_it(tmp_path: Path) -> None:
    port = tmp_path / "tty"
    master, slave = os.openpty()
    port.symlink_to(os.ttyname(slave))
    write(tmp_path / "proc/4711/comm", "minicom\n")
    (tmp_path / "proc/4711/fd").mkdir()
    (tmp_path / "proc/4711/fd/3").symlink_to(os.ttyname(slave))
    assert "minicom (process 4711)" in graded(cable.port(patient(tmp_path, serial_port=str(port))))[1]
    assert cable.port(replace(patient(tmp_path, serial_port=str(port)), root=tmp_path / "x")).grade is (Grade.OK)
    os.close(master)
    os.close(slave)


def test_ports_that_are_there_are_listed_when_the_set_one_is_not(tmp_path: Path) -> None:
    write(tmp_path / "dev/ttyUSB1", "")
    said = graded(cable.port(patient(tmp_path, serial_port="/dev/ttyNone")))[1]
    assert str(tmp_path / "dev/ttyUSB1") in said


@pytest.mark.skipif(os.geteuid() == 0, reason="NOT RUN: root may open every port")
def test_a_port_that_may_not_be_opened_names_the_group(tmp_path: Path) -> None:
    grade, said = graded(cable.port(patient(tmp_path, serial_port="/dev/console")))
    assert (grade, "usermod -aG" in said) == (Grade.FAIL, True)


@pytest.mark.parametrize(("timer", "grade"), [("16", Grade.FAIL), ("1", Grade.OK)])
def test_the_latency_timer_of_the_cable(tmp_path: Path, timer: str, grade: Grade) -> None:
    write(tmp_path / "sys/bus/usb-serial/devices/ttyUSB0/latency_timer", f"{timer}\n")
    assert graded(cable.latency(patient(tmp_path)))[0] is grade


@pytest.mark.parametrize("cmdline", ["boot/firmware/cmdline.txt", "boot/cmdline.txt", "proc/cmdline"])
def test_a_serial_console_on_the_pins_of_the_diodes_is_found(tmp_path: Path, cmdline: str) -> None:
    write(tmp_path / cmdline, "console=serial0,115200 console=tty1 root=PARTUUID=1 rootfstype=ext4\n")
    grade, said = graded(cable.console(patient(tmp_path)))
    assert grade is Grade.FAIL
    assert "console=serial0,115200" in said
    assert "BOARD10, BOARD8" in said
    assert "raspi-config" in said


def test_a_login_on_the_serial_line_is_found(tmp_path: Path) -> None:
    write(tmp_path / "etc/systemd/system/getty.target.wants/serial-getty@ttyS0.service", "")
    assert "serial-getty@ttyS0.service" in graded(cable.console(patient(tmp_path)))[1]


def test_a_console_is_nobodys_business_on_other_pins(tmp_path: Path) -> None:
    write(tmp_path / "proc/cmdline", "console=serial0,115200\n")
    pins = {"line__left_pin": "GPIO5", "line__centre_pin": "GPIO6", "line__right_pin": "GPIO13"}
    assert cable.console(patient(tmp_path, **pins)).grade is Grade.SKIP
    assert cable.console(patient(tmp_path / "other")).grade is Grade.OK


def test_a_base_that_nobody_can_wake_is_told(world: World, tmp_path: Path) -> None:
    assert graded(cable.wake_up(patient(tmp_path, brc="none")))[0] is Grade.WARN
    without = SerialRts(world.robot.port_path)  # a pseudo-terminal has no RTS
    grade, said = graded(
        cable.wake_up(patient(tmp_path, replace(world.equipment(), open_port=without.open, wake_up_line=without)))
    )
    assert (grade, "no pulse can be sent over rts" in said) == (Grade.WARN, True)
    assert cable.wake_up(patient(tmp_path, world.equipment())).grade is Grade.OK


def test_a_computer_without_pins_says_so(tmp_path: Path) -> None:
    elsewhere = replace(NO_EQUIPMENT, pin_factory=pin_factory)
    grade, said = graded(senses.pins(patient(tmp_path, elsewhere)))
    assert (grade, "make setup-robot" in said) == (Grade.FAIL, True)


def test_a_running_daemon_keeps_its_devices_and_tells_of_the_base(tmp_path: Path) -> None:
    told = {"base": {"mode": "safe", "frames": 900}, "battery": {"voltage_mv": 16_000}, "faults": {}}
    looked_at = replace(patient(tmp_path), daemon=told)
    assert "safe, 16000 mV, 900 frames" in cable.base(looked_at).said
    assert {senses.pins(looked_at).grade, senses.camera(looked_at).grade, cable.wake_up(looked_at).grade} == {
        Grade.SKIP
    }
    silent = replace(looked_at, daemon={"faults": ["base_silent"]})
    assert cable.base(silent).grade is Grade.FAIL


# Line sensor and camera


def pushed(world: World, root: Path, for_s: float, **settings: object) -> Finding:
    """Return what --push finds while the simulated world shoves its robot to and fro across the tape."""
    return senses.pins(replace(patient(root, world.equipment(), **settings), push_s=for_s))


def test_pushing_it_over_the_tape_shows_that_each_diode_sees_it(world: World, tmp_path: Path) -> None:
    grade, said = graded(pushed(world, tmp_path, 15.0))
    assert grade is Grade.OK, said
    assert "left changed" in said


def test_a_diode_on_a_wrong_pin_is_named(world: World, tmp_path: Path) -> None:
    grade, said = graded(pushed(world, tmp_path, 2.0, line__left_pin="GPIO5"))
    assert grade is Grade.FAIL
    assert "does not show on the left diode" in said


def test_a_dead_camera_is_told(world: World, tmp_path: Path) -> None:
    world.robot.set_fault("camera_dead", True)
    grade, said = graded(senses.camera(patient(tmp_path, world.equipment())))
    assert (grade, "no pictures" in said) == (Grade.FAIL, True)


def test_a_frozen_camera_is_told(world: World, tmp_path: Path) -> None:
    world.robot.set_fault("camera_frozen", True)
    grade, said = graded(senses.camera(patient(tmp_path, world.equipment())))
    assert (grade, "always the same picture" in said) == (Grade.FAIL, True)


def test_another_size_than_the_settings_say_is_told(world: World, tmp_path: Path) -> None:
    said = graded(senses.camera(patient(tmp_path, world.equipment(), camera__width_px=1280)))[1]
    assert "1280×480 are set" in said


# The computer


def test_the_pi_needs_its_pin_library_and_no_other_computer_does(tmp_path: Path) -> None:
    assert computer.packages(patient(tmp_path)).grade is Grade.OK
    write(tmp_path / "proc/device-tree/model", "Raspberry Pi 4 Model B Rev 1.4\0")
    finding = computer.packages(patient(tmp_path))
    assert ("lgpio" in finding.said) == (finding.grade is Grade.FAIL)
    if "lgpio" in sys.modules or finding.grade is Grade.OK:
        return
    assert "make setup-robot" in graded(finding)[1]


def test_settings_that_do_not_fit_the_map_are_told(tmp_path: Path) -> None:
    grade, said = graded(computer.settings(patient(tmp_path, home="post2")))
    assert (grade, "post2 is no home" in said) == (Grade.FAIL, True)


def test_a_disk_that_takes_nothing_and_a_folder_that_others_may_read_are_told(tmp_path: Path) -> None:
    assert "a full sync takes" in computer.disk(patient(tmp_path)).said
    (tmp_path / "data").chmod(0o755)
    assert "chmod 700" in graded(computer.disk(patient(tmp_path)))[1]
    grade, said = graded(computer.disk(patient(tmp_path, data=write(tmp_path / "file", "") / "data")))
    assert (grade, "cannot be written" in said) == (Grade.FAIL, True)


def test_a_clock_that_follows_a_time_server_is_fine_and_one_that_nobody_vouches_for_is_told(tmp_path: Path) -> None:
    assert graded(computer.clock(patient(tmp_path)))[0] is Grade.WARN
    write(tmp_path / "run/systemd/timesync/synchronized", "")
    assert graded(computer.clock(patient(tmp_path)))[0] is Grade.OK


@pytest.mark.parametrize(
    ("bits", "grade", "words"),
    [
        ("0", Grade.OK, "never too little voltage"),
        ("50005", Grade.FAIL, "too little voltage now, throttled now"),
        ("50000", Grade.WARN, "too little voltage since the start"),
        ("80008", Grade.FAIL, "too hot now"),
    ],
)
def test_what_the_firmware_tells_of_voltage_and_heat(tmp_path: Path, bits: str, grade: Grade, words: str) -> None:
    write(tmp_path / "sys/devices/platform/soc/soc:firmware/get_throttled", bits + "\n")
    found, said = graded(computer.supply(patient(tmp_path)))
    assert (found, words in said) == (grade, True), said


def test_a_computer_that_tells_nothing_is_no_fault(tmp_path: Path) -> None:
    assert computer.supply(patient(tmp_path)).grade is Grade.SKIP


# The service


def with_token(root: Path, link: str, secret: str, **settings: object) -> Subjects:
    token = write(root / "token", secret)
    token.chmod(0o600)
    return patient(root, server=link, token_file=token, **settings)


def test_a_token_that_the_service_takes_is_fine(tmp_path: Path, link: str) -> None:
    assert graded(service.token(with_token(tmp_path, link, "good"))) == (
        Grade.OK,
        f"{link} takes this robot's token → ",
    )


def test_a_token_that_the_service_refuses_is_told_with_the_commands_for_a_new_one(tmp_path: Path, link: str) -> None:
    grade, said = graded(service.token(with_token(tmp_path, link, "old")))
    assert (grade, "python -m robot enrol" in said) == (Grade.FAIL, True)


def test_a_service_that_cannot_be_reached_is_no_reason_not_to_drive(tmp_path: Path) -> None:
    grade, said = graded(service.token(with_token(tmp_path, "ws://127.0.0.1:9/link", "good")))
    assert (grade, "cannot be reached" in said) == (Grade.WARN, True)


def test_two_maps_are_told(tmp_path: Path, link: str) -> None:
    assert service.map_version(with_token(tmp_path, link, "good")).grade is Grade.OK
    grade, said = graded(service.map_version(with_token(tmp_path, link, "good", map="carleton")))
    assert (grade, "two maps" in said) == (Grade.FAIL, True)


def test_a_robot_that_works_alone_has_no_service_to_be_asked(tmp_path: Path) -> None:
    assert {look(patient(tmp_path)).grade for look in (service.token, service.map_version)} == {Grade.SKIP}
