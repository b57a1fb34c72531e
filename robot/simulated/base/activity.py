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
    """Inputs of the firmware's own safety."""

    cliff: bool = False
    wheel_drop: bool = False
    charger: bool = False
