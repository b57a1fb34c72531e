"""Notice a camera that gives the same picture again and again: some hang so, and say nothing.

A working sensor never gives two equal pictures: its grain is another in each.
"""

import numpy as np

from robot.drivers.interfaces import Frame

EVERY_PX = 4
"""Equal in each fourth pixel of each fourth row is equal: the rest would only cost time (0.02 ms instead of 0.3)."""
BLANK_LEVELS = 8
"""A covered lens or a dark tunnel may give equal pictures: between their darkest and brightest pixel is less."""


class FrozenPicture:
    """Compares each frame with the one before it."""

    def __init__(self) -> None:
        self._before: Frame | None = None
        self._changed_s = 0.0

    def age_s(self, frame: Frame, now: float) -> float:
        """Seconds since a frame like this first came; 0.0 for a new one, and for one without contrast."""
        sample = frame[::EVERY_PX, ::EVERY_PX].copy()
        before, self._before = self._before, sample
        if before is None or int(np.ptp(sample)) <= BLANK_LEVELS or not np.array_equal(before, sample):
            self._changed_s = now
        return now - self._changed_s
