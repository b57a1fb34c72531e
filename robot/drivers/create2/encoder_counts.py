"""Counts that do not leap: a base that was reset counts from anywhere, and a damaged frame may pass its checksum."""

from robot.drivers.create2.odometry import counts_between

FASTEST_COUNTS_S = 700.0
"""300 mm/s: half as much again as the base is ever told, for the time of a silence."""
SPARE_COUNTS = 120
"""Within a frame of 15 ms: 3.5 m/s, for a person who pushes it."""


class EncoderCounts:
    """Judges the counts of each frame, and gives them on so that a new zero of the base is no movement."""

    def __init__(self) -> None:
        self._last: tuple[int, int] | None = None
        self._last_s = 0.0
        self._doubted: tuple[int, int] | None = None
        self._offsets = (0, 0)
        self._was_reset = False

    def base_was_reset(self) -> None:
        """The next counts begin anywhere, however near that looks."""
        self._was_reset = True

    def accept(self, left: int, right: int, now: float) -> tuple[int, int] | None:
        """The counts to believe, 16 bits with sign; None: a leap. Two leaps to one place are a new zero."""
        counts = (left, right)
        if self._was_reset and self._last is not None:
            self._begin_anew(self._last, counts)
            self._last = counts
        self._was_reset = False
        if self._last is not None and not _near(self._last, counts, now - self._last_s):
            if self._doubted is None or not _near(self._doubted, counts, now - self._last_s):
                self._doubted = counts
                return None
            self._begin_anew(self._last, counts)
        self._last, self._last_s, self._doubted = counts, now, None
        return _moved(left, self._offsets[0]), _moved(right, self._offsets[1])

    def _begin_anew(self, old: tuple[int, int], new: tuple[int, int]) -> None:
        self._offsets = (
            self._offsets[0] + counts_between(new[0], old[0]),
            self._offsets[1] + counts_between(new[1], old[1]),
        )


def _near(old: tuple[int, int], new: tuple[int, int], duration_s: float) -> bool:
    most = SPARE_COUNTS + FASTEST_COUNTS_S * duration_s
    return all(abs(counts_between(before, after)) <= most for before, after in zip(old, new, strict=True))


def _moved(count: int, offset: int) -> int:
    return (count + offset + 32768) % 65536 - 32768
