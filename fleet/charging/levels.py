"""Levels of charge: four thresholds, with hysteresis."""

from dataclasses import dataclass
from enum import IntEnum
from itertools import pairwise


class Level(IntEnum):
    """Between the thresholds, from below."""

    CRITICAL = 0
    """Below this no work and no plan ever takes a robot."""
    LOW = 1
    """The robot's own battery plan takes it to a dock, whatever it was about."""
    FAIR = 2
    """It works if it is predicted to have enough for that."""
    SUFFICIENT = 3
    """It leaves the dock to another that needs it more."""
    FULL = 4
    """It has nothing to do in the dock."""


@dataclass(frozen=True)
class Thresholds:
    """`low`, `begin` and `hysteresis` are what the robots' own settings `battery.low_ratio`, `start_ratio` and
    `hysteresis_ratio` usually are: service and robot must not mean different things by them."""

    critical: float = 0.10
    low: float = 0.25
    sufficient: float = 0.80
    full: float = 0.95
    begin: float = 0.50
    hysteresis: float = 0.03

    def __post_init__(self) -> None:
        steps = (0.0, self.critical, self.low, self.begin, self.sufficient, self.full, 1.0)
        apart = all(below + self.hysteresis < above for below, above in pairwise(steps[1:]))
        if not (apart and self.critical > 0.0):
            raise ThresholdsMixedUp(
                "The thresholds of charge must rise from critical over low, begin and sufficient to full, "
                f"each further from the next than the hysteresis of {self.hysteresis:.2f}."
            )

    def level(self, ratio: float, before: Level | None = None) -> Level:
        """Down at once, up only when it is clearly above: what was full does not begin to charge again at once."""
        below = (self.critical, self.low, self.sufficient, self.full)
        down_to = sum(ratio >= threshold for threshold in below)
        up_to = sum(ratio >= threshold + self.hysteresis for threshold in below)
        return Level(down_to if before is None else min(down_to, max(before, up_to)))


class ThresholdsMixedUp(ValueError):
    """Thresholds of charge in the wrong order."""
