"""Real pyserial on a pseudo-terminal: the same driver, the same byte machine, a real cable between them."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from robot.core.errors import PortBusy
from robot.drivers.create2.create2 import Create2
from robot.drivers.create2.serial_port import open_serial
from robot.drivers.interfaces import STOP, Mode, WheelSpeeds
from robot.simulated import SimulatedRobot
from tests.plain_maps import plain_map

TICK_S = 0.02


class OnPty:
    """A simulated robot on a pseudo-terminal and the driver at its other end."""

    def __init__(self, start: str) -> None:
        self.now = 50.0
        self.robot = SimulatedRobot(plain_map("test_track"), self.now, start, battery_ratio=0.5)
        self.base = Create2(lambda: open_serial(self.robot.port_path), self.robot.brc)

    def run(self, for_s: float, wanted: WheelSpeeds | None = None) -> None:
        for _ in range(round(for_s / TICK_S)):
            self.now += TICK_S
            self.robot.step_until(self.now)
            self.base.poll(self.now)
            if wanted is not None:
                self.base.drive(wanted, self.now)


@pytest.fixture
def on_pty() -> Iterator[OnPty]:
    made = OnPty("post1:post2")
    yield made
    made.base.close()
    made.robot.close()


def test_it_starts_drives_and_stops(on_pty: OnPty):
    on_pty.run(0.3)
    on_pty.base.set_mode(Mode.SAFE, on_pty.now)
    on_pty.run(2.0, WheelSpeeds(100, 100))
    assert on_pty.robot.driven_mm == pytest.approx(190, abs=15)
    on_pty.run(1.0, STOP)
    before = on_pty.robot.driven_mm
    on_pty.run(0.5, STOP)
    assert on_pty.robot.driven_mm == before
    assert on_pty.base.health.frames > 200


def test_dropped_and_flipped_bytes_are_noticed_and_never_believed(on_pty: OnPty):
    on_pty.run(0.3)
    on_pty.robot.set_fault("drop_byte", 0.002)
    on_pty.robot.set_fault("flip_byte", 0.002)
    on_pty.base.set_mode(Mode.SAFE, on_pty.now)
    last = 0
    for _ in range(150):
        on_pty.run(TICK_S, WheelSpeeds(100, 100))
        assert on_pty.base.state is not None
        count = on_pty.base.state.left_count
        assert -1 <= count - last < 30, "a count that jumps would be a damaged frame believed"
        last = count
    assert on_pty.base.health.frames > 100


def test_a_pulled_cable_stops_nothing_but_is_known(on_pty: OnPty):
    on_pty.run(0.3)
    on_pty.robot.unplug()
    on_pty.run(2.5, WheelSpeeds(100, 100))
    assert on_pty.base.health.problem is not None
    assert on_pty.base.drive(WheelSpeeds(100, 100), on_pty.now) == STOP


def test_a_second_program_cannot_take_the_port(on_pty: OnPty):
    with pytest.raises(PortBusy, match="Another program"):
        open_serial(on_pty.robot.port_path)


@pytest.mark.nightly
def test_a_sleeping_base_is_woken_by_brc(on_pty: OnPty):
    on_pty.run(0.3)
    for _ in range(400):
        on_pty.now += 1.0
        on_pty.robot.step_until(on_pty.now)  # the driver's computer is off: after five minutes the base sleeps
    on_pty.run(5.0)
    assert on_pty.base.state is not None and on_pty.now - on_pty.base.state.at_s < 0.1


@pytest.mark.slow
def test_kept_polled_it_does_not_fall_asleep(on_pty: OnPty):
    for _ in range(400):
        on_pty.run(TICK_S)
        on_pty.now += 1.0 - TICK_S
    on_pty.run(0.5)
    assert on_pty.robot.state()["asleep"] is False


def test_a_firmware_that_counts_modes_too_high_is_driven_all_the_same(on_pty: OnPty):
    on_pty.robot.set_fault("mode_offset", 1)
    on_pty.run(0.4)
    on_pty.base.set_mode(Mode.SAFE, on_pty.now)
    on_pty.run(1.0, WheelSpeeds(100, 100))
    assert on_pty.base.state is not None and on_pty.base.state.mode is Mode.SAFE
    assert on_pty.robot.driven_mm > 60


def test_a_device_that_is_a_folder_is_no_port(tmp_path: Path):
    from robot.core.errors import PortAbsent

    with pytest.raises(PortAbsent):
        open_serial(str(tmp_path))
