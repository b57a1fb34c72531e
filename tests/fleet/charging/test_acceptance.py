"""Robots that may accept an order: those that reach a dock afterwards without their own battery plan saying so."""

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from fleet.charging.acceptance import HELD_UP_S, Answer, Charge, accepts, goes_on
from fleet.charging.energy import Use, assumed_rates
from fleet.charging.levels import Thresholds

RATES = replace(assumed_rates(7200.0, 19_000.0, 0.2), stretches=50, driving_var=0.003, standing_var=0.003)
THRESHOLDS = Thresholds()
SHORT, LONG, BACK = Use(200.0, 1200.0), Use(900.0, 5400.0), Use(70.0, 400.0)
uses = st.builds(Use, st.floats(0, 800), st.floats(0, 6000))


def test_enough_is_what_leaves_its_own_battery_plan_nothing_to_do() -> None:
    needed = accepts(Charge(0.9, RATES), SHORT, BACK, THRESHOLDS).needed
    assert needed == THRESHOLDS.low + RATES.at_most(SHORT + BACK)
    assert accepts(Charge(needed, RATES), SHORT, BACK, THRESHOLDS).answer is Answer.YES
    assert accepts(Charge(needed - 0.001, RATES), SHORT, BACK, THRESHOLDS).answer is Answer.CHARGE_FIRST


def test_a_longer_way_to_the_dock_needs_more() -> None:
    near, far = (accepts(Charge(0.5, RATES), SHORT, way, THRESHOLDS) for way in (BACK, Use(300.0, 1800.0)))
    assert near.is_accepted and not far.is_accepted


def test_in_a_dock_it_begins_nothing_that_its_own_program_would_not_begin() -> None:
    charge = Charge(0.5, RATES)
    assert accepts(charge, SHORT, BACK, THRESHOLDS).is_accepted
    docked = accepts(replace(charge, docked=True), SHORT, BACK, THRESHOLDS)
    assert (docked.answer, docked.needed) == (Answer.CHARGE_FIRST, 0.53)


def test_who_charges_until_full_by_its_own_plan_takes_nothing_on() -> None:
    assert not accepts(Charge(0.98, RATES, docked=True, until_full=True), SHORT, BACK, THRESHOLDS).is_accepted


def test_what_is_more_than_one_charge_is_begun_full_and_only_if_its_parts_can_be_done() -> None:
    assert accepts(Charge(0.9, RATES), LONG, BACK, THRESHOLDS).answer is Answer.CHARGE_FIRST
    assert accepts(Charge(0.96, RATES), LONG, BACK, THRESHOLDS, [SHORT]).answer is Answer.ON_THE_WAY
    assert accepts(Charge(0.96, RATES), LONG, BACK, THRESHOLDS, [SHORT, LONG]).answer is Answer.TOO_FAR


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


def test_with_more_than_one_charge_before_it_a_robot_charges_at_the_dock_that_it_passes() -> None:
    """Before each leg it would still be let on, and break off far from any dock."""
    leg, to_next = Use(80.0, 400.0), Use(400.0, 2400.0)
    needed = THRESHOLDS.low + RATES.at_most(to_next)
    assert goes_on(Charge(needed - 0.1, RATES), leg, BACK, THRESHOLDS)


@given(st.floats(0, 1), uses, uses, uses)
def test_who_is_accepted_goes_on_at_once_and_more_work_never_needs_less(
    ratio: float, leg: Use, rest: Use, to_dock: Use
) -> None:
    charge = Charge(ratio, RATES)
    verdict = accepts(charge, leg + rest, to_dock, THRESHOLDS)
    assert accepts(charge, leg, to_dock, THRESHOLDS).needed <= verdict.needed + 1e-9
    if verdict.answer is Answer.YES:
        assert goes_on(charge, leg, rest + to_dock, THRESHOLDS)
