"""Counts that do not leap, whatever the base was through."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.drivers.create2.encoder_counts import EncoderCounts
from robot.drivers.create2.odometry import counts_between

FRAME_S = 0.015
any_count = st.integers(-32768, 32767)


def moved(counts: EncoderCounts, *readings: tuple[int, int], every_s: float = FRAME_S) -> list[int | None]:
    """Return what is believed of the left wheel, from the first reading on."""
    believed = [counts.accept(left, right, number * every_s) for number, (left, right) in enumerate(readings)]
    first = believed[0]
    assert first is not None
    return [None if one is None else counts_between(first[0], one[0]) for one in believed]


@given(any_count, any_count, any_count)
def test_one_wild_frame_is_no_movement_and_the_next_sound_one_counts(start: int, left: int, right: int) -> None:
    after = (start + 34 + 32768) % 65536 - 32768
    told = moved(EncoderCounts(), (start, start), (left, right), (after, after))
    assert told[1] is None or abs(told[1]) <= 131
    assert told[2] in (34, None)


@given(any_count, any_count)
def test_a_new_zero_is_believed_at_its_second_frame_and_is_no_way_driven(start: int, zero: int) -> None:
    if abs(counts_between(start, zero)) > 1000:
        assert moved(EncoderCounts(), (start, start), (zero, zero), (zero, zero)) == [0, None, 0]


@pytest.mark.parametrize("near", [-500, 100, 700])
def test_after_a_reset_even_a_near_zero_is_no_way_driven(near: int) -> None:
    counts = EncoderCounts()
    assert counts.accept(300, 300, 0.0) == (300, 300)
    counts.base_was_reset()
    assert counts.accept(300 + near, 300 + near, 5.0) == (300, 300)
    assert counts.accept(310 + near, 305 + near, 5.015) == (310, 305)


def test_what_was_driven_during_a_silence_counts() -> None:
    """200 mm/s for four seconds."""
    assert moved(EncoderCounts(), (0, 0), (1800, 1790), every_s=4.0) == [0, 1800]


def test_a_robot_that_is_pushed_quickly_is_believed() -> None:
    assert moved(EncoderCounts(), *((number * 60, number * 60) for number in range(4))) == [0, 60, 120, 180]
