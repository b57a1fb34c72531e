"""Which level is tape, for each pin, and whether left and right are where the settings say: from one swing over it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from robot.core.line_pins import PIN_NAMES
from robot.drivers.interfaces import WheelSpeeds
from robot.ops.calibration.rig import CalibrationFailed, Rig

SWING_COUNTS = 500
"""Right minus left: 54 degrees, so that every diode crosses the tape by far."""
LEFT, RIGHT = WheelSpeeds(-40, 40), WheelSpeeds(40, -40)
LIMIT_S = 12.0


@dataclass(frozen=True)
class LineFound:
    """`swapped`: the pins of left and right are exchanged."""

    line_is_low: bool
    swapped: bool
    widths: tuple[int, int, int]
    """How many counts each diode was over the tape; 0.95 mm of way at 60 mm ahead."""


def swing(rig: Rig, levels: Callable[[], Sequence[int]]) -> LineFound:
    """Turn to the right, then to the left over the tape. Raises CalibrationFailed."""
    rig.wake()
    start = rig.counts.turned
    rig.run(RIGHT, lambda: rig.counts.turned <= start - SWING_COUNTS, LIMIT_S, "The wheels do not turn.")
    seen: list[tuple[int, tuple[int, ...]]] = []

    def look() -> bool:
        seen.append((rig.counts.turned, tuple(levels())))
        return rig.counts.turned >= start + SWING_COUNTS

    rig.run(LEFT, look, 2 * LIMIT_S, "The wheels do not turn.")
    rig.run(RIGHT, lambda: rig.counts.turned <= start, LIMIT_S, "The wheels do not turn.")
    return judged(seen)


def judged(seen: Sequence[tuple[int, Sequence[int]]]) -> LineFound:
    """From (counts, levels of left, centre, right) during the swing to the left. Raises CalibrationFailed."""
    tape = [_tape_level([levels[i] for _, levels in seen], PIN_NAMES[i]) for i in range(3)]
    if len(set(tape)) > 1:
        said = ", ".join(f"{name} {'high' if level else 'low'}" for name, level in zip(PIN_NAMES, tape, strict=True))
        raise CalibrationFailed(f"The diodes do not agree which level is tape: {said}. Wire all three alike.")
    over = [[counts for counts, levels in seen if levels[i] == tape[i]] for i in range(3)]
    left, centre, right = (sum(counts) / len(counts) for counts in over)
    if not min(left, right) < centre < max(left, right):
        raise CalibrationFailed("The tape did not pass the diodes one after the other: are the three in one row?")
    widths = tuple(max(counts) - min(counts) for counts in over)
    # Turning to the left, the left diode meets the tape first.
    return LineFound(tape[0] == 0, left > right, (widths[0], widths[1], widths[2]))


def _tape_level(levels: Sequence[int], name: str) -> int:
    """The rarer one: the swing goes far beyond the tape on both sides."""
    high = sum(levels)
    if high in {0, len(levels)}:
        raise CalibrationFailed(f"The {name} diode did not change: check its wire and pin, and put it over the line.")
    return int(high < len(levels) / 2)
