"""Fault by fault: what a switch of the byte machine does to the driver, and what the driver does about it."""

from collections.abc import Callable
from itertools import pairwise

import pytest

from robot.drivers.interfaces import STOP, ChargingState, Mode, WheelSpeeds
from robot.drivers.odometry import counts_between
from robot.simulated import SWITCHES
from tests.robot.drivers.against_the_byte_machine import Together

Join = Callable[..., Together]
AHEAD = WheelSpeeds(100, 100)
SAFE_THEN_START = b"\x83\x80"
RESET = 7
OF_THE_BASE = {
    "drop_byte",
    "flip_byte",
    "drop_sent_byte",
    "frozen",
    "freeze_s",
    "mode_offset",
    "mode_silent",
    "angle_bug",
    "distance_bug",
    "encoder_offset",
    "capacity_unknown",
    "slow_modes",
    "slow_line",
    "brc_dead",
    "brc_only_wakes",
    "never_sleeps",
    "sleep_after_s",
    "dock_mute",
    "bump_left",
    "bump_right",
    "cliff_left",
    "cliff_front_left",
    "cliff_front_right",
    "cliff_right",
    "wheel_drop_left",
    "wheel_drop_right",
    "over_current",
    "stuck",
    "slipping",
    "wheels_jammed",
    "virtual_wall",
    "dock_beams_off",
    "dock_unpowered",
    "contact_bounce",
    "charge_fault",
}
ELSEWHERE = {
    "floor_flip",
    "floor_edge_mm",
    "pins_stuck",
    "camera_dead",
    "darkness",
    "dirt",
    "under_voltage",
    "clock_jump",
    "disk_full",
}


def test_every_switch_is_the_bases_or_another_devices() -> None:
    """A new switch has to be put into one of the two lists, and tested there."""
    assert set(SWITCHES) == OF_THE_BASE | ELSEWHERE


# The line


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


# Modes


def test_a_firmware_that_counts_one_too_high_is_understood_even_when_it_was_in_safe_before(join: Join) -> None:
    one = join()
    one.robot.set_fault("mode_offset", 1)
    one.started().run(1.0, AHEAD)
    assert one.base.state is not None and one.base.state.mode is Mode.SAFE
    one.base.set_mode(Mode.FULL, one.now)
    one.run(0.2, AHEAD)
    assert one.base.state.mode is Mode.FULL


def test_mode_32_is_no_mode_and_the_robot_drives_all_the_same(join: Join) -> None:
    one = join()
    one.robot.set_fault("mode_offset", 31)
    one.started().run(2.0, AHEAD)
    assert one.base.state is not None and one.base.state.mode is Mode.UNKNOWN
    assert one.robot.driven_mm > 150


def test_a_firmware_that_never_answers_packet_35_is_streamed_without_it(join: Join) -> None:
    one = join(brc=False)
    one.robot.set_fault("mode_silent", True)
    assert one.after_s(20.0) < 6
    assert not one.base.health.tells_mode
    one.started().run(2.0, AHEAD)
    assert one.base.state is not None and one.base.state.mode is Mode.UNKNOWN
    assert one.robot.driven_mm > 150
    one.robot.lift(True)
    one.run(0.5, AHEAD)
    one.robot.lift(False)
    one.run(2.0, AHEAD)
    assert one.wheels_mm_s[0] > 80, "wheels that stand show that the mode is lost"


@pytest.mark.parametrize(
    "half", [(145,), (145, 0, 100, 0), (137, 1), (140, 0, 16, 60), (148, 25, 7, 9), (139,), (167, 1, 2)]
)
def test_who_died_in_the_middle_of_a_command_leaves_no_base_that_waits(join: Join, half: tuple[int, ...]) -> None:
    one = join()
    one.robot.memory_port().write(bytes((128, 131, *half)))
    one.started().run(1.0, AHEAD)
    assert one.base.health.starts == 1
    assert one.robot.driven_mm == pytest.approx(95, abs=15), "and the wheels never did anything else"


def test_lights_come_back_with_the_mode(join: Join) -> None:
    one = join().started()
    one.base.show_lights(1.0, 0.5, one.now)
    one.robot.lift(True)
    one.run(0.2)
    one.robot.lift(False)
    one.run(1.0)
    assert one.base.state is not None and one.base.state.mode is Mode.SAFE
    assert one.robot.body.interface.actuators.leds == (0, 255, 128)


@pytest.mark.parametrize("bit", [1, 2, 4])
def test_a_short_press_is_shown_long_enough_for_whoever_looks_ten_times_a_second(join: Join, bit: int) -> None:
    one = join().started()
    one.states.clear()
    one.robot.memory_port().write(bytes((165, bit)))
    one.run(1.0)
    pressed = [state.at_s for state in one.states if state.buttons == bit]
    assert pressed[-1] - pressed[0] == pytest.approx(0.3, abs=0.05)
    assert one.states[-1].buttons == 0


def test_commands_wait_until_a_slow_firmware_has_changed_its_mode(join: Join) -> None:
    one = join()
    one.robot.set_fault("slow_modes", True)
    one.started().run(1.0, AHEAD)
    assert one.robot.driven_mm > 60 and one.base.health.starts == 1


@pytest.mark.parametrize("part", ["cliff_left", "cliff_front_left", "cliff_front_right", "cliff_right"])
def test_each_cliff_sensor_has_its_place_and_takes_the_wheels(join: Join, part: str) -> None:
    one = join().started()
    one.run(0.5, AHEAD)
    one.robot.set_fault(part, True)
    one.run(0.3, AHEAD)
    state = one.base.state
    assert state is not None and getattr(state, part) and state.mode is Mode.PASSIVE
    assert max(map(abs, one.wheels_mm_s)) < 5
    one.take_sent()
    one.run(2.0)
    assert b"\x83" not in one.take_sent(), "over the edge it is not asked for again"
    one.robot.set_fault(part, False)
    one.run(1.0)
    assert one.base.state is not None and one.base.state.mode is Mode.SAFE


@pytest.mark.parametrize("part", ["wheel_drop_left", "wheel_drop_right"])
def test_a_wheel_that_drops_takes_the_wheels_until_it_stands_again(join: Join, part: str) -> None:
    one = join().started()
    one.robot.set_fault(part, True)
    one.run(0.3, AHEAD)
    assert one.base.state is not None
    assert getattr(one.base.state, part) and one.base.state.mode is Mode.PASSIVE
    one.robot.set_fault(part, False)
    one.run(1.0, AHEAD)
    assert one.base.state.mode is Mode.SAFE


# Touch, motors, counts


@pytest.mark.parametrize("part", ["bump_left", "bump_right"])
def test_a_touch_shorter_than_a_tick_is_not_lost(join: Join, part: str) -> None:
    one = join().started()
    one.states.clear()
    one.robot.set_fault(part, True)
    one.robot.step_until(one.now + 0.016)
    one.robot.set_fault(part, False)
    one.run(0.1, tick_s=0.05)
    assert [getattr(state, part) for state in one.states] == [True, False]


def test_over_current_and_stasis_are_told_per_wheel(join: Join) -> None:
    one = join().started()
    one.run(0.5, AHEAD)
    assert one.base.state is not None and one.base.state.stasis == 1
    one.robot.set_fault("over_current", True)
    one.run(0.1, AHEAD)
    assert one.base.state.wheel_over_current
    one.robot.set_fault("over_current", False)
    one.robot.set_fault("stuck", True)
    one.run(0.1, AHEAD)
    assert one.base.state.stasis == 0


@pytest.mark.parametrize("switch", ["stuck", "slipping"])
def test_wheels_that_turn_in_place_still_count(join: Join, switch: str) -> None:
    one = join().started()
    one.robot.set_fault(switch, True)
    before = one.base.state
    one.run(1.0, AHEAD)
    assert before is not None and one.base.state is not None
    assert counts_between(before.left_count, one.base.state.left_count) > 150
    assert one.base.state.stasis == 0


def test_jammed_wheels_count_nothing_and_a_stop_is_not_repeated_for_ever(join: Join) -> None:
    one = join().started()
    one.robot.set_fault("wheels_jammed", True)
    before = one.base.state
    one.run(1.0, AHEAD)
    assert before is not None and one.base.state is not None
    assert one.base.state.left_count == before.left_count
    one.run(1.0, STOP)
    one.take_sent()
    one.run(1.0, STOP)
    assert one.take_sent() == b""


@pytest.mark.parametrize("offset", [30_000, -30_000, 32_767])
def test_counts_that_begin_elsewhere_are_no_movement(join: Join, offset: int) -> None:
    one = join().started()
    one.run(1.0, AHEAD)
    one.states.clear()
    one.robot.set_fault("encoder_offset", offset)
    one.run(1.0, AHEAD)
    steps = [counts_between(old.left_count, new.left_count) for old, new in pairwise(one.states)]
    assert min(steps) >= -2 and max(steps) < 30
    assert sum(steps) == pytest.approx(100 / 0.44456, rel=0.15)


@pytest.mark.parametrize("offset", [32_700, -32_700])
def test_counts_that_wrap_on_the_way_are_no_leap(join: Join, offset: int) -> None:
    one = join()
    one.robot.set_fault("encoder_offset", offset)
    one.started()
    one.states.clear()
    one.run(2.0, AHEAD if offset > 0 else WheelSpeeds(-100, -100))
    steps = [abs(counts_between(old.left_count, new.left_count)) for old, new in pairwise(one.states)]
    assert max(steps) < 30 and one.base.health.corrupt == 0


@pytest.mark.parametrize("switch", ["angle_bug", "distance_bug"])
def test_packets_19_and_20_are_not_used_at_all(join: Join, switch: str) -> None:
    one = join().started()
    one.robot.set_fault(switch, True)
    before = one.base.state
    one.run(2.0, WheelSpeeds(-80, 80))
    assert before is not None and one.base.state is not None
    turned = counts_between(before.right_count, one.base.state.right_count)
    assert turned == pytest.approx(155 / 0.44456, rel=0.06)


def test_a_virtual_wall_is_seen(join: Join) -> None:
    one = join().started()
    one.robot.set_fault("virtual_wall", True)
    one.run(0.1)
    assert one.base.state is not None and one.base.state.virtual_wall


# Battery and dock


def test_a_capacity_that_is_not_known_yet_is_no_ratio(join: Join) -> None:
    one = join().started()
    one.robot.set_fault("capacity_unknown", True)
    one.run(0.1)
    assert one.base.state is not None and one.base.state.battery_ratio is None


def test_a_battery_that_sags_is_told_at_once(join: Join) -> None:
    one = join(battery_ratio=0.9).started()
    one.robot.sag(0.08)
    one.run(0.1)
    assert one.base.state is not None and one.base.state.battery_ratio == pytest.approx(0.08, abs=0.01)


def test_a_faulty_charger_is_no_charging(join: Join) -> None:
    one = join("dock", battery_ratio=0.5)
    one.robot.set_fault("charge_fault", True)
    one.run(5.0)
    assert one.base.state is not None
    assert one.base.state.charging_state is ChargingState.FAULT and not one.base.state.charging


def test_a_dock_without_mains_is_no_dock(join: Join) -> None:
    one = join("dock", battery_ratio=0.5)
    one.robot.set_fault("dock_unpowered", True)
    one.run(5.0)
    assert one.base.state is not None and not one.base.state.docked and not one.base.state.charging


def test_bouncing_contacts_show_as_they_are_and_passive_is_kept(join: Join) -> None:
    one = join("dock", battery_ratio=0.5)
    one.run(1.0)
    one.robot.set_fault("contact_bounce", True)
    one.states.clear()
    one.take_sent()
    one.run(10.0)
    assert {state.docked for state in one.states} == {True, False}
    assert one.take_sent() == b"", "nothing is sent that would end the charge"


def test_seek_dock_without_beams_ends_with_wheels_that_stand_in_passive(join: Join) -> None:
    one = join("post5").started()
    one.robot.set_fault("dock_beams_off", True)
    one.base.seek_dock(one.now)
    one.run(70.0)
    assert one.base.state is not None and one.base.state.mode is Mode.PASSIVE
    assert not one.base.state.docked and one.base.state.ir_omni == 0
    assert max(map(abs, one.wheels_mm_s)) == 0


def test_a_base_that_is_deaf_in_its_dock_is_reset(join: Join) -> None:
    one = join("dock", battery_ratio=0.5)
    one.robot.set_fault("dock_mute", True)
    one.run(31.0)
    frames = one.base.health.frames
    one.robot.set_fault("dock_mute", False)
    one.run(2.0)
    assert one.base.health.frames == frames
    one.take_sent()
    assert one.after_s(40.0) < 20
    assert bytes((RESET,)) in one.take_sent()
    one.run(0.1)
    assert one.base.health.awoken_by == "reset" and one.base.health.firmware == "3.7.7"


# Sleep


def test_pulses_on_brc_keep_it_awake(join: Join) -> None:
    one = join()
    one.robot.set_fault("sleep_after_s", 70.0)
    one.run(200.0)
    assert not one.robot.state()["asleep"] and one.base.health.starts == 1


@pytest.mark.parametrize("switch", ["brc_dead", "brc_only_wakes"])
def test_a_base_that_sleeps_all_the_same_is_noticed(join: Join, switch: str) -> None:
    one = join()
    one.robot.set_fault(switch, True)
    one.robot.set_fault("sleep_after_s", 30.0)
    one.run(29.0)
    assert not one.robot.state()["asleep"]
    one.run(2.0)
    assert one.robot.state()["asleep"]
    if switch == "brc_only_wakes":
        assert one.after_s(5.0) < 5
        assert one.base.health.awoken_by == "wake by BRC"
    else:
        one.run(65.0)
        assert one.base.health.down, "nothing wakes it but a hand"


def test_without_brc_it_is_stirred_every_four_minutes(join: Join) -> None:
    one = join(brc=False)
    one.run(1.0)
    one.take_sent()
    one.run(235.0, tick_s=0.2)
    assert one.take_sent() == b""
    one.run(300.0, tick_s=0.2)
    assert one.take_sent() == 2 * SAFE_THEN_START
    assert not one.robot.state()["asleep"] and one.base.health.starts == 1


def test_without_brc_nothing_is_sent_in_the_dock(join: Join) -> None:
    one = join("dock", brc=False, battery_ratio=0.5)
    one.run(1.0)
    one.take_sent()
    one.run(400.0, tick_s=0.2)
    assert one.take_sent() == b""
    assert one.base.state is not None and one.base.state.charging


def test_a_base_in_use_never_sleeps(join: Join) -> None:
    one = join(brc=False)
    one.robot.set_fault("sleep_after_s", 10.0)
    one.started().run(30.0, STOP)
    assert not one.robot.state()["asleep"]
    assert one.base.health.starts == 1


def test_never_sleeping_is_no_harm(join: Join) -> None:
    one = join(brc=False)
    one.robot.set_fault("never_sleeps", True)
    one.run(320.0, tick_s=0.2)
    assert one.base.health.starts == 1
