"""Batteries as they are, for robots that are simulated: nothing of this is known to what is tested.

Assumed: 3000 mAh at 14.4 V; a robot that drives all the time draws 1500 mA, one that stands 550 mA (base, computer,
camera); a charger gives 1250 mA until the pack is nearly full, and then ever less. So two hours of driving, five and a
half of standing, three hours to fill.
"""

from dataclasses import dataclass
from math import exp
from random import Random
from typing import Final

CAPACITY_MAH: Final = 3000.0
DRIVING_MA: Final = 1500.0
STANDING_MA: Final = 550.0
CHARGER_MA: Final = 1250.0
WEAR_PER_DAY: Final = 0.004


@dataclass
class Pack:
    """One robot's. `draw`: how much more than assumed it takes for driving; `rough`: how much that differs from way to
    way. What it says of its charge is rounded, and says 0.0 when it is empty."""

    capacity_mah: float
    charger_ma: float
    draw: float
    knee: float
    rough: float
    rng: Random
    ratio: float = 1.0
    charged: float = 0.0
    """So many times it was filled, all told."""

    @property
    def told(self) -> float:
        return round(self.ratio, 2)

    def stand(self, time_s: float) -> None:
        self._draw(STANDING_MA, time_s)

    def drive(self, time_s: float) -> None:
        self._draw(STANDING_MA, time_s)
        self._draw((DRIVING_MA - STANDING_MA) * self.draw * self.rng.lognormvariate(0.0, self.rough), time_s)

    def charge(self, time_s: float) -> None:
        before = self.ratio
        per_s = self.charger_ma / self.capacity_mah / 3600.0
        even_s = min(time_s, max(0.0, self.knee - self.ratio) / per_s)
        self.ratio += even_s * per_s
        slow_s = (1 - self.knee) / per_s
        self.ratio = 1 - (1 - self.ratio) * exp(-(time_s - even_s) / slow_s)
        self.charged += self.ratio - before

    def wear(self, days: float) -> None:
        self.capacity_mah *= (1 - WEAR_PER_DAY) ** days

    def _draw(self, current_ma: float, time_s: float) -> None:
        self.ratio = max(0.0, self.ratio - current_ma * time_s / 3600.0 / self.capacity_mah)


def some_pack(rng: Random) -> Pack:
    """New or worn, on a robot that drives lightly or not."""
    return Pack(
        capacity_mah=CAPACITY_MAH * rng.uniform(0.7, 1.0),
        charger_ma=CHARGER_MA * rng.uniform(0.9, 1.05),
        draw=rng.uniform(0.8, 1.3),
        knee=rng.uniform(0.8, 0.9),
        rough=0.12,
        rng=rng,
        ratio=rng.uniform(0.5, 1.0),
    )
