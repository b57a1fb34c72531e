"""The distance to the post ahead, from every sighting of its marker on the way there."""

import math
from dataclasses import replace

from maps import CampusMap
from robot.drivers.interfaces import Odometry
from robot.localization.approach import arrival_heading_rad, post_ahead_mm
from robot.localization.expected import OWN_POST_MM, Expected, hangs_beside_this_line
from robot.skills.interfaces import View

SHARP_MM = 40.0
"""The nearer to abreast the marker is, the less its distance ahead depends on how the camera was mounted."""
BESIDE_MM = 300.0
"""A post that lies so far beside the way after a search is not ahead any more."""
ANOTHER_RAD = math.radians(35)
"""A marker turned farther from the robot hangs beside another line to the same post, or is seen from a search."""


class PostAhead:
    """`name` is the post whose marker has been seen; its place is kept in odometry's frame, through searches too."""

    def __init__(
        self,
        campus: CampusMap,
        leaving: str | None,
        begin: Odometry,
        now: float,
        sighted: tuple[str, float] | None = None,
        expected: Expected | None = None,
    ) -> None:
        """`sighted`: the post whose marker was seen before, and where it is by odometry's `ahead_mm`: from so near that
        its marker may not come into sight again. `expected`: which may be read; None: any."""
        self._campus, self._leaving, self._begin = campus, leaving, begin
        self._expected = expected or Expected()
        self.foreign = self._expected.foreign
        """A marker was read that cannot be here: it may not be where it believes to be."""
        self._sighted_s = now
        self.name: str | None = None
        self.supposed = False
        """No marker tells of it: it is where the map says."""
        self._at_mm = self._weight = 0.0
        self._point = (0.0, 0.0)
        if sighted is not None:
            to_go_mm = sighted[1] - begin.ahead_mm
            self._take(sighted[0], begin, to_go_mm, 1 / (SHARP_MM + abs(to_go_mm)) ** 2, 0.0)

    def look(self, view: View, line_heading: float) -> None:
        """Take in a new sighting. `line_heading`: where the line leads, in radians left of where the robot looks."""
        seen = view.post
        if seen is None or seen.at_s <= self._sighted_s or seen.text not in self._campus.posts:
            return
        self._sighted_s = seen.at_s
        if self._still_leaving(seen.text, view.odometry) or abs(seen.turned_rad or 0.0) > ANOTHER_RAD:
            return
        # A robot that looks aslant sees a marker beside it too early or too late: along the line counts.
        along_mm = seen.ahead_mm * math.cos(line_heading) + seen.left_mm * math.sin(line_heading)
        heading = arrival_heading_rad(self._campus, self._leaving, seen.text)
        ahead_mm = post_ahead_mm(self._campus, replace(seen, ahead_mm=along_mm), heading)
        if ahead_mm is None:
            return
        at_mm, disturbed = view.post_odometry.ahead_mm + ahead_mm, view.find_line_episodes + view.bumps
        if not self._expected.allows(seen.text, at_mm, disturbed):
            self.foreign = self.foreign or hangs_beside_this_line(self._campus, seen)
        elif self.supposed or self.name in (None, seen.text):
            self.foreign = False
            self._take(seen.text, view.post_odometry, ahead_mm, 1 / (SHARP_MM + abs(along_mm)) ** 2, line_heading)

    def suppose(self, post: str, at_mm: float) -> None:
        """Its marker cannot be read. One that is read all the same counts at once, and alone."""
        self.name, self._at_mm, self._weight, self.supposed = post, at_mm, 0.0, True

    def _take(self, post: str, here: Odometry, ahead_mm: float, weight: float, line_heading: float) -> None:
        if post != self.name:
            self.name, self._weight = post, 0.0
        self.supposed = False
        self._weight += weight
        self._at_mm += (here.ahead_mm + ahead_mm - self._at_mm) * weight / self._weight
        along_rad, to_go_mm = here.heading_rad + line_heading, self._at_mm - here.ahead_mm
        self._point = (here.x_mm + to_go_mm * math.cos(along_rad), here.y_mm + to_go_mm * math.sin(along_rad))

    def _still_leaving(self, post: str, here: Odometry) -> bool:
        """Near the post it set out from, and not on the way back to it."""
        begin = self._begin
        near = math.hypot(here.x_mm - begin.x_mm, here.y_mm - begin.y_mm) < OWN_POST_MM
        return post == self._leaving and near and math.cos(here.heading_rad - begin.heading_rad) > 0

    def to_go_mm(self, here: Odometry) -> float | None:
        """Negative when the axle is beyond it; None while no post is in sight."""
        return self._at_mm - here.ahead_mm if self.name else None

    def after_search(self, here: Odometry) -> None:
        """The way searched was no way along the line: what is left follows from where the post lies."""
        if self.name is None or self.supposed:
            return
        self._weight = 0.0  # the next sighting counts alone: it is nearer, and the way to it was no search
        dx, dy = self._point[0] - here.x_mm, self._point[1] - here.y_mm
        along, across = math.cos(here.heading_rad), math.sin(here.heading_rad)
        if abs(dy * along - dx * across) > BESIDE_MM:
            self.name = None
        else:
            self._at_mm = here.ahead_mm + dx * along + dy * across
