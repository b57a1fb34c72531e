"""What things take: ONE table of distributions, fitted to the stepped daemons.

PLACEHOLDERS until it is: speeds from docs/reference/measurements.md (missions on the track take 1.147 times way ÷ 150
mm/s and stops), the rest as `benchmarks/fleet/campus_ground.py` had assumed it.
"""

from dataclasses import dataclass
from random import Random
from typing import Final

from maps import CampusMap
from protocol.parts import Leg, Purpose


@dataclass(frozen=True, slots=True)
class Spread:
    """Log-normal around `median_s`, within bounds."""

    median_s: float
    sigma: float
    at_least_s: float = 0.0
    at_most_s: float = 3600.0

    def draw_s(self, rng: Random) -> float:
        return min(self.at_most_s, max(self.at_least_s, self.median_s * rng.lognormvariate(0.0, self.sigma)))


@dataclass(frozen=True, slots=True)
class Durations:
    """`speed_m_s`, `each_way`, `each_time`: of a corridor in one direction, and of one drive. `loaded`, `received`:
    until a person has come and handed over; in hours without offices `quiet` times as long."""

    speed_m_s: float = 0.2
    each_way: tuple[float, float] = (1.06, 1.73)
    """Times length ÷ speed."""
    each_time: float = 0.2
    turn: Spread = Spread(4.0, 0.3, 1.0, 30.0)
    dock: Spread = Spread(25.0, 0.3, 10.0, 120.0)
    undock: Spread = Spread(10.0, 0.2, 5.0, 30.0)
    loaded: Spread = Spread(45.0, 0.6, 5.0)
    received: Spread = Spread(60.0, 0.6, 5.0)
    quiet: float = 2.0
    reached_in_s: float = 5.0
    """People reach into the box after the code was read."""
    boot: Spread = Spread(40.0, 0.2, 20.0, 120.0)
    repair: Spread = Spread(1200.0, 0.5, 120.0, 2700.0)
    looked_for: Spread = Spread(2700.0, 0.3, 900.0, 5400.0)
    """From falling silent until a person has found it."""


FITTED: Final = Durations()
OFFICE_H: Final = range(8, 18)


class Taking:
    """Draws what each thing takes. The paces of ways are the same for the same seed, whatever robots do."""

    def __init__(self, campus: CampusMap, table: Durations, seed: int) -> None:
        self.table = table
        rng = Random(f"{seed} paces")
        ways = [(start, end) for one in campus.corridors for start, end in ((one.a, one.b), (one.b, one.a))]
        self._usual_s = {
            (start, end): campus.corridor(start, end).length_m / table.speed_m_s * rng.uniform(*table.each_way)
            for start, end in ways
        }

    def drive_s(self, leg: Leg, rng: Random) -> float:
        spread = self.table.each_time
        return self._usual_s[leg.from_post, leg.to_post] * rng.uniform(1 - spread, 1 + spread)

    def person_s(self, purpose: Purpose, now_s: float, rng: Random) -> float:
        """Until the mail has changed hands, if the robot waits so long."""
        in_office = int(now_s % 86400 // 3600) in OFFICE_H
        spread = self.table.loaded if purpose is Purpose.LOAD else self.table.received
        return spread.draw_s(rng) * (1.0 if in_office else self.table.quiet)
