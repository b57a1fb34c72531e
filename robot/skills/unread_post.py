"""A post whose marker cannot be read: where it must be by map and wheels, and what the tape shows there.

A corridor is two per cent longer by worn wheels than by the map: a hand's breadth, from where a turn meets no line.
But at most posts the tape tells more: it ends, a bar lies across, or a branch darkens the outer diode for its width.
"""

import math
from statistics import mean, median

from maps import CampusMap, CampusMapError
from maps.geometry import wrapped
from robot.drivers.interfaces import BodyShape, LineReading, Odometry

SHARE, SLACK_MM = 0.03, 40.0
"""No marker so far beyond the length of the corridor: calibrated wheels and tape measures err by less."""
TAPE_HALF_MM = 12.0
SLIP_SHARE = 0.5
"""Wheels that slip by a third count half as much again as they go."""
ACROSS_LOOKS = 3
"""So often all diodes must be dark to tell where a line crosses or ends at a bar."""
BRANCH_RAD = (math.radians(60), math.radians(120))
"""What leaves the way at such an angle passes under an outer diode within 10 mm of its post."""
STRAIGHT_ON_RAD = math.radians(30)
UNDER_MM, BESIDE_MM, MIDDLE_MM = 10.0, (16.0, 36.0), 4.0
"""The outer diode is dark so far around the middle of a branch, and light so far from it; it is judged once, when the
diodes have gone by its middle as far as counts, give or take the last."""
CLEAR_SHARE = 0.6
"""The diode must be dark in so many more reads under a branch than beside it: a line that sways darkens it longer."""


class UnreadPost:
    """Distances in mm, by `Odometry.ahead_mm` of the axle."""

    def __init__(
        self,
        campus: CampusMap,
        leaving: str | None,
        ahead: str | None,
        begin: Odometry,
        way_left_mm: float | None,
        shape: BodyShape,
    ) -> None:
        """`way_left_mm`: how far it is from `begin` to the post `ahead`, coming from `leaving`; None: not known."""
        self._way_left_mm, self._lead_mm = way_left_mm, shape.sensor_lead_mm
        self._by_map_mm = None if way_left_mm is None else begin.ahead_mm + way_left_mm
        self._left, self._right, self.leads_on = _ways(campus, leaving, ahead)
        self._across_mm: list[float] = []
        self._looks: list[tuple[float, bool]] = []
        self.branch_mm: float | None = None
        """Where a branch was seen that must be the post's."""

    def beyond_mm(self, here: Odometry) -> float:
        """Return how far beyond its place the axle is; below 0 before it."""
        return -math.inf if self._by_map_mm is None else here.ahead_mm - self._by_map_mm

    @property
    def doubt_mm(self) -> float:
        """It lies so far before or beyond that place at most."""
        return SHARE * (self._way_left_mm or 0.0) + SLACK_MM

    @property
    def most_beyond_mm(self) -> float:
        """The robot looks for it so far beyond that place. Where the line ends at the post, the end has to come, and no
        other corridor lies beyond it: if it has not come, the wheels have slipped, and the post lies ahead."""
        return self.doubt_mm if self.leads_on else self.doubt_mm + SLIP_SHARE * (self._way_left_mm or 0.0)

    def may_be_here(self, here: Odometry) -> bool:
        """Return whether the diodes may be over it."""
        return self.beyond_mm(here) > -self.doubt_mm - self._lead_mm

    @property
    def shows(self) -> bool:
        """Return whether the tape tells where it is: it branches off or ends there."""
        return self._left or self._right or not self.leads_on

    def look(self, reading: LineReading, here: Odometry) -> None:
        """One read of the diodes where it may be."""
        if all(reading):
            self._across_mm.append(here.ahead_mm)
        if self._left or self._right:
            at_mm = here.ahead_mm + self._lead_mm
            self._looks.append((at_mm, self.like_branch(reading)))
            if self.branch_mm is None:
                self.branch_mm = self._branch_just_passed(at_mm)

    def like_branch(self, reading: LineReading) -> bool:
        """Return whether the diodes read as with the line in the middle and its branch beside it."""
        beside = (self._left or self._right) and (reading.left or not self._left) and (reading.right or not self._right)
        return all(reading) or (reading.centre and beside)

    def place_mm(self, line_end_mm: float | None) -> float | None:
        """Where it is: at what lies across, at the branch, where the line ends, else by the map. None: not known."""
        if len(self._across_mm) >= ACROSS_LOOKS:
            return median(self._across_mm) + self._lead_mm
        if self.branch_mm is not None:
            return self.branch_mm
        return self._by_map_mm if line_end_mm is None or self.leads_on else line_end_mm

    def _branch_just_passed(self, at_mm: float) -> float | None:
        """The middle of a branch that the diodes have left by now, so far beyond it as it takes to be sure."""
        near = [(mm, dark) for mm, dark in self._looks if mm > at_mm - 2 * BESIDE_MM[1]]
        middle_mm = at_mm - BESIDE_MM[1]
        dark_mm = [mm for mm, dark in near if dark and abs(mm - middle_mm) <= BESIDE_MM[0]]
        if not dark_mm or abs((centre_mm := mean(dark_mm)) - middle_mm) > MIDDLE_MM:
            return None
        under = [dark for mm, dark in near if abs(mm - centre_mm) <= UNDER_MM]
        beside = [dark for mm, dark in near if BESIDE_MM[0] <= abs(mm - centre_mm) <= BESIDE_MM[1]]
        clear = under and beside and mean(under) - mean(beside) >= CLEAR_SHARE
        return centre_mm if clear else None


def _ways(campus: CampusMap, leaving: str | None, ahead: str | None) -> tuple[bool, bool, bool]:
    """Return whether a line branches off there to the left, to the right, and whether one leads straight on."""
    if leaving is None or ahead is None:
        return False, False, True
    try:
        facing_rad = campus.corridor(leaving, ahead).heading_arriving(ahead)
        ways = [corridor for post, corridor in campus.neighbours(ahead) if post.name != leaving]
    except CampusMapError:
        return False, False, True
    turns = [wrapped(corridor.heading_leaving(ahead) - facing_rad) for corridor in ways]
    left = any(BRANCH_RAD[0] <= turn <= BRANCH_RAD[1] for turn in turns)
    right = any(BRANCH_RAD[0] <= -turn <= BRANCH_RAD[1] for turn in turns)
    return left, right, any(abs(turn) <= STRAIGHT_ON_RAD for turn in turns)
