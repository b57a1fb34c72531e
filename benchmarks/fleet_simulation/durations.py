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
    out_of_bay: Spread = Spread(9.0, 0.25, 4.0, 60.0)
    """Round, and over the spur to the post."""
    turn: Spread = Spread(4.0, 0.3, 1.0, 30.0)
    """At a post, out of a bay or into one."""
    straight_on: Spread = Spread(1.0, 0.3, 0.2, 10.0)
    into_corridor: Spread = Spread(6.0, 0.25, 3.0, 30.0)
    """From the post until its body is off the crossing. From the bay until there it takes some 19 s; from where it
    waits before a crossing some 15 s into a bay, and 10 s through."""
    to_crossing: Spread = Spread(3.0, 0.25, 1.5, 20.0)
    """From where it waits to the post."""
    into_bay: Spread = Spread(8.0, 0.25, 4.0, 60.0)
    asks_before_m: float = 2.0
    """Before it comes to where it would wait it asks for what comes after the crossing."""
    turn_back: Spread = Spread(8.0, 0.3, 4.0, 60.0)
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
