"""Robots that may enter one more corridor: those that reach a dock after it, and need none on the way."""

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from fleet.charging.energy import Use, assumed_rates
from fleet.charging.going_on import HELD_UP_S, Charge, goes_on
from fleet.charging.levels import Thresholds

RATES = replace(assumed_rates(7200.0, 19_000.0, 0.2), stretches=50, driving_var=0.003, standing_var=0.003)
THRESHOLDS = Thresholds()
uses = st.builds(Use, st.floats(0, 800), st.floats(0, 6000))


def test_before_each_leg_the_way_to_a_dock_is_looked_at_again() -> None:
    leg, there = Use(80.0, 400.0), Use(100.0, 500.0)
    needed = THRESHOLDS.critical + RATES.at_most(leg + there + Use(0.0, HELD_UP_S))
    assert needed > THRESHOLDS.low
    assert goes_on(Charge(needed + 0.001, RATES), leg, there, THRESHOLDS)
    assert not goes_on(Charge(needed - 0.001, RATES), leg, there, THRESHOLDS)
    assert not goes_on(Charge(0.26, RATES), leg, Use(), THRESHOLDS), "its own plan would take over on the way"


def test_half_an_hour_before_a_closed_corridor_leaves_enough_to_come_to_the_dock() -> None:
    leg, there, held_up = Use(80.0, 400.0), Use(270.0, 1400.0), Use(0.0, 1800.0)
    least = next(ratio / 1000 for ratio in range(1000) if goes_on(Charge(ratio / 1000, RATES), leg, there, THRESHOLDS))
    assert least - RATES.at_most(leg + held_up + there) >= THRESHOLDS.critical


@given(st.floats(0, 1), st.floats(0, 1), uses, uses)
def test_with_more_charge_or_less_of_a_way_it_goes_on_all_the_more(
    ratio: float, more: float, leg: Use, there: Use
) -> None:
    if goes_on(Charge(ratio, RATES), leg, there, THRESHOLDS):
        assert goes_on(Charge(max(ratio, more), RATES), leg, there, THRESHOLDS)
        assert goes_on(Charge(ratio, RATES), leg, Use(), THRESHOLDS)
