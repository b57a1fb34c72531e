"""Damaged bytes, text, silence, another speed: what reaches the driver, and how it makes the base speak again."""

from itertools import pairwise

import pytest

from robot.drivers.create2.odometry import counts_between
from robot.drivers.interfaces import STOP, Mode, WheelSpeeds
from tests.robot.drivers.against_the_byte_machine import AHEAD, Join


@pytest.mark.parametrize(("switch", "share"), [("drop_byte", 0.005), ("flip_byte", 0.02)])
def test_damaged_bytes_cost_frames_and_no_false_state(join: Join, switch: str, share: float) -> None:
    one = join().started()
    one.robot.set_fault(switch, share)
    one.states.clear()
    one.run(20.0, AHEAD)
    assert one.base.health.corrupt > 20
    assert len(one.states) > 200
    for old, new in pairwise(one.states):
        assert -3 <= counts_between(old.left_count, new.left_count) <= 140
        assert 14_000 < new.voltage_mv < 18_000 or switch == "flip_byte"
    assert one.robot.driven_mm == pytest.approx(2000, rel=0.1)


def test_bytes_lost_on_the_way_out_make_other_commands_and_all_of_them_are_mended(join: Join) -> None:
    """The bytes of a speed of 128 mm/s and more are opcodes, too: Full, Power, Clean, Stop, Seek Dock."""
    one = join().started()
    one.robot.set_fault("drop_sent_byte", 0.03)
    modes = set()
    for number in range(90):
        one.run(0.5, WheelSpeeds(128 + number % 46, 128 + (number + 7) % 46))
        modes.add(one.robot.state()["mode"])
    assert len(modes) > 1, "bad luck enough"
    one.robot.set_fault("drop_sent_byte", 0.0)
    one.run(8.0, AHEAD)
    assert one.base.state is not None and one.base.state.mode is Mode.SAFE
    assert one.wheels_mm_s == pytest.approx([100, 100], abs=12)
    one.run(1.0, STOP)
    assert one.wheels_mm_s == [0, 0]


def test_a_base_that_waits_for_the_rest_of_a_long_command_is_filled_up_and_stops(join: Join) -> None:
    one = join().started()
    one.run(1.0, AHEAD)
    one.robot.memory_port().write(bytes((140, 0, 255)))  # 510 notes and lengths are to come
    one.run(1.0, STOP)
    assert one.wheels_mm_s == [0, 0]
    one.run(1.0, AHEAD)
    assert one.wheels_mm_s[0] > 80


def test_text_between_frames_is_kept_as_text(join: Join) -> None:
    one = join().started()
    one.robot.print_text()
    one.run(0.1, AHEAD)
    assert one.base.health.firmware_lines[-1] == "ERROR: language set error type 2"
    assert one.base.health.corrupt == 0


@pytest.mark.parametrize("wired", [True, False])
def test_a_base_frozen_for_some_seconds_is_started_again_and_stopped_first(join: Join, wired: bool) -> None:
    one = join(brc=wired).started()
    one.run(1.0, AHEAD)
    one.robot.set_fault("freeze_s", 4.0)
    one.run(3.9, STOP)
    assert one.wheels_mm_s[0] > 80, "it hears nothing, so it drives on"
    assert one.after_s(4.0) < 4.0
    one.run(1.0, STOP)
    assert max(map(abs, one.wheels_mm_s)) < 1
    one.run(1.0, AHEAD)
    assert one.base.state is not None and one.base.state.mode is Mode.SAFE
    assert one.wheels_mm_s[0] > 80


def test_a_base_that_is_frozen_for_long_is_a_broken_link_and_told_as_such(join: Join) -> None:
    one = join("dock", battery_ratio=0.5)
    one.run(5.0)
    assert one.base.state is not None and one.base.state.charging and not one.base.health.down
    one.robot.set_fault("frozen", True)
    one.run(59.0)
    assert not one.base.health.down and one.base.health.silent_s > 58
    one.run(3.0)
    assert one.base.health.down
    one.robot.set_fault("frozen", False)
    one.after_s(20.0)
    one.run(0.1)
    assert not one.base.health.down and one.base.health.silent_s < 0.1


def test_a_base_at_19200_baud_is_found_named_and_set_back(join: Join) -> None:
    one = join()
    one.robot.set_fault("slow_line", True)
    took_s = one.after_s(20.0)
    assert took_s < 12
    assert one.base.health.spoke_at_baud == 19200
    assert one.robot.body.interface.baud == 115200
    one.started().run(1.0, AHEAD)
    assert one.wheels_mm_s[0] > 80


def test_three_short_pulses_of_another_program_are_set_back_too(join: Join) -> None:
    one = join().started()
    for _ in range(3):
        one.robot.brc.low(True)
        one.run(0.1)
        one.robot.brc.low(False)
        one.run(0.1)
    assert one.robot.body.interface.baud == 19200
    one.after_s(20.0)
    assert one.base.health.spoke_at_baud == 19200


def test_our_own_pulses_never_switch_the_line(join: Join) -> None:
    one = join()
    one.robot.set_fault("frozen", True)
    one.run(20.0)
    one.robot.set_fault("frozen", False)
    assert one.robot.body.interface.baud == 115200
