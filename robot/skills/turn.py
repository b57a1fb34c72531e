"""Turning on the spot by an angle that the map gives, then settling on the line that begins there."""

import math

from ..drivers.interfaces import BodyShape
from .find_line import over_line, settle
from .interfaces import Done, Failed, View
from .script import Script, Scripted, turn_by

SMALLEST_RAD = math.radians(5)


class Turn(Scripted):
    """Done when the line is under the centre diode; line_lost when there is none within 40°."""

    name = "turn"

    def __init__(
        self, angle_rad: float, shape: BodyShape | None = None, speed_mm_s: float = 140.0, limit_s: float = 30.0
    ) -> None:
        """Left is positive."""
        self._angle_rad, self._shape, self._speed_mm_s = angle_rad, shape or BodyShape(), speed_mm_s
        self.limit_s = limit_s

    def script(self, view: View) -> Script:
        """Turn, then look a little to both sides for the line."""
        if abs(self._angle_rad) > SMALLEST_RAD:
            view = yield from turn_by(view, self._angle_rad, self._speed_mm_s, self._shape)
        view = yield from settle(view, self._shape)
        return Done() if over_line(view) else Failed("line_lost")
