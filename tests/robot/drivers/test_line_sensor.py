"""Three diodes on mock pins: polarity, majority, and the pins' own strictness."""

from collections.abc import Iterator
from random import Random

import pytest
from gpiozero.pins.mock import MockFactory

from robot.drivers.interfaces import LineReading
from robot.drivers.line_sensor import ThreeDiodes
from robot.reflexes import Lasting

TICKS = 2000


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


@pytest.mark.parametrize("samples", [4, 10], ids=["200 Hz", "500 Hz"])
def test_five_flipped_reads_in_a_hundred_become_fewer_than_one_wrong_pattern_in_two_hundred(
    factory: MockFactory, samples: int
) -> None:
    """Three diodes at 50 ticks a second, an edge of the tape every half second: 14 % of the single looks are wrong."""
    random, sensor, true = Random(5), three(factory), "101"
    wrong_looks = wrong_reads = 0
    for tick in range(TICKS):
        if tick % 25 == 0:
            true = random.choice(("101", "001", "100", "011", "110", "111"))
        for _ in range(samples):
            pattern = "".join(digit if random.random() >= 0.05 else str(1 - int(digit)) for digit in true)
            wrong_looks += pattern != true
            light(factory, pattern)
            sensor.sample()
        wrong_reads += sensor.read().pattern != true
    assert wrong_looks / (TICKS * samples) > 0.12
    assert wrong_reads / TICKS < 0.005
    sensor.close()


def test_a_diode_changes_only_with_a_clear_majority(factory: MockFactory) -> None:
    sensor = three(factory)
    for over, changes in ((1, False), (2, False), (3, True)):
        for sample in range(4):
            light(factory, "011" if sample < over else "111")
            sensor.sample()
        assert sensor.read().left is changes
    for sample in range(4):
        light(factory, "111" if sample < 2 else "011")
        sensor.sample()
    assert sensor.read().left, "and back again no sooner"
    sensor.close()


def test_a_pattern_that_no_tape_makes_is_counted() -> None:
    lasting = Lasting()
    for step, pattern in enumerate(("101", "010", "010", "010", "001")):
        lasting.look(LineReading(*(digit == "0" for digit in pattern)), 10.0 * step, None)
        if step == 3:
            assert lasting.impossible_mm == 30.0
    assert lasting.impossible_reads == 3
    assert lasting.impossible_mm == 0.0, "one tape that passes again speaks for the sensor"


def test_travel_without_a_change_of_any_diode_is_measured_until_somebody_looks() -> None:
    lasting = Lasting()
    for travelled_mm in range(0, 3000, 10):
        lasting.look(LineReading(False, True, False), float(travelled_mm), None)
    assert lasting.constant_mm == 2990.0
    lasting.start_again()
    assert lasting.constant_mm == 0.0
