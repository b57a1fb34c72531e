"""Millimetres per count from a way that a technician measures, and the wheel base from full turns over the line."""

import math
from collections.abc import Callable
from itertools import pairwise

from robot.drivers.interfaces import WheelSpeeds
from robot.ops.calibration.rig import CalibrationFailed, Rig

DRIVE = WheelSpeeds(100, 100)
SPIN = WheelSpeeds(-60, 60)
SHORTEST_MM = 300.0
LATEST_PER_TURN_S = 30.0
CENTRE = 1
"""Of left, centre, right."""


def roll(rig: Rig, length_mm: float, mm_per_count: float) -> float:
    """Drive straight on for about so long; how much the wheels have counted. Raises CalibrationFailed."""
    if length_mm < SHORTEST_MM:
        raise CalibrationFailed(f"{length_mm:g} mm are too short to measure by: take {SHORTEST_MM:g} at least.")
    rig.wake()
    before, wanted = rig.counts.ahead, length_mm / mm_per_count
    rig.run(DRIVE, lambda: rig.counts.ahead - before >= wanted, length_mm / 40, "The wheels do not turn.")
    return rig.counts.ahead - before


def mm_per_count(measured_mm: float, counts: float) -> float:
    """Raises CalibrationFailed when the two do not belong together."""
    if measured_mm <= 0 or counts <= 0:
        raise CalibrationFailed("Neither the way nor the counts can be nothing.")
    return measured_mm / counts


def spin(rig: Rig, level: Callable[[], int], turns: int) -> float:
    """Counts (right minus left) of so many full turns on the spot, the axle's middle over the line.

    The centre diode crosses the tape twice a turn; the middles of these crossings are where turns begin and end, so
    that it does not matter how the robot stands at first. Raises CalibrationFailed.
    """
    rig.wake()
    crossings = Crossings(level)
    needed = 2 * turns + 1
    rig.run(
        SPIN,
        lambda: len(crossings.seen(rig.counts.turned)) >= needed,
        LATEST_PER_TURN_S * (turns + 1),
        "The line was not crossed twice in each turn: put the middle of the axle over a straight piece of it.",
    )
    middles = crossings.middles
    gaps = [after - before for before, after in pairwise(middles)]
    if max(gaps) > 1.5 * min(gaps):
        raise CalibrationFailed("The turns are uneven: is the axle's middle over the line, and the floor clean?")
    return middles[2 * turns] - middles[0]


def wheel_base_mm(turned_counts: float, turns: int, mm_per_count: float) -> float:
    return turned_counts * mm_per_count / (math.tau * turns)


class Crossings:
    """Where the centre diode met the tape, in counts: the lesser share of a turn lies on it, whatever its level."""

    def __init__(self, level: Callable[[], int]) -> None:
        self._level = level
        self._edges: list[float] = []
        self._before: int | None = None
        self.middles: list[float] = []

    def seen(self, counts: float) -> list[float]:
        """After one more look."""
        level = self._level()
        if self._before is not None and level != self._before:
            self._edges.append(counts)
            self.middles = self._paired()
        self._before = level
        return self.middles

    def _paired(self) -> list[float]:
        """Edges come in twos; the narrow gaps between them are the tape. Which these are shows after three."""
        edges = self._edges
        if len(edges) < 3:
            return []
        first = 0 if edges[1] - edges[0] < edges[2] - edges[1] else 1
        ends = edges[first:]
        return [(a + b) / 2 for a, b in zip(ends[::2], ends[1::2], strict=False)]
