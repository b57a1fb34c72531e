"""A robot's energy use is learned from past use, and predictions of it hold."""

from random import Random

from hypothesis import given
from hypothesis import strategies as st

from fleet.charging.energy import LEAST_SPENT, Rates, Use, assumed_rates

ASSUMED = assumed_rates(drive_s=7200.0, stand_s=19_000.0, speed_m_s=0.2)


def stretches(rng: Random, number: int, driving: float, standing: float) -> list[tuple[Use, float]]:
    """Ways as robots have them, some with long waits; each costs what it costs, more or less."""
    found = []
    for _ in range(number):
        way_m = rng.uniform(60.0, 300.0)
        use = Use(way_m, way_m / 0.2 + rng.choice([0.0, 60.0, 600.0, 2000.0]))
        true = driving * ASSUMED.per_m * use.way_m + standing * ASSUMED.per_s * use.time_s
        found.append((use, round(true * rng.lognormvariate(0.0, 0.1), 2)))
    return found


def learned(rates: Rates, seen: list[tuple[Use, float]]) -> Rates:
    for use, spent in seen:
        rates = rates.learned(use, spent)
    return rates


def test_a_new_robot_costs_what_was_assumed() -> None:
    assert round(ASSUMED.expected(Use(1440.0, 7200.0)), 6) == 1.0
    assert round(ASSUMED.expected(Use(0.0, 19_000.0)), 6) == 1.0


def test_what_driving_and_standing_cost_is_told_apart() -> None:
    rates = learned(ASSUMED, stretches(Random(1), 80, driving=1.5, standing=0.8))
    assert abs(rates.driving - 1.5) < 0.12
    assert abs(rates.standing - 0.8) < 0.12


def test_a_pack_that_wears_is_followed() -> None:
    rng = Random(2)
    rates = ASSUMED
    for worn in range(20):
        more = 1.0 + 0.02 * worn
        rates = learned(rates, stretches(rng, 10, driving=more, standing=more))
    use = Use(300.0, 2000.0)
    assert abs(rates.expected(use) / (1.4 * ASSUMED.expected(use)) - 1) < 0.08
    assert 1.4 * ASSUMED.expected(use) < rates.at_most(use)


def test_what_is_promised_at_most_is_exceeded_about_as_seldom_as_it_should_be() -> None:
    exceeded = tried = 0
    for seed in range(20):
        rates = ASSUMED
        for use, spent in stretches(Random(seed), 60, driving=1.3, standing=1.1):
            exceeded += spent > rates.at_most(use)
            tried += 1
            rates = rates.learned(use, spent)
    assert 0.002 < exceeded / tried < 0.04


def test_who_is_known_is_promised_more_than_who_is_not() -> None:
    rates = learned(ASSUMED, stretches(Random(3), 40, driving=1.0, standing=1.0))
    use = Use(400.0, 2500.0)
    assert rates.at_most(use) < ASSUMED.at_most(use) - 0.05


def test_one_wild_figure_does_not_turn_everything_over() -> None:
    rates = learned(ASSUMED, stretches(Random(4), 40, driving=1.0, standing=1.0))
    after = rates.learned(Use(100.0, 600.0), 0.9)
    assert after.expected(Use(300.0, 1500.0)) < 1.35 * rates.expected(Use(300.0, 1500.0))
    assert after.margin > rates.margin


@given(
    st.lists(st.tuples(st.floats(0, 5000), st.floats(0, 50_000), st.floats(-0.5, 1.0)), max_size=30),
    st.floats(0, 1000),
    st.floats(0, 10_000),
)
def test_whatever_is_told_costs_stay_costs(told: list[tuple[float, float, float]], way_m: float, time_s: float) -> None:
    rates = learned(ASSUMED, [(Use(way, time), spent) for way, time, spent in told])
    use = Use(way_m, time_s)
    assert 0.0 <= rates.expected(use) <= rates.at_most(use) < 1e6
    assert rates.at_most(use) <= rates.at_most(use + Use(50.0, 300.0)) + 1e-9


def test_what_is_too_short_to_tell_teaches_nothing() -> None:
    assert ASSUMED.learned(Use(1.0, 5.0), LEAST_SPENT / 2) == ASSUMED
