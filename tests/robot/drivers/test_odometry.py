"""Where the encoders say the robot is: wrapping counts, turns, and which of them are on the spot."""

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.drivers.create2.odometry import advanced, counts_between
from robot.drivers.interfaces import BaseState, BodyShape, Odometry

SHAPE = BodyShape()


def driven(*counts: tuple[int, int]) -> Odometry:
    odometry = Odometry()
    for (l0, r0), (l1, r1) in pairwise(counts):
        old, new = BaseState(0.0, left_count=l0, right_count=r0), BaseState(0.0, left_count=l1, right_count=r1)
        odometry = advanced(odometry, old, new, SHAPE)
    return odometry


@given(st.integers(-32768, 32767), st.integers(-3000, 3000))
def test_a_wrap_in_either_direction_is_no_jump(start: int, moved: int):
    end = (start + moved + 32768) % 65536 - 32768
    assert counts_between(start, end) == moved


def test_one_turn_of_both_wheels_is_the_manuals_226_mm():
    odometry = driven((0, 0), *((i, i) for i in range(1, 510)))
    assert odometry.travelled_mm == pytest.approx(226.2, abs=0.2)
    assert odometry.heading_rad == 0


def test_a_turn_on_the_spot_is_counted_as_one_and_goes_nowhere():
    quarter = round(math.pi / 2 * SHAPE.wheel_base_mm / 2 / SHAPE.mm_per_count)
    odometry = driven(*((-i, i) for i in range(0, quarter + 1, 2)))
    assert odometry.heading_rad == pytest.approx(math.pi / 2, abs=0.01)
    assert odometry.spot_turn_rad == odometry.heading_rad
    assert odometry.travelled_mm == 0


def test_a_bend_of_the_line_is_no_turn_on_the_spot():
    odometry = driven(*((3 * i, 5 * i) for i in range(100)))
    assert odometry.heading_rad > 0.3
    assert odometry.spot_turn_rad == 0


def test_going_back_is_way_driven_but_not_way_ahead():
    odometry = driven((0, 0), (100, 100), (50, 50))
    assert odometry.travelled_mm == pytest.approx(150 * SHAPE.mm_per_count)
    assert odometry.ahead_mm == pytest.approx(50 * SHAPE.mm_per_count)
