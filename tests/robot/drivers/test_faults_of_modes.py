"""Firmware that counts its modes otherwise, is slow, or falls back: who is master of the wheels."""

import pytest

from robot.drivers.interfaces import Mode
from tests.robot.drivers.against_the_byte_machine import AHEAD, Join


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
