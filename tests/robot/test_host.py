"""The computer's own faults, read from files of the kind that a Raspberry Pi offers, and from the simulated one."""

from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from protocol.clock import SteppedClock
from robot.host import Computer, HostWatch
from robot.simulated import Faults, SimulatedHost

START = datetime(2026, 1, 5, 9, 0, tzinfo=UTC)


def computer(system: Path) -> Computer:
    return Computer(system, lambda: START, system)


def firmware_says(system: Path, text: str) -> None:
    file = system / "sys/devices/platform/soc/soc:firmware/get_throttled"
    file.parent.mkdir(parents=True)
    file.write_text(text)


def sensor_says(system: Path, name: str, alarm: str) -> None:
    folder = system / "sys/class/hwmon/hwmon1"
    folder.mkdir(parents=True)
    (folder / "name").write_text(f"{name}\n")
    (folder / "in0_lcrit_alarm").write_text(f"{alarm}\n")


@pytest.mark.parametrize(
    ("text", "low"), [("0\n", False), ("50000\n", False), ("50005\n", True), ("1\n", True), ("?\n", False)]
)
def test_only_voltage_that_is_too_low_now_counts(tmp_path: Path, text: str, low: bool) -> None:
    firmware_says(tmp_path, text)
    assert computer(tmp_path).under_voltage() is low


@pytest.mark.parametrize(
    ("name", "alarm", "low"), [("rpi_volt", "1", True), ("rpi_volt", "0", False), ("cpu", "1", False)]
)
def test_newer_kernels_tell_it_by_another_file(tmp_path: Path, name: str, alarm: str, low: bool) -> None:
    sensor_says(tmp_path, name, alarm)
    assert computer(tmp_path).under_voltage() is low


def test_a_computer_that_does_not_tell_counts_as_well(tmp_path: Path) -> None:
    assert computer(tmp_path).under_voltage() is False
    assert HostWatch(Computer(tmp_path / "gone", lambda: START, tmp_path)).tick(0.0).disk_low is False


def test_this_computer_can_be_asked(tmp_path: Path) -> None:
    here = Computer(tmp_path, lambda: START)
    assert here.under_voltage() in (True, False)
    assert here.disk_free_mb() > 0


def test_a_clock_that_goes_as_time_does_has_not_jumped_and_one_that_is_set_has() -> None:
    clock, faults = SteppedClock(), Faults()
    watch = HostWatch(SimulatedHost(faults, clock.utc))
    reports = []
    for second in range(10):
        clock.now_s = float(second)
        faults.set("clock_jump", second >= 5)
        reports.append(watch.tick(clock.now_s).clock_jumped)
    assert reports == [False] * 5 + [True] + [False] * 4


def test_a_clock_that_is_slewed_by_the_network_has_not_jumped() -> None:
    drift = iter(timedelta(seconds=second * 1.0005) for second in range(10))
    watch = HostWatch(Computer(Path("/"), lambda: START + next(drift), Path("/nowhere")))
    assert not any(watch.tick(float(second)).clock_jumped for second in range(10))


def test_a_disk_that_is_nearly_full_is_told() -> None:
    clock, faults = SteppedClock(), Faults()
    watch = HostWatch(SimulatedHost(faults, clock.utc))
    assert not watch.tick(0.0).disk_low
    faults.set("disk_full", True)
    assert watch.tick(0.0).disk_low
