"""Finding the line again: coast, arc, back along the way driven, sweep wider and wider, spiral; then stuck."""

import math

from robot.drivers.interfaces import BodyShape, WheelSpeeds
from robot.skills.interfaces import Done, Failed, Running, View
from robot.skills.script import Part, Script, Scripted, roll, stand, turn_by

COAST_MM = 40.0
ARC_MM = 120.0
ARC = (45.0, 90.0)
"""Slow and fast wheel of the arc towards the side where the line was seen last, mm/s."""
SWEEPS_RAD = tuple(math.radians(degrees) for degrees in (25, 70))
SEARCH_MM_S = 60.0
SWEEP_MM_S = 100.0
SPIRAL_MM_S = 120.0
SPIRAL_FROM_MM, SPIRAL_PITCH_MM, SPIRAL_TURNS = 60.0, 130.0, 3.5
"""Radius at the beginning and growth with each turn: no straight line within half a metre stays unmet."""
ALIGN_RAD = math.radians(95)
"""With the axle over it, a line leads somewhere within a right angle of every heading."""
CLOSE_RAD, WIDEST_RAD = math.radians(25), math.radians(40)
"""How far to the sides a line is looked for that should lie ahead. Branches are a quarter apart on our maps."""
WORN_MM = 35.0
"""So much farther on the tape is not worn any more."""


def over_line(view: View) -> bool:
    """Some diode, but not all of them: everything dark is a dark floor."""
    return any(view.reading) and not all(view.reading)


class FindLine(Scripted):
    """Done when the line is under the sensor, along the way the robot looked before; else line_lost."""

    name = "find_line"
    on_timeout = "line_lost"

    def __init__(
        self,
        shape: BodyShape | None = None,
        side: float = 0.0,
        heading_rad: float | None = None,
        limit_s: float = 180.0,
        looks_anywhere: bool = False,
    ) -> None:
        """`side`: where the line was seen last (left positive); `heading_rad`: its heading then, by odometry.
        `looks_anywhere`: the way it looks is not known. It looks round where it stands first, and any line will do."""
        self._shape = shape or BodyShape()
        self._side = math.copysign(1.0, side) if side else 1.0
        self._heading_rad = heading_rad
        self._looks_anywhere = looks_anywhere
        self.limit_s = limit_s

    def script(self, view: View) -> Script:
        """The ladder, rung by rung; the line is straightened up to on whichever rung it is found."""
        along_rad = view.odometry.heading_rad if self._heading_rad is None else self._heading_rad
        first = self._look_round if self._looks_anywhere else self._stay
        for rung in (first, self._coast, self._arc, self._back, self._sweep, self._spiral):
            view = yield from searching(rung(view))
            if over_line(view):
                along_rad = view.odometry.heading_rad if self._looks_anywhere else along_rad
                view = yield from searching(self._align(view, along_rad))
            if over_line(view):
                return Done()
        return Failed("line_lost")

    def _stay(self, view: View) -> Part:
        """Perhaps it is there already."""
        return stand(view, 0.0)

    def _look_round(self, view: View) -> Part:
        return turn_by(view, self._side * math.tau, SWEEP_MM_S, self._shape, over_line)

    def _coast(self, view: View) -> Part:
        return roll(view, COAST_MM, WheelSpeeds(SEARCH_MM_S, SEARCH_MM_S), over_line)

    def _arc(self, view: View) -> Part:
        return roll(view, ARC_MM, self._bent(1), over_line)

    def _back(self, view: View) -> Part:
        """The arc and the way coasted, backwards: the same wheels with the other sign retrace the same path."""
        forward = self._bent(1)
        view = yield from roll(view, ARC_MM, WheelSpeeds(-forward.left_mm_s, -forward.right_mm_s), over_line)
        if not over_line(view):
            view = yield from roll(view, COAST_MM + 40, WheelSpeeds(-SEARCH_MM_S, -SEARCH_MM_S), over_line)
        return view

    def _sweep(self, view: View) -> Part:
        return sweep(view, self._shape, self._side)

    def _spiral(self, view: View) -> Part:
        """Outwards, towards the side where the line was seen last."""
        from_rad, half = view.odometry.heading_rad, self._shape.wheel_base_mm / 2
        while (turns := abs(view.odometry.heading_rad - from_rad) / math.tau) < SPIRAL_TURNS and not over_line(view):
            radius_mm = SPIRAL_FROM_MM + SPIRAL_PITCH_MM * turns
            inner, outer = SPIRAL_MM_S * (radius_mm - half) / (radius_mm + half), SPIRAL_MM_S
            view = yield Running(WheelSpeeds(inner, outer) if self._side > 0 else WheelSpeeds(outer, inner))
        return (yield from stand(view))

    def _align(self, view: View, along_rad: float) -> Part:
        return align(view, self._shape, along_rad)

    def _bent(self, sign: int) -> WheelSpeeds:
        slow, fast = (sign * speed for speed in ARC)
        return WheelSpeeds(slow, fast) if self._side > 0 else WheelSpeeds(fast, slow)


def sweep(view: View, shape: BodyShape, side: float = 1.0) -> Part:
    """Left and right by growing angles, the side where the line was seen first."""
    for angle in SWEEPS_RAD:
        for turn in (side * angle, -2 * side * angle, side * angle):
            if not over_line(view):
                view = yield from turn_by(view, turn, SWEEP_MM_S, shape, over_line)
    return view


def align(view: View, shape: BodyShape, along_rad: float) -> Part:
    """Look along the line the way it was driven before; the axle comes over the tape first.

    Without that, a robot that met the tape across would follow it back to where it came from.
    """
    off_rad = math.remainder(along_rad - view.odometry.heading_rad, math.tau)
    if abs(off_rad) > math.radians(20):
        view = yield from roll(view, shape.sensor_lead_mm, WheelSpeeds(SEARCH_MM_S, SEARCH_MM_S))
        view = yield from turn_by(view, off_rad, SEARCH_MM_S, shape)
    return (yield from settle(view, shape, ALIGN_RAD))


def searching(part: Part) -> Part:
    """The same, marked as a search so that the loop counts it."""
    try:
        item = next(part)
        while True:
            item = part.send((yield Running(item.wheels, item.requests, searching=True)))
    except StopIteration as end:
        view: View = end.value
        return view


def settle(view: View, shape: BodyShape, widest_rad: float = WIDEST_RAD) -> Part:
    """Turn on the spot until the centre diode is over the line, looking a little to both sides for it.

    A little farther on as well, before it looks wider: the tape may be worn just here, and what lies farther to the
    side may be a branch.
    """
    from_rad = view.odometry.heading_rad
    for ahead_mm, reach_rad in ((0.0, CLOSE_RAD), (WORN_MM, CLOSE_RAD), (0.0, widest_rad)):
        if ahead_mm:
            view = yield from roll(view, ahead_mm, WheelSpeeds(SEARCH_MM_S, SEARCH_MM_S), _centred)
        view = yield from _look_to_both_sides(view, shape, from_rad, reach_rad)
        view = yield from _centre(view, shape)
        if _centred(view):
            break
    return view


def _centred(view: View) -> bool:
    return over_line(view) and view.reading.centre


def _look_to_both_sides(view: View, shape: BodyShape, from_rad: float, reach_rad: float) -> Part:
    for goal_rad in (from_rad + reach_rad, from_rad - reach_rad, from_rad):
        if not over_line(view):
            view = yield from turn_by(view, goal_rad - view.odometry.heading_rad, SWEEP_MM_S, shape, over_line)
    return view


def _centre(view: View, shape: BodyShape) -> Part:
    """From an outer diode to the centre one. Where that finds nothing it was the edge of a worn place."""
    if over_line(view) and not _centred(view):
        side = 1.0 if view.reading.left else -1.0
        view = yield from turn_by(view, side * 0.5, SEARCH_MM_S, shape, _centred)
    return view
