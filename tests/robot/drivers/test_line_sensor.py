"""Three diodes on mock pins: polarity, majority, and the pins' own strictness."""

from collections.abc import Iterator

import pytest
from gpiozero.pins.mock import MockFactory

from robot.drivers.interfaces import LineReading
from robot.drivers.line_sensor import ThreeDiodes


@pytest.fixture
def factory() -> Iterator[MockFactory]:
    made = MockFactory()
    yield made
    made.close()


def light(factory: MockFactory, pattern: str) -> None:
    """0 = over the line = low, in the order left (BOARD12), centre (BOARD10), right (BOARD8)."""
    for pin, digit in zip(("BOARD12", "BOARD10", "BOARD8"), pattern, strict=True):
        factory.pin(pin).drive_high() if digit == "1" else factory.pin(pin).drive_low()


def three(factory: MockFactory, line_is_low: bool = True) -> ThreeDiodes:
    return ThreeDiodes("BOARD12", "BOARD10", "BOARD8", factory, line_is_low)


@pytest.mark.parametrize("pattern", ["101", "110", "100", "011", "001", "000", "111", "010"])
def test_pins_read_as_the_papers_patterns(factory: MockFactory, pattern: str):
    sensor = three(factory)
    light(factory, pattern)
    sensor.sample()
    assert sensor.read().pattern == pattern
    sensor.close()


def test_a_board_with_the_other_polarity_is_a_setting(factory: MockFactory):
    sensor = three(factory, line_is_low=False)
    light(factory, "010")
    sensor.sample()
    assert sensor.read() == LineReading(False, True, False)
    sensor.close()


def test_one_flipped_sample_of_four_does_not_count(factory: MockFactory):
    sensor = three(factory)
    for pattern in ("101", "101", "010", "101"):
        light(factory, pattern)
        sensor.sample()
    assert sensor.read().pattern == "101"
    sensor.close()


def test_a_tie_leaves_a_diode_as_it_was(factory: MockFactory):
    sensor = three(factory)
    light(factory, "101")
    sensor.sample()
    assert sensor.read().pattern == "101"
    for pattern in ("101", "011"):
        light(factory, pattern)
        sensor.sample()
    assert sensor.read().pattern == "101"
    assert sensor.read().pattern == "101", "and without a new sample nothing changes"
    sensor.close()
