"""What the firmware does by itself, and what stops it."""

from dataclasses import dataclass
from enum import Enum


class Activity(Enum):
    """What the firmware does by itself."""

    NONE = "none"
    CLEANING = "cleaning"
    DOCKING = "docking"


@dataclass(frozen=True)
class Hazards:
    """What the firmware's own safety looks at."""

    cliff: bool = False
    wheel_drop: bool = False
    charger: bool = False
