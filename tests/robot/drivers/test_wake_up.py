"""The lines that can be wired to BRC, and what is known about them."""

from pathlib import Path

import pytest
from gpiozero import DigitalOutputDevice
from gpiozero.pins.mock import MockFactory

from robot.core.errors import PortAbsent
from robot.drivers.create2.create2 import Create2
from robot.drivers.create2.wake_up import GpioWakeUpLine, KeepAwake, SerialRts
from robot.simulated import SimulatedRobot
from tests.plain_maps import plain_map


def test_rts_is_brc_where_the_port_has_it() -> None:
    """pyserial's own loop-back port: its CTS is its RTS."""
    rts = SerialRts("loop://")
    port = rts.open()
    assert port.cts is False, "an open port must not hold the line low"
    rts.low(True)
    assert port.cts is True
    rts.low(False)
    assert port.cts is False and rts.wired
    port.close()
    rts.low(True)
    assert rts.wired, "a pulled cable says nothing about its wires"


def test_a_port_without_rts_is_known_as_not_wired_after_the_first_try() -> None:
    robot = SimulatedRobot(plain_map("test_track"), 0.0, "post1:post2")
    rts = SerialRts(robot.port_path)
    base = Create2(rts.open, rts)
    robot.set_fault("frozen", True)
    now = 0.0
    assert rts.wired
    while now < 3.0:
        now += 0.02
        robot.step_until(now)
        base.poll(now)
    assert not rts.wired
    base.close()
    robot.close()


def test_an_absent_port_is_named(tmp_path: Path) -> None:
    with pytest.raises(PortAbsent, match="ttyUSB9"):
        SerialRts(str(tmp_path / "ttyUSB9")).open()


def test_a_pin_of_the_computer_pulls_brc_low() -> None:
    factory = MockFactory()
    device = DigitalOutputDevice("GPIO4", active_high=False, initial_value=False, pin_factory=factory)
    line = GpioWakeUpLine(device)
    line.low(True)
    assert factory.pin(4).state == 0
    line.low(False)
    assert factory.pin(4).state == 1
    device.close()


class Wire:
    """A BRC line that writes down what it was told."""

    wired = True

    def __init__(self) -> None:
        self.told: list[bool] = []

    def low(self, on: bool) -> None:
        self.told.append(on)


def test_a_pulse_is_a_second_long_so_that_three_never_mean_19200_baud() -> None:
    wire = Wire()
    awake, now, low_s = KeepAwake(wire), 0.0, 0.0
    while now < 200.0:
        awake.step(idle=True, docked=False, now=now)
        low_s += 0.02 if wire.told[-1:] == [True] else 0.0
        now += 0.02
    assert wire.told == [True, False] * 3
    assert low_s == pytest.approx(3.0, abs=0.1)


def test_whatever_happens_the_line_is_let_go_again() -> None:
    wire = Wire()
    awake = KeepAwake(wire)
    awake.pulse(0.0)
    for tick in range(100):
        awake.step(idle=False, docked=False, now=tick * 0.02)
    assert wire.told == [True, False]
