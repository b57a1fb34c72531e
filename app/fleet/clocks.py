"""Robots' clocks: order never depends on them, but what people read does, so their times are put right for display."""

from datetime import datetime, timedelta
from typing import Final

NOISE_S: Final = 30.0
"""So little may be the delay of a hello, on a scaled clock above all: left as it is, so that times stay in order."""


def put_right(at: datetime, off_s: float) -> datetime:
    """A robot's time as the service's clock would have said it; `off_s` is how far the robot's clock is ahead."""
    return at - timedelta(seconds=off_s) if abs(off_s) > NOISE_S else at
