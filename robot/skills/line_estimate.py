"""Where the line is under the robot: offset, heading and curvature, from encoders and the edges of the tape.

Three diodes on the axle would see the offset but not the heading; the wheels tell how both change as the robot moves.
The estimate is a Kalman filter of three states: between edges it only predicts, and an edge that passes under a diode
is a measurement good to two millimetres.
"""

import math
from dataclasses import dataclass, field
from typing import NamedTuple

from robot.drivers.interfaces import BodyShape, LineReading

EDGE_SIGMA_MM = 2.0
OFFSET_NOISE_MM2_PER_MM = 0.01
HEADING_NOISE_PER_MM = 4e-6
INSIDE_DOUBT = 3.0
"""Reads between two edges agree with each other, not with the truth: they pull to the middle only weakly."""
START_OFFSET_MM2, START_HEADING, START_CURVATURE = 15.0**2, 0.25**2, 0.0005**2
STEEPEST = 0.9
"""Headings beyond this are no longer a line that is followed."""
MAX_CURVATURE_PER_MM = 1 / 180

Interval = tuple[float, float]


class Gains(NamedTuple):
    """Constants that depend on the diodes' distance ahead of the axle."""

    lead_mm: float
    look_ahead_mm: float
    """The follower steers for the line so far ahead of the axle."""
    straight_look_ahead_mm: float
    """The same on a straight line that it is well on."""
    curvature_noise_per_mm: float
    """How much the line's curvature may change with every mm; less of it misses tight bends, more of it sways."""


GAINS = (Gains(0.0, 90.0, 90.0, 1e-8), Gains(30.0, 80.0, 80.0, 3e-8), Gains(50.0, 70.0, 210.0, 7e-8))
"""From the lead of each row on. Tuned on bends of 200 to 600 mm radius with 1 % flipped reads and gaps of 20 mm, on
seeds from 1000 on (benchmarks/body/line.py)."""


def gains(lead_mm: float) -> Gains:
    """The row for this lead."""
    return max(row for row in GAINS if row.lead_mm <= lead_mm)


def line_intervals(shape: BodyShape) -> dict[LineReading, Interval]:
    """Where the middle of the tape can be (mm to the left of the centre diode) for each reading that tells."""
    apart, half = shape.diode_spacing_mm, shape.tape_width_mm / 2
    inner = abs(apart - half)
    readings = {
        LineReading(False, True, False): (-inner, inner),
        LineReading(True, True, False): (apart - half, half),
        LineReading(True, False, False): (max(half, apart - half), apart + half),
        LineReading(False, True, True): (-half, half - apart),
        LineReading(False, False, True): (-apart - half, min(-half, half - apart)),
    }
    return {reading: ends for reading, ends in readings.items() if ends[0] < ends[1]}


@dataclass
class LineEstimate:
    """Offset of the line from the axle's centre (mm, left positive), its heading (rad) and curvature (1/mm)."""

    shape: BodyShape
    offset_mm: float = 0.0
    heading: float = 0.0
    curvature: float = 0.0
    _p: list[float] = field(default_factory=lambda: [START_OFFSET_MM2, 0.0, 0.0, START_HEADING, 0.0, START_CURVATURE])
    """Upper triangle of the covariance: oo, oh, oc, hh, hc, cc."""

    def __post_init__(self) -> None:
        self._intervals = line_intervals(self.shape)
        self._before: Interval | None = None
        self._curvature_noise = gains(self.shape.sensor_lead_mm).curvature_noise_per_mm

    def move(self, ahead_mm: float, turned_rad: float) -> None:
        """The robot went on: the line moves under it."""
        middle = self.heading - turned_rad / 2 + self.curvature * ahead_mm / 2
        self.offset_mm += ahead_mm * middle
        self.heading += self.curvature * ahead_mm - turned_rad
        d, size = ahead_mm, abs(ahead_mm)
        oo, oh, oc, hh, hc, cc = self._p
        # F = [[1, d, d²/2], [0, 1, d], [0, 0, 1]]
        half = d * d / 2
        new_oo = oo + 2 * d * oh + 2 * half * oc + d * d * hh + 2 * d * half * hc + half * half * cc
        new_oh = oh + d * oc + d * hh + d * d * hc + half * hc + half * d * cc
        new_oc = oc + d * hc + half * cc
        self._p = [
            new_oo + OFFSET_NOISE_MM2_PER_MM * size,
            new_oh,
            new_oc,
            hh + 2 * d * hc + d * d * cc + HEADING_NOISE_PER_MM * size,
            hc + d * cc,
            cc + self._curvature_noise * size,
        ]

    def see(self, reading: LineReading, within_mm: float = math.inf) -> None:
        """Take in what the diodes say: an edge that has just passed, or a side on which the estimate must not be.

        A line farther than `within_mm` from where this one should be is another.
        """
        interval = self._intervals.get(reading)
        if interval and self._off_mm(interval) > within_mm:
            return
        if interval is None:
            self._slipped_out(reading)
            self._before = None
            return
        before, self._before = self._before, interval
        at = self.at(self.shape.sensor_lead_mm)
        low, high = interval
        if before is not None and before != interval:
            edge = high if before[0] >= high - 0.1 else low if before[1] <= low + 0.1 else None
            if edge is not None:
                self._correct(edge, EDGE_SIGMA_MM)
                return
        if not low <= at <= high:
            self._correct(min(max(at, low), high), EDGE_SIGMA_MM)
        else:
            sigma_mm = (high - low) / 3.5
            self._correct((low + high) / 2, sigma_mm if before is None else INSIDE_DOUBT * sigma_mm)

    def _off_mm(self, interval: Interval) -> float:
        at = self.at(self.shape.sensor_lead_mm)
        return max(interval[0] - at, at - interval[1], 0.0)

    def _slipped_out(self, reading: LineReading) -> None:
        """Nothing lit just after an outer diode alone: the line went out on that side (a worn place would rather come
        while it runs under the centre)."""
        outermost = self.shape.diode_spacing_mm + self.shape.tape_width_mm / 2
        if self._before is not None and not any(reading) and outermost in (abs(self._before[0]), abs(self._before[1])):
            self._correct(outermost if self._before[1] == outermost else -outermost, EDGE_SIGMA_MM)

    def at(self, ahead_mm: float) -> float:
        """Where the line is so far ahead of the axle, mm to the left."""
        return self.offset_mm + ahead_mm * (self.heading + self.curvature * ahead_mm / 2)

    def _correct(self, measured_mm: float, sigma_mm: float) -> None:
        """One scalar measurement of the line under the diodes: H = [1, lead, lead²/2]."""
        lead = self.shape.sensor_lead_mm
        half = lead * lead / 2
        oo, oh, oc, hh, hc, cc = self._p
        to_o, to_h, to_c = oo + lead * oh + half * oc, oh + lead * hh + half * hc, oc + lead * hc + half * cc
        spread = to_o + lead * to_h + half * to_c + sigma_mm * sigma_mm
        error = measured_mm - self.at(lead)
        self.offset_mm += to_o / spread * error
        self.heading = min(max(self.heading + to_h / spread * error, -STEEPEST), STEEPEST)
        curvature = self.curvature + to_c / spread * error
        self.curvature = min(max(curvature, -MAX_CURVATURE_PER_MM), MAX_CURVATURE_PER_MM)
        self._p = [
            oo - to_o * to_o / spread,
            oh - to_o * to_h / spread,
            oc - to_o * to_c / spread,
            hh - to_h * to_h / spread,
            hc - to_h * to_c / spread,
            cc - to_c * to_c / spread,
        ]
