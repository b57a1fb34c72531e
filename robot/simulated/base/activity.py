"""Activities of the firmware, and what stops them."""

from dataclasses import dataclass
from enum import Enum


class Activity(Enum):
    """An activity of the firmware."""

    NONE = "none"
    CLEANING = "cleaning"
    DOCKING = "docking"


@dataclass(frozen=True)
class Hazards:
    """What the firmware's own safety looks at."""

    cliff: bool = False
    wheel_drop: bool = False
    charger: bool = False
