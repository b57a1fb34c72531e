"""Something is ahead, or has touched the bumper: how fast the robot goes, and how long it stands.

What the light bumpers see only makes it slower, and lets it go on sooner; never safer: they overlook dark clothes and
see shiny walls. So it slows down but never stands for them, and in the end it tries again whatever they say.
"""

import math

from robot.skills.interfaces import View

NEAR_SOMETHING_MM_S = 65.0
"""A touch at this speed is a nudge; from cruising it is reached within 40 mm, and the light
bumpers of the simulated world see 120 mm far (docs/explanation/safety.md)."""
MOST_BUMPS = 3
GIVES_WAY_S = (6.0, 8.0)
"""How long it waits after each bump but the last, from where the reflex lets it go on: a person in the way has heard
it and can step aside. The reflex has then stood for 2 s behind the 80 mm that it went back, whatever was ahead."""
FREE_S = 1.0
"""It goes on before that once nothing has been ahead for so long without a break."""
SAME_PLACE_MM = 300.0
"""Touched again within this of the last time by what it has not seen: there is a person whom it does not see."""


def most_mm_s(view: View) -> float:
    """Return how fast it may go for what is ahead."""
    return NEAR_SOMETHING_MM_S if view.base is not None and view.base.something_ahead else math.inf


class GiveWay:
    """From a bump until the robot tries again."""

    def __init__(self, view: View, now: float) -> None:
        self._bumps_before = self._bumps = view.bumps
        self._until_s = self._free_s = now
        self._bumped_at_mm = -math.inf
        self._trusts_lights = True

    def blocked(self, view: View) -> bool:
        """Bumped too often."""
        return view.bumps - self._bumps_before >= MOST_BUMPS

    def stands(self, view: View, now: float) -> bool:
        """Return whether to wait; asked at every tick in which no reflex holds the wheels, and only while not
        `blocked`."""
        if view.bumps > self._bumps:
            self._bumped(view, now)
        if now < self._until_s and not (self._trusts_lights and now - view.something_ahead_s >= FREE_S):
            return True
        self._until_s = self._free_s = now
        return False

    def _bumped(self, view: View, now: float) -> None:
        """The reflex has held the wheels since `_free_s`, the tick of the touch."""
        self._bumps = view.bumps
        self._until_s = now + GIVES_WAY_S[self._bumps - self._bumps_before - 1]
        at_mm = view.odometry.ahead_mm
        again = abs(at_mm - self._bumped_at_mm) < SAME_PLACE_MM
        self._trusts_lights = not again or view.something_ahead_s >= self._free_s
        self._bumped_at_mm = at_mm
