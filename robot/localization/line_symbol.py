"""The line as the agent perceives it: five words, with hysteresis in ticks and in travel."""

from dataclasses import dataclass, replace
from enum import StrEnum

from robot.drivers.interfaces import LineReading


class LineSymbol(StrEnum):
    """The paper's words for what the three diodes see."""

    CENTER = "center"
    LEFT = "left"
    RIGHT = "right"
    ACROSS = "across"
    LOST = "lost"


PATTERNS = {
    "101": LineSymbol.CENTER,
    "110": LineSymbol.RIGHT,
    "100": LineSymbol.RIGHT,
    "011": LineSymbol.LEFT,
    "001": LineSymbol.LEFT,
    "000": LineSymbol.ACROSS,
    "111": LineSymbol.LOST,
    "010": LineSymbol.LOST,
}
"""Pattern (left, centre, right; 0 = over the line) to word, as the paper's prototype had it."""
_BY_READING = {LineReading(*(digit == "0" for digit in pattern)): word for pattern, word in PATTERNS.items()}

LOST_AFTER_MM = 30.0
OFF_TRACK_AFTER_MM = 80.0


@dataclass(frozen=True, slots=True)
class BelievedLineSymbol:
    """The word believed now, and what speaks for another. All distances are odometry's `travelled_mm`."""

    word: LineSymbol = LineSymbol.LOST
    candidate: LineSymbol = LineSymbol.LOST
    since_mm: float = 0.0
    """Where the present run of equal candidates began."""

    def seen(
        self,
        reading: LineReading,
        travelled_mm: float,
        lost_after_mm: float = LOST_AFTER_MM,
        off_track_after_mm: float = OFF_TRACK_AFTER_MM,
    ) -> "BelievedLineSymbol":
        """After one more tick. A word holds from its second tick on; `lost` only after some travel without line."""
        new = _BY_READING[reading]
        if new is not self.candidate:
            return replace(self, candidate=new, since_mm=travelled_mm)
        run_mm = travelled_mm - self.since_mm
        if new is LineSymbol.ACROSS and run_mm > off_track_after_mm:
            # Everything dark for so long is no crossing: the robot stands on a dark floor.
            new = LineSymbol.LOST
        elif new is LineSymbol.LOST and run_mm < lost_after_mm:
            return self
        return self if new is self.word else replace(self, word=new)
