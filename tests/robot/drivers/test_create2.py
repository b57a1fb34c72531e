"""The Create 2 driver against scripted bytes: what it sends, what it makes of what it hears."""

from pathlib import Path
from struct import calcsize

import pytest

from robot.core.errors import PortAbsent
from robot.drivers.create2 import open_interface as oi
from robot.drivers.create2.create2 import Create2, possible
from robot.drivers.create2.serial_port import open_serial
from robot.drivers.interfaces import STOP, Mode, WheelSpeeds

START, SAFE, FULL, SEEK = b"\x80", b"\x83", b"\x84", b"\x8f"


class ScriptedPort:
    """A port whose far end is the test."""

    def __init__(self) -> None:
        self.baudrate = 115200
        self.arriving = bytearray()
        self.written = bytearray()
        self.unplugged = False

    def read(self, size: int = 1) -> bytes:
        if self.unplugged:
            raise OSError("device reports readiness to read but returned no data")
        data = bytes(self.arriving[:size])
        del self.arriving[:size]
        return data

    def write(self, data: bytes, /) -> int | None:
        if self.unplugged:
            raise OSError(5, "Input/output error")
        self.written += data
        return len(data)

    def close(self) -> None:
        """Nothing to give back."""

    def take(self) -> bytes:
        data = bytes(self.written)
        self.written.clear()
        return data


def frame(**values: int) -> bytes:
    filled = {"mode": 1, "voltage_mv": 15000, "charge_mah": 2000, "capacity_mah": 2600} | values
    body = b"".join(
        bytes((packet,)) + int(filled.get(name, 0)).to_bytes(calcsize(kind), "big", signed=kind in "hb")
        for packet, (kind, name) in oi.STREAMED.items()
    )
    head = bytes((19, len(body))) + body
    return head + bytes((-sum(head) & 0xFF,))


def started(port: ScriptedPort, base: Create2, now: float = 0.0, **values: int) -> float:
    """Bring the base into its stream; returns the time then."""
    for _ in range(8):
        base.poll(now)
        port.arriving += frame(**values)
        now += 0.015
    base.poll(now)
    port.take()
    return now


def test_it_starts_with_start_and_the_stream_of_all_packets():
    port = ScriptedPort()
    base = Create2(lambda: port)
    base.poll(0.0)
    assert port.take() == bytes(40) + START, "zeros fill a command that another program left half said"
    base.poll(0.02)
    assert port.take() == b"", "older manuals ask for 20 ms after a change of mode"
    base.poll(0.03)
    assert port.take() == bytes((148, 25, *oi.STREAMED))


def test_a_frame_becomes_a_state_with_units():
    port = ScriptedPort()
    base = Create2(lambda: port)
    now = started(port, base)
    port.arriving += frame(bumps_and_drops=0b0110, left_count=-5, charging_state=2, chargers=2, buttons=2, mode=1)
    state = base.poll(now)
    assert state is not None
    assert (state.bump_left, state.bump_right, state.wheel_drop_right, state.wheel_drop_left) == (
        True,
        False,
        True,
        False,
    )
    assert state.left_count == -5
    assert state.charging and state.docked and state.spot_pressed
    assert state.battery_ratio == pytest.approx(2000 / 2600)


@pytest.mark.parametrize(
    ("bits", "ahead"),
    [(0b000001, False), (0b000010, True), (0b000100, True), (0b001000, True), (0b010000, True), (0b100000, False)],
)
def test_all_light_bumpers_but_the_outermost_tell_of_something_ahead(bits: int, ahead: bool):
    port = ScriptedPort()
    base = Create2(lambda: port)
    now = started(port, base)
    port.arriving += frame(light_bumpers=bits)
    state = base.poll(now)
    assert state is not None and (state.light_bumpers, state.something_ahead) == (bits, ahead)


def test_a_capacity_of_nothing_just_after_boot_is_no_ratio():
    port = ScriptedPort()
    base = Create2(lambda: port)
    now = started(port, base)
    port.arriving += frame(capacity_mah=0)
    state = base.poll(now)
    assert state is not None and state.battery_ratio is None


def test_speeds_go_out_right_wheel_first_and_it_says_what_was_sent():
    port = ScriptedPort()
    base = Create2(lambda: port)
    now = started(port, base)
    base.set_mode(Mode.SAFE, now)
    assert port.take() == SAFE
    sent = base.drive(WheelSpeeds(100.4, -31), now + 0.1)
    assert sent == WheelSpeeds(100, -31)
    assert port.take() == bytes((145, 0xFF, 0xE1, 0, 100))


def test_in_passive_nothing_is_driven_and_it_says_so():
    port = ScriptedPort()
    base = Create2(lambda: port)
    now = started(port, base)
    assert base.drive(WheelSpeeds(100, 100), now) == STOP
    assert port.take() == b""


def test_a_speed_that_nobody_renews_is_stopped_until_the_wheels_stand():
    port = ScriptedPort()
    base = Create2(lambda: port)
    now = started(port, base)
    base.set_mode(Mode.SAFE, now)
    now += 0.1
    base.drive(WheelSpeeds(100, 100), now)
    port.take()
    count, stops, until = 0, 0, now + 2.0
    while now < until:
        now += 0.015
        count += 3 if now < until - 0.8 else 0  # the base goes on turning: the first stop was lost
        port.arriving += frame(left_count=count, right_count=count, mode=2)
        base.poll(now)
        stops += port.take().count(bytes((145, 0, 0, 0, 0)))
    assert 6 <= stops <= 12, "every 0.1 s from 0.4 s on, until three frames show equal counts"


def test_the_base_is_taken_again_when_the_reason_for_its_fall_to_passive_is_gone():
    port = ScriptedPort()
    base = Create2(lambda: port)
    now = started(port, base)
    base.set_mode(Mode.SAFE, now)
    now += 0.6
    port.take()
    port.arriving += frame(mode=1, cliff_left=1)
    base.poll(now)
    assert port.take() == b"", "over a cliff it stays in Passive"
    port.arriving += frame(mode=1)
    base.poll(now + 0.02)
    assert port.take() == SAFE


def test_on_the_dock_safe_is_not_asked_for_again_and_again():
    port = ScriptedPort()
    base = Create2(lambda: port)
    now = started(port, base)
    base.set_mode(Mode.SAFE, now)
    port.take()
    port.arriving += frame(mode=1, chargers=2)
    base.poll(now + 1.0)
    assert port.take() == b""


def test_a_firmware_that_counts_modes_one_too_high_is_understood():
    port = ScriptedPort()
    base = Create2(lambda: port)
    now = started(port, base, mode=2)
    assert base.state is not None and base.state.mode is Mode.PASSIVE
    base.set_mode(Mode.SAFE, now)
    port.arriving += frame(mode=3)
    state = base.poll(now + 0.6)
    assert state is not None and state.mode is Mode.SAFE
    assert port.take() == SAFE, "and it is not asked twice"


def test_an_odd_mode_is_no_mode_and_standing_wheels_show_that_it_is_lost():
    port = ScriptedPort()
    base = Create2(lambda: port)
    now = started(port, base)
    base.set_mode(Mode.SAFE, now)
    port.take()
    asked = b""
    for _ in range(60):
        now += 0.015
        base.drive(WheelSpeeds(100, 100), now)
        port.arriving += frame(mode=32)
        state = base.poll(now)
        assert state is not None and state.mode is Mode.UNKNOWN
        asked += port.take()
    assert asked.count(SAFE) == 1


def test_an_unplugged_cable_is_opened_again_and_the_base_started_anew():
    ports = [ScriptedPort(), ScriptedPort()]
    waiting = iter(ports)
    base = Create2(lambda: next(waiting))
    now = started(ports[0], base)
    ports[0].unplugged = True
    base.poll(now)
    assert base.health.problem is not None
    base.poll(now + 0.5)
    assert not ports[1].written, "it tries every second"
    base.poll(now + 1.1)
    assert START in ports[1].take()
    assert base.health.reconnections == 1 and base.health.problem is None


def test_a_silent_base_is_started_again():
    port = ScriptedPort()
    base = Create2(lambda: port)
    now = started(port, base)
    base.poll(now + 0.5)
    assert port.take() == b""
    base.poll(now + 1.2)
    assert START in port.take()


def test_seeking_the_dock_gives_the_wheels_to_the_firmware():
    port = ScriptedPort()
    base = Create2(lambda: port)
    now = started(port, base)
    base.set_mode(Mode.SAFE, now)
    base.poll(now + 0.1)
    port.take()
    base.seek_dock(now + 0.1)
    assert port.take() == SEEK
    port.arriving += frame(mode=1)
    base.poll(now + 2.0)
    assert base.drive(WheelSpeeds(50, 50), now + 2.0) == STOP
    assert port.take() == b""


def test_it_ends_in_passive_so_that_the_base_can_charge():
    port = ScriptedPort()
    base = Create2(lambda: port)
    started(port, base)
    base.close()
    assert port.take() == bytes((145, 0, 0, 0, 0, 128))


def test_an_absent_port_is_named_with_the_way_out(tmp_path: Path):
    with pytest.raises(PortAbsent, match="No such file or directory") as raised:
        Create2(lambda: open_serial(str(tmp_path / "ttyUSB9")))
    assert "--simulated" in str(raised.value) and "ttyUSB9" in str(raised.value)


@pytest.mark.parametrize(
    ("wanted", "sent"),
    [
        (WheelSpeeds(10, -10), WheelSpeeds(0, 0)),
        (WheelSpeeds(16, -29.6), WheelSpeeds(30, -30)),
        (WheelSpeeds(400, 200), WheelSpeeds(200, 100)),
        (WheelSpeeds(0.4, 199.6), WheelSpeeds(0, 200)),
    ],
)
def test_no_wheel_is_ever_asked_for_a_speed_it_does_badly(wanted: WheelSpeeds, sent: WheelSpeeds):
    assert possible(wanted) == sent


def test_no_drive_command_that_loses_its_first_byte_becomes_a_dangerous_one() -> None:
    dangerous = {7, 129, 132, 133, 134, 135, 136, 143, 173}
    for speed in (*range(-200, -29), *range(30, 201)):
        sent = possible(WheelSpeeds(speed, speed))
        assert not dangerous & set(oi.drive_direct(sent)[1:])
        assert 0 <= abs(speed) - abs(sent.left_mm_s) <= 5


def test_the_manuals_own_song_and_light_bytes_come_out():
    assert oi.leds(0.0, 128 / 255) == bytes((139, 0, 0, 128))
    assert oi.song(((60, 0.5), (62, 0.25))) == bytes((140, 0, 2, 60, 32, 62, 16))
