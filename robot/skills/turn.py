"""Turning on the spot by an angle that the map gives, then settling on the line that begins there."""

import math

from robot.drivers.interfaces import BodyShape, Odometry, WheelSpeeds
from robot.skills.find_line import align, over_line, settle
from robot.skills.interfaces import Done, Failed, View
from robot.skills.script import Part, Script, Scripted, roll, turn_by

SMALLEST_RAD = math.radians(5)
PUSHED_MM = 30.0
BACK_MM_S, ROLLS_ON_MM = 80.0, 5.0
BESIDE_RAD, BESIDE_MM = math.radians(55), 90.0
"""How a line beside the post is looked for: up to 12 cm to each side, and never along the line it came by."""


class Turn(Scripted):
    """Done when the line is under the centre diode; line_lost when there is none within 40°."""

    name = "turn"

    def __init__(
        self, angle_rad: float, shape: BodyShape | None = None, speed_mm_s: float = 200.0, limit_s: float = 30.0
    ) -> None:
        """Left is positive."""
        self._angle_rad, self._shape, self._speed_mm_s = angle_rad, shape or BodyShape(), speed_mm_s
        self.limit_s = limit_s

    def script(self, view: View) -> Script:
        """Turn, then look a little to both sides for the line."""
        begin = view.odometry
        if abs(self._angle_rad) > SMALLEST_RAD:
            view = yield from turn_by(view, self._angle_rad, self._speed_mm_s, self._shape)
        if _gap_mm(begin, view.odometry) > PUSHED_MM:
            view = yield from self._back_to(begin, view)
        view = yield from settle(view, self._shape)
        if not over_line(view):
            view = yield from self._look_beside(view, begin.heading_rad + self._angle_rad)
        return Done() if over_line(view) else Failed("line_lost")

    def _look_beside(self, view: View, goal_rad: float) -> Part:
        """It stands before or beyond the post, whose marker it could not read: the line runs beside it."""
        for side in (1, -1):
            view = yield from self._towards(view, goal_rad + side * BESIDE_RAD)
            view = yield from roll(view, BESIDE_MM, WheelSpeeds(BACK_MM_S, BACK_MM_S), over_line)
            if over_line(view):
                return (yield from align(view, self._shape, goal_rad))
            view = yield from roll(view, BESIDE_MM, WheelSpeeds(-BACK_MM_S, -BACK_MM_S))
        return view

    def _back_to(self, begin: Odometry, view: View) -> Part:
        """A bump made it back off in the middle of the turn: from beside the post no line would be met."""
        goal_rad = begin.heading_rad + self._angle_rad
        here = view.odometry
        there_rad = math.atan2(begin.y_mm - here.y_mm, begin.x_mm - here.x_mm)
        view = yield from self._towards(view, there_rad)
        view = yield from roll(view, _gap_mm(begin, here) - ROLLS_ON_MM, WheelSpeeds(BACK_MM_S, BACK_MM_S))
        return (yield from self._towards(view, goal_rad))

    def _towards(self, view: View, heading_rad: float) -> Part:
        angle_rad = math.remainder(heading_rad - view.odometry.heading_rad, math.tau)
        return turn_by(view, angle_rad, self._speed_mm_s, self._shape)


def _gap_mm(a: Odometry, b: Odometry) -> float:
    return math.hypot(a.x_mm - b.x_mm, a.y_mm - b.y_mm)
