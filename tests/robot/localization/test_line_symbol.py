"""The line in the paper's five words, with hysteresis."""

import pytest

from robot.drivers.interfaces import LineReading
from robot.localization.line_symbol import BelievedLineSymbol, LineSymbol


def reading(pattern: str) -> LineReading:
    return LineReading(*(digit == "0" for digit in pattern))


def after(word: BelievedLineSymbol, pattern: str, *travelled_mm: float) -> BelievedLineSymbol:
    for here_mm in travelled_mm:
        word = word.seen(reading(pattern), here_mm)
    return word


@pytest.mark.parametrize(
    ("pattern", "word"),
    [("101", "center"), ("110", "right"), ("100", "right"), ("011", "left"), ("001", "left"), ("000", "across")],
)
def test_patterns_are_the_papers(pattern: str, word: str):
    assert reading(pattern).pattern == pattern
    assert after(BelievedLineSymbol(), pattern, 0, 1).word == word


def test_one_tick_is_not_enough():
    word = after(BelievedLineSymbol(), "101", 0, 1)
    assert after(word, "011", 2).word is LineSymbol.CENTER
    assert after(word, "011", 2, 3).word is LineSymbol.LEFT


@pytest.mark.parametrize("nothing", ["111", "010"])
def test_a_worn_place_in_the_tape_is_not_a_lost_line(nothing: str):
    word = after(BelievedLineSymbol(), "101", 0, 1)
    assert after(word, nothing, 2, 10, 30).word is LineSymbol.CENTER
    assert after(word, nothing, 2, 10, 30, 33).word is LineSymbol.LOST


def test_a_long_way_over_darkness_is_off_the_track_and_no_crossing():
    word = after(BelievedLineSymbol(), "000", 0, 1, 40, 79)
    assert word.word is LineSymbol.ACROSS
    assert after(word, "000", 82).word is LineSymbol.LOST
