"""The scale of odometry, real metres per counted metre: learnt from corridor to corridor.

Wheels wear, and are not calibrated every month: two per cent is a hand's breadth in a corridor of five metres, too
much to stop on a post whose marker cannot be read. Where both markers of a corridor were read, the map tells how long
it was.
"""

from dataclasses import dataclass

BELIEVED_MM = 500.0
"""So much way is taken to have been counted right before anything is learnt."""
FORGETS = 0.8
"""What a corridor counts after the next one: wheels change slowly, markers are some millimetres off."""
LIKELY = (0.9, 1.1)
"""Beyond this it is no matter of wheels: a search, a push, a map that is wrong."""


@dataclass(slots=True)
class _Begin:
    at_mm: float
    disturbed: int


class WayScale:
    """`real_per_counted`: mm of the map for every mm of odometry."""

    def __init__(self) -> None:
        self._map_mm = self._counted_mm = BELIEVED_MM
        self._begin: _Begin | None = None

    @property
    def real_per_counted(self) -> float:
        return self._map_mm / self._counted_mm

    def set_out(self, at_mm: float | None, disturbed: int) -> None:
        """`at_mm`: odometry's reading with the axle on the post that it leaves; None where no marker told.
        `disturbed`: searches and bumps so far."""
        self._begin = None if at_mm is None else _Begin(at_mm, disturbed)

    def arrive(self, at_mm: float | None, length_m: float | None, disturbed: int) -> None:
        """`at_mm`: the same at the next post. A corridor with a search or a bump in it tells nothing."""
        begin, self._begin = self._begin, None
        if begin is None or at_mm is None or length_m is None:
            return
        counted_mm = at_mm - begin.at_mm
        if disturbed == begin.disturbed and counted_mm > 0 and LIKELY[0] < 1000 * length_m / counted_mm < LIKELY[1]:
            self._map_mm = FORGETS * self._map_mm + 1000 * length_m
            self._counted_mm = FORGETS * self._counted_mm + counted_mm
