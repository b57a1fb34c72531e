"""Settling on a line after a turn, on a floor of geometry alone: tape along the x-axis, worn away in one place."""

import math
from dataclasses import dataclass, replace

import pytest

from robot.drivers.interfaces import BodyShape, LineReading, Odometry, WheelSpeeds
from robot.skills.find_line import over_line, settle
from robot.skills.interfaces import View

TICK_S, LAG_S, TAPE_HALF_MM = 0.02, 0.06, 12.0
SHAPE = BodyShape(sensor_lead_mm=60.0)


@dataclass
class Floor:
    """A robot at (x, y) mm, looking `heading_rad` to the left of the tape, which is worn from `gap[0]` to `gap[1]`."""

    heading_rad: float
    gap: tuple[float, float]
    x_mm: float = 0.0
    y_mm: float = 0.0
    left_mm_s: float = 0.0
    right_mm_s: float = 0.0

    def tape_at(self, ahead_mm: float, left_mm: float) -> bool:
        along, across = math.cos(self.heading_rad), math.sin(self.heading_rad)
        x_mm = self.x_mm + ahead_mm * along - left_mm * across
        y_mm = self.y_mm + ahead_mm * across + left_mm * along
        return abs(y_mm) <= TAPE_HALF_MM and not self.gap[0] < x_mm < self.gap[1]

    def look(self, view: View) -> View:
        apart = SHAPE.diode_spacing_mm
        reading = LineReading(*(self.tape_at(SHAPE.sensor_lead_mm, left) for left in (apart, 0.0, -apart)))
        return replace(view, reading=reading)

    def move(self, view: View, wheels: WheelSpeeds) -> View:
        share = TICK_S / LAG_S
        self.left_mm_s += (wheels.left_mm_s - self.left_mm_s) * share
        self.right_mm_s += (wheels.right_mm_s - self.right_mm_s) * share
        ahead_mm = (self.left_mm_s + self.right_mm_s) / 2 * TICK_S
        turned_rad = (self.right_mm_s - self.left_mm_s) / SHAPE.wheel_base_mm * TICK_S
        self.x_mm += ahead_mm * math.cos(self.heading_rad)
        self.y_mm += ahead_mm * math.sin(self.heading_rad)
        self.heading_rad += turned_rad
        old = view.odometry
        odometry = replace(old, heading_rad=old.heading_rad + turned_rad, travelled_mm=old.travelled_mm + abs(ahead_mm))
        return self.look(replace(view, at_s=view.at_s + TICK_S, odometry=odometry))


def settled(floor: Floor) -> View:
    view = floor.look(View(at_s=0.0, odometry=Odometry()))
    part = settle(view, SHAPE)
    try:
        step = next(part)
        while True:
            assert step.wheels is not None
            view = floor.move(view, step.wheels)
            assert view.at_s < 30
            step = part.send(view)
    except StopIteration as end:
        last: View = end.value
        return last


@pytest.mark.parametrize("aslant_deg", range(-20, 21, 4))
def test_it_looks_along_the_line_that_it_met(aslant_deg: int):
    floor = Floor(math.radians(aslant_deg), gap=(500.0, 520.0))
    view = settled(floor)
    assert over_line(view) and view.reading.centre
    assert abs(floor.heading_rad) < math.radians(14)


@pytest.mark.parametrize("gap_mm", [(48.0, 60.2), (50.0, 61.0), (52.0, 62.0), (52.0, 72.0), (45.0, 65.0)])
@pytest.mark.parametrize("aslant_deg", [-6, 3, 12])
def test_at_the_edge_of_a_worn_place_it_goes_on_until_the_centre_is_over_the_line(
    gap_mm: tuple[float, float], aslant_deg: int
):
    """There an outer diode grazes the tape, and the centre one meets nothing however it turns."""
    floor = Floor(math.radians(aslant_deg), gap_mm)
    view = settled(floor)
    assert view.reading.centre
    assert abs(floor.heading_rad) < math.radians(20)
