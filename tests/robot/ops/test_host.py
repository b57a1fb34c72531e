"""The computer's own faults, read from files of the kind that a Raspberry Pi offers, and from the simulated one."""

from datetime import datetime, timedelta
from pathlib import Path

import pytest

from protocol.clock import SteppedClock
from robot.ops.host import Computer, HostWatch
from robot.simulated import Faults, SimulatedHost


def computer(system: Path) -> Computer:
    return Computer(system, SteppedClock(), system)


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
    assert HostWatch(Computer(tmp_path / "gone", SteppedClock(), tmp_path)).tick(0.0).disk_low is False


def test_this_computer_can_be_asked(tmp_path: Path) -> None:
    here = Computer(tmp_path, SteppedClock())
    assert here.under_voltage() in (True, False)
    assert here.disk_free_mb() > 0


def test_a_clock_that_goes_as_time_does_has_not_jumped_and_one_that_is_set_has() -> None:
    clock, faults = SteppedClock(), Faults()
    watch = HostWatch(SimulatedHost(faults, clock))
    reports = []
    for second in range(10):
        clock.now_s = float(second)
        faults.set("clock_jump", second >= 5)
        reports.append(watch.tick(clock.now_s).clock_jumped)
    assert reports == [False] * 5 + [True] + [False] * 4


class Slewed(SteppedClock):
    """A clock that NTP brings to the right time little by little: 500 ppm, the most that it does."""

    def utc(self) -> datetime:
        return self.started_at + timedelta(seconds=self.now_s * 1.0005)


def test_a_clock_that_is_slewed_by_the_network_has_not_jumped() -> None:
    clock = Slewed()
    watch = HostWatch(Computer(Path("/"), clock, Path("/nowhere")))
    for _ in range(3600):
        clock.advance(1.0)
        assert not watch.tick(clock.now()).clock_jumped


def test_a_loop_that_comes_late_sees_no_jump() -> None:
    clock = SteppedClock()
    watch = HostWatch(SimulatedHost(Faults(), clock))
    reports = []
    for lag_s in (0.0, 0.1, 6.0, 0.2):
        clock.advance(10.0)
        reports.append(watch.tick(clock.now() - lag_s).clock_jumped)
    assert reports == [False] * 4


def test_a_disk_that_is_nearly_full_is_told() -> None:
    clock, faults = SteppedClock(), Faults()
    watch = HostWatch(SimulatedHost(faults, clock))
    assert not watch.tick(0.0).disk_low
    faults.set("disk_full", True)
    assert watch.tick(0.0).disk_low
