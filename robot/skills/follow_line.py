"""Following the line to the next post, and stopping there.

Fifty times a second: where is the line (line_estimate.py), which curve leads back onto it, how fast may that be.
"""

import math
from typing import ClassVar

from maps import CampusMap

from ..drivers.interfaces import STOP, BodyShape, Odometry, WheelSpeeds
from ..navigation.approach import arrival_heading_rad, post_ahead_mm
from .find_line import FindLine, over_line
from .interfaces import Done, Failed, Running, Step, View
from .line_estimate import LineEstimate

LOOK_AHEAD_MM = 80.0
SLOWEST_MM_S = 70.0
CLOSE_MM, SLOW_BY_MM = 8.0, 25.0
"""The speed falls towards the slowest as the line ahead is off by more than the first, by so much."""
CRAWL_MM_S = 40.0
BRAKE_MM_S2 = 150.0
WHEEL_LAG_S = 0.06
LOST_AFTER_MM = 70.0
"""Longer than any worn piece of tape; body.md counts the line as lost after 25 to 40 mm, from then on it coasts."""
BLIND_BEFORE_POST_MM = 40.0
"""So near to a post (and the sensor's lead) branches and corners pass under the diodes: the robot holds its way."""
OWN_POST_MM = 600.0
"""A marker of the post it set out from does not count so near to it."""
STANDS_S = 0.2
FRUITLESS_MM = 500.0
MOST_SEARCHES = 3
"""So many searches in a row with less than half a metre of line between them: this is where the line ends."""
MOST_BUMPS = 3
INNER_WHEEL_MM_S = 30.0


class FollowLine:
    """Done(post), standing with the axle at the post; line_lost, blocked (three bumps), docked, timeout."""

    name: ClassVar[str] = "follow_line"
    moves: ClassVar[bool] = True
    on_timeout: ClassVar[str] = "timeout"

    def __init__(
        self,
        campus: CampusMap,
        leaving: str | None = None,
        cruise_mm_s: float = 150.0,
        shape: BodyShape | None = None,
        limit_s: float = 600.0,
    ) -> None:
        """`leaving`: the post it sets out from, if known: it tells which marker the next post will show."""
        self._campus, self._leaving, self._cruise_mm_s = campus, leaving, cruise_mm_s
        self._shape = shape or BodyShape()
        self.limit_s = limit_s

    def start(self, view: View, now: float) -> None:
        """See `interfaces.Skill.start`."""
        self._line = LineEstimate(self._shape)
        self._last = self._begin = view.odometry
        self._began_s = now
        self._bumps_before = view.bumps
        self._lit_mm = view.odometry.travelled_mm
        self._search: FindLine | None = None
        self._searches, self._searched_mm = 0, -FRUITLESS_MM
        self._post: str | None = None
        self._post_at_mm = 0.0
        self._sighted_s = now
        self._standing_since_s: float | None = None

    def step(self, view: View, now: float) -> Step:
        """See `interfaces.Skill.step`."""
        if view.base is not None and view.base.docked:
            return Failed("docked")
        if view.bumps - self._bumps_before >= MOST_BUMPS:
            return Failed("blocked")
        if self._search is not None:
            return self._searched(self._search, view, now)
        self._look_for_post(view)
        to_go_mm = self._post_at_mm - view.odometry.ahead_mm if self._post else None
        self._look_at_line(view, to_go_mm)
        if to_go_mm is not None and to_go_mm <= CRAWL_MM_S * WHEEL_LAG_S:
            return self._stop(view)
        self._standing_since_s = None
        if to_go_mm is None and view.odometry.travelled_mm - self._lit_mm > LOST_AFTER_MM:
            return self._lost(view, now)
        return Running(self._speeds(to_go_mm))

    # The post

    def _look_for_post(self, view: View) -> None:
        """Every new sighting of the post ahead makes its distance better: the last ones are abreast of it."""
        seen = view.post
        if seen is None or seen.at_s <= self._sighted_s or seen.text not in self._campus.posts:
            return
        self._sighted_s = seen.at_s
        if self._still_leaving(seen.text, view.odometry):
            return
        heading = arrival_heading_rad(self._campus, self._leaving, seen.text)
        ahead_mm = post_ahead_mm(self._campus, seen, heading)
        if ahead_mm is not None and (self._post in (None, seen.text) or ahead_mm > 0):
            self._post, self._post_at_mm = seen.text, view.post_odometry.ahead_mm + ahead_mm

    def _still_leaving(self, post: str, here: Odometry) -> bool:
        """Near the post it set out from, and not on the way back to it."""
        begin = self._begin
        near = math.hypot(here.x_mm - begin.x_mm, here.y_mm - begin.y_mm) < OWN_POST_MM
        return post == self._leaving and near and math.cos(here.heading_rad - begin.heading_rad) > 0

    def _stop(self, view: View) -> Step:
        if self._standing_since_s is None:
            self._standing_since_s = view.at_s
        return Done(self._post) if view.at_s - self._standing_since_s >= STANDS_S else Running(STOP)

    # The line

    def _look_at_line(self, view: View, to_go_mm: float | None) -> None:
        here, before = view.odometry, self._last
        self._last = here
        self._line.move(here.ahead_mm - before.ahead_mm, here.heading_rad - before.heading_rad)
        blind = to_go_mm is not None and to_go_mm < self._shape.sensor_lead_mm + BLIND_BEFORE_POST_MM
        if not blind:
            self._line.see(view.reading)
        if over_line(view):
            self._lit_mm = here.travelled_mm

    def _speeds(self, to_go_mm: float | None) -> WheelSpeeds:
        off_mm = self._line.at(LOOK_AHEAD_MM)
        off_share = min(1.0, max(0.0, abs(off_mm) - CLOSE_MM) / SLOW_BY_MM)
        speed = self._cruise_mm_s - (self._cruise_mm_s - SLOWEST_MM_S) * off_share
        if to_go_mm is not None:
            speed = min(speed, max(CRAWL_MM_S, math.sqrt(2 * BRAKE_MM_S2 * max(0.0, to_go_mm - 5.0))))
        return curve(speed, 2 * off_mm / LOOK_AHEAD_MM**2, self._shape)

    def _lost(self, view: View, now: float) -> Step:
        fruitless = view.odometry.travelled_mm - self._searched_mm < FRUITLESS_MM
        self._searches = self._searches + 1 if fruitless else 1
        if self._searches > MOST_SEARCHES:
            return Failed("line_lost")
        heading = view.odometry.heading_rad + self._line.heading
        self._search = FindLine(self._shape, side=self._line.at(self._shape.sensor_lead_mm), heading_rad=heading)
        self._search.start(view, now)
        return self._searched(self._search, view, now)

    def _searched(self, search: FindLine, view: View, now: float) -> Step:
        step = search.step(view, now)
        if isinstance(step, Failed):
            return step
        if isinstance(step, Done):
            self._resume(view.odometry, now)
            return Running(STOP)
        return step

    def _resume(self, here: Odometry, now: float) -> None:
        """As at the beginning: the way searched tells nothing about the post ahead."""
        self._search = self._post = None
        self._sighted_s = now
        self._line = LineEstimate(self._shape)
        self._last = here
        self._lit_mm = self._searched_mm = here.travelled_mm


def curve(speed_mm_s: float, curvature_per_mm: float, shape: BodyShape) -> WheelSpeeds:
    """Wheels for a curve (left positive), the inner one never slower than 30 mm/s."""
    half = shape.wheel_base_mm / 2
    tightest = max(0.0, 1 - INNER_WHEEL_MM_S / speed_mm_s) / half
    bend = min(max(curvature_per_mm, -tightest), tightest) * half
    return WheelSpeeds(speed_mm_s * (1 - bend), speed_mm_s * (1 + bend))
