"""What things take: ONE table of distributions.

Moves are fitted to whole robots, daemon and all, by their true poses: `takes` in the figures of

    python -m benchmarks.fleet stepped --robots 2 --minutes 25 --scale 0.3 --seed 1
    python -m benchmarks.fleet stepped --robots 2 --minutes 30 --scale 0.1 --seed 2 --waiting 1

There a crossing is 0.4 m around its post, 2 s of driving. People, boots and repairs are assumed.
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
    each_way: tuple[float, float] = (1.024, 1.054)
    """Times length ÷ speed: 5.12 to 5.27 s for each metre."""
    each_time: float = 0.01
    out_of_bay: Spread = Spread(7.5, 0.02, 7.0, 9.0)
    """Round, and over the spur to the post: 5.5 s, and 2 s on the crossing."""
    turn: Spread = Spread(1.9, 0.2, 1.0, 4.0)
    """At a post, out of a bay or into one: over the crossing it takes 5.3 to 6.4 s."""
    straight_on: Spread = Spread(1.2, 0.4, 0.6, 4.0)
    """With a turn, where the line has a corner: over the crossing it takes 4.6 to 6.1 s."""
    into_corridor: Spread = Spread(3.0, 0.1, 2.5, 5.0)
    """From the post until the robot says that it is off the crossing: 0.6 to 1.4 s after it is."""
    to_crossing: Spread = Spread(3.0, 0.25, 1.5, 20.0)
    """From where it waits to the post."""
    into_bay: Spread = Spread(5.4, 0.02, 5.0, 7.0)
    """From the post until it stands: 2 s on the crossing, and 3.4 s."""
    asks_before_m: float = 2.0
    """Before it comes to where it would wait it asks for what comes after the crossing."""
    turn_back: Spread = Spread(2.5, 0.2, 2.0, 5.0)
    """In a bay the same takes 2.1 s."""
    dock: Spread = Spread(6.3, 0.1, 5.0, 15.0)
    """Of the 9.7 s in a bay with a dock."""
    undock: Spread = Spread(3.6, 0.1, 3.0, 8.0)
    """Of the 9.1 s out of one."""
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
