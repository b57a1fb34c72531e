"""The level at which a robot is charged enough, and the time it takes to get there."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fleet.charging.curve import FULL, ChargeCurve
from fleet.charging.levels import Level, Thresholds, ThresholdsMixedUp

CURVE = ChargeCurve(10_800.0)
ratios = st.floats(0.0, 1.0)


def test_a_level_is_lost_at_once_and_won_only_clearly() -> None:
    thresholds = Thresholds()
    level = thresholds.level(0.26)
    told = [0.26, 0.24, 0.26, 0.279, 0.29, 0.26, 0.24]
    seen = [level := thresholds.level(ratio, level) for ratio in told]
    low, fair = Level.LOW, Level.FAIR
    assert seen == [fair, low, low, low, fair, fair, low]
    assert thresholds.level(0.99) == Level.FULL
    assert thresholds.level(0.05, Level.FULL) == Level.CRITICAL


@given(st.lists(ratios, min_size=2, max_size=20))
def test_within_the_hysteresis_no_level_comes_back(told: list[float]) -> None:
    thresholds, level = Thresholds(), None
    for ratio in told:
        before, level = level, thresholds.level(ratio, level)
        if before is not None and level > before:
            below = (thresholds.critical, thresholds.low, thresholds.sufficient, thresholds.full)
            assert ratio >= below[level - 1] + thresholds.hysteresis
        assert level <= thresholds.level(ratio)


def test_thresholds_in_the_wrong_order_are_refused() -> None:
    with pytest.raises(ThresholdsMixedUp, match="must rise"):
        Thresholds(critical=0.3)


def test_an_empty_pack_is_full_after_three_hours_and_slowest_at_the_end() -> None:
    assert CURVE.time_s(0.0, FULL) == pytest.approx(10_800.0)
    assert CURVE.time_s(0.2, 0.3) == pytest.approx(CURVE.time_s(0.6, 0.7))
    assert CURVE.time_s(0.89, 0.99) > 2 * CURVE.time_s(0.2, 0.3)
    assert CURVE.time_s(0.8, 0.5) == 0.0


@given(ratios, st.floats(0.0, FULL))
def test_after_the_time_that_it_takes_it_is_there(ratio: float, wanted: float) -> None:
    reached = CURVE.after(ratio, CURVE.time_s(ratio, wanted))
    assert reached == pytest.approx(max(ratio, wanted), abs=1e-6)


def test_a_slower_charger_is_found_out_and_a_break_is_not_one() -> None:
    true, curve = ChargeCurve(14_000.0), CURVE
    for _ in range(20):
        curve = curve.learned(0.3, 0.9, true.time_s(0.3, 0.9))
    assert curve.fill_s == pytest.approx(14_000.0, rel=0.02)
    assert curve.learned(0.3, 0.9, 10 * true.time_s(0.3, 0.9)) == curve
    assert curve.learned(0.3, 0.31, 20.0) == curve
