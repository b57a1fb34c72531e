"""A robot's own samples and ways are what its costs are learned from."""

from datetime import UTC, datetime, timedelta
from random import Random

from fleet.charging.energy import assumed_rates
from fleet.charging.history import Driven, Sample, learned_from, stretches

BEGIN = datetime(2026, 1, 5, 8, tzinfo=UTC)
ASSUMED = assumed_rates(7200.0, 19_000.0, 0.2)
MINUTE_S = 60.0


def days_of(driving: float, standing: float, rng: Random) -> tuple[list[Sample], list[Driven]]:
    """Corridor after corridor with waits between them, a charge when it is low: a sample each minute."""
    samples, driven = [], []
    at, ratio, charging, left_s, way_m = BEGIN, 1.0, False, 0.0, 0.0
    for _ in range(4000):
        if charging:
            ratio = min(1.0, ratio + 0.006)
            charging = ratio < 1.0
        elif left_s > 0.0:
            left_s -= MINUTE_S
            ratio -= driving * ASSUMED.per_m * 0.2 * MINUTE_S + standing * ASSUMED.per_s * MINUTE_S
            if left_s <= 0.0:
                driven.append((at, way_m))
                charging = ratio < 0.3
        elif rng.random() < 0.1:
            left_s = MINUTE_S * rng.randint(2, 12)
            way_m = 0.2 * left_s
        else:
            ratio -= standing * ASSUMED.per_s * MINUTE_S
        at += timedelta(minutes=1)
        samples.append((at, round(ratio, 2), charging))
    return samples, driven


def test_from_days_of_samples_it_is_known_what_a_robot_spends() -> None:
    rates = learned_from(ASSUMED, *days_of(driving=1.4, standing=0.8, rng=Random(1)))
    assert rates.stretches > 100
    assert abs(rates.driving - 1.4) < 0.12
    assert abs(rates.standing - 0.8) < 0.12


def test_a_charge_and_a_gap_are_no_part_of_any_stretch() -> None:
    samples, driven = days_of(driving=1.0, standing=1.0, rng=Random(2))
    charging = {at for at, _, is_charging in samples if is_charging}
    assert charging
    cut = [one for one in samples if one[0] in charging or one[0].minute % 30 < 15]
    for seen in (samples, cut):
        found = list(stretches(seen, driven))
        assert found
        assert all(0.0 < spent < 0.5 and use.time_s < 4 * 3600.0 for use, spent in found)
    assert all(use.time_s <= 30 * MINUTE_S for use, _ in stretches(cut, driven))


def test_nothing_is_learned_from_nothing() -> None:
    assert learned_from(ASSUMED, [], []) == ASSUMED
    assert learned_from(ASSUMED, [(BEGIN, 0.9, False)], [(BEGIN, 80.0)]) == ASSUMED
