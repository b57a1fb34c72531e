"""A robot's spending, read from its battery samples and ways: stretches that begin and end as it leaves a corridor,
since only then it is known how far it has driven."""

from collections.abc import Iterator, Sequence
from datetime import datetime, timedelta
from typing import Final

from fleet.charging.energy import Rates, Use

WORTH_LEARNING: Final = 0.04
"""Charges are told in whole percents, or nearly."""
BROKEN_OFF: Final = timedelta(minutes=10)
"""A robot that was not heard for so long may have been switched off, carried or charged."""

Sample = tuple[datetime, float, bool]
"""When, how full, and whether it was charging."""
Driven = tuple[datetime, float]
"""When a corridor was left behind, and how long it is."""


def learned_from(rates: Rates, samples: Sequence[Sample], driven: Sequence[Driven]) -> Rates:
    """Both oldest first."""
    for use, spent in stretches(samples, driven):
        rates = rates.learned(use, spent)
    return rates


def stretches(samples: Sequence[Sample], driven: Sequence[Driven]) -> Iterator[tuple[Use, float]]:
    """Ways without a charge or a gap in them, each with what it has cost."""
    begun: tuple[datetime, float] | None = None
    before: datetime | None = None
    way_m, ahead = 0.0, 0
    for at, ratio, charging in samples:
        is_broken_off = charging or before is None or at - before > BROKEN_OFF
        has_left = False
        while ahead < len(driven) and driven[ahead][0] <= at:
            way_m += driven[ahead][1]
            has_left, ahead = True, ahead + 1
        before = at
        if is_broken_off:
            # In a dock; or, after a gap, somewhere: what it is wrong by then is some part of one corridor.
            begun, way_m = (at, ratio), 0.0
        elif has_left and begun is not None and begun[1] - ratio >= WORTH_LEARNING:
            yield Use(way_m, (at - begun[0]).total_seconds()), begun[1] - ratio
            begun, way_m = (at, ratio), 0.0
