"""Touch, motors and counts as the byte machine makes them: what the driver tells."""

from itertools import pairwise

import pytest

from robot.drivers.create2.odometry import counts_between
from robot.drivers.interfaces import STOP, WheelSpeeds
from tests.robot.drivers.against_the_byte_machine import AHEAD, Join


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
