"""Following the line to the next post, and stopping there.

Fifty times a second: where is the line (line_estimate.py), which curve leads back onto it, how fast may that be.
"""

import math
from collections.abc import Callable
from typing import ClassVar

from maps import CampusMap
from maps.bays import WAITS_BEFORE_CROSSING_M
from robot.drivers.interfaces import STOP, BodyShape, WheelSpeeds
from robot.localization.expected import Expected
from robot.skills.find_line import FindLine, over_line
from robot.skills.give_way import GiveWay, most_mm_s
from robot.skills.interfaces import Done, Failed, Running, Step, View
from robot.skills.line_estimate import LineEstimate, gains
from robot.skills.post_ahead import PostAhead
from robot.skills.unread_post import TAPE_HALF_MM, UnreadPost

SLOWEST_MM_S = 70.0
CLOSE_MM, SLOW_BY_MM = 8.0, 25.0
"""The speed falls towards the slowest as the line ahead is off by more than the first, by so much."""
STRAIGHT_OFF_MM, STRAIGHT_RADIUS_MM = 12.0, 400.0
"""It looks farthest ahead on the line; the nearer to the first beside it, or to this radius, the less far."""
CRAWL_MM_S = 40.0
BRAKE_MM_S2 = 400.0
WHEEL_LAG_S = 0.06
LOST_AFTER_MM = 70.0
"""Longer than any worn piece of tape; body.md counts the line as lost after 25 to 40 mm, from then on it coasts."""
BLIND_BEFORE_POST_MM = 40.0
"""So near to a post (and the sensor's lead) branches and corners pass under the diodes: the robot holds its way."""
UNSEEN_BEFORE_POST_MM = 150.0
"""From here on a post in sight is reached without the line, if need be."""
STANDS_S = 0.2
BEYOND_MM, BACK_MM_S = 25.0, 50.0
"""Standing farther than this beyond the post it goes back."""
FRUITLESS_MM = 500.0
MOST_SEARCHES = 3
"""So many searches in a row with less than half a metre of line between them: this is where the line ends."""
INNER_WHEEL_MM_S, OUTER_WHEEL_MM_S = 30.0, 200.0
LOOKS_FROM_MM, LOOKS_MM_S = 210.0, 90.0
"""So near to where a post should be a marker should have been read; if not, it looks more slowly."""
OTHER_LINE_MM = 15.0
"""Where an unseen post may be, tape that lies farther beside the line than this is a branch."""
BRANCH_MM = 40.0
"""No branch is wider; what darkens an outer diode for longer is the line itself."""


WAITS_BEFORE_MM = 1000 * WAITS_BEFORE_CROSSING_M


class FollowLine:
    """Done(post), the axle at the post; line_lost, post_missed, blocked (three bumps), docked, timeout; must_wait: it
    stands before a crossing that it may not enter."""

    name: ClassVar[str] = "follow_line"
    moves: ClassVar[bool] = True
    on_timeout: ClassVar[str] = "timeout"

    def __init__(
        self,
        campus: CampusMap,
        leaving: str | None = None,
        cruise_mm_s: float = 200.0,
        shape: BodyShape | None = None,
        limit_s: float = 600.0,
        way_left_mm: float | None = None,
        ahead: str | None = None,
        unread: bool = False,
        sighted: tuple[str, float] | None = None,
        expected: Expected | None = None,
        may_cross: Callable[[], bool] = lambda: True,
    ) -> None:
        """`leaving`: the post it sets out from, if known: it tells which marker the next post will show.
        `way_left_mm`: how far the next post is by the map, if known; `ahead`: which one that is. With both, a post
        whose marker cannot be read is reached by map and wheels; `unread`: it could not be read the last time.
        `sighted`: the post whose marker has been seen already, and where it is by odometry's `ahead_mm`. `expected`:
        which markers may come next; at any other it drives by. `may_cross`: whether it may drive on to the post."""
        self._campus, self._leaving, self._cruise_mm_s = campus, leaving, cruise_mm_s
        self._shape = shape or BodyShape()
        self._gains = gains(self._shape.sensor_lead_mm)
        self._way_left_mm, self._ahead, self._is_unread = way_left_mm, ahead, unread
        self._sighted, self._expected, self._may_cross = sighted, expected, may_cross
        self.limit_s = limit_s

    def start(self, view: View, now: float) -> None:
        """See `interfaces.Skill.start`."""
        self._line = LineEstimate(self._shape)
        self._last = self._begin = view.odometry
        self._give_way = GiveWay(view, now)
        self._lit_mm = view.odometry.travelled_mm
        self._lit_ahead_mm = view.odometry.ahead_mm
        self._line_end_mm: float | None = None
        self._branch_since_mm: float | None = None
        self._search: FindLine | None = None
        self._searches, self._searched_mm = 0, -FRUITLESS_MM
        self._post = PostAhead(self._campus, self._leaving, view.odometry, now, self._sighted, self._expected)
        self._unread = UnreadPost(
            self._campus, self._leaving, self._ahead, view.odometry, self._way_left_mm, self._shape
        )
        self._standing_since_s: float | None = None
        if self._is_unread and not self._unread.shows:
            self._suppose_post()

    def step(self, view: View, now: float) -> Step:
        """See `interfaces.Skill.step`."""
        if view.base is not None and view.base.docked:
            return Failed("docked")
        if self._give_way.blocked(view):
            return Failed("blocked")
        if self._give_way.stands(view, now):
            return Running(STOP)
        self._post.look(view, self._line.heading)
        if self._search is not None:
            return self._searched(self._search, view, now)
        to_go_mm = self._post.to_go_mm(view.odometry)
        self._look_at_line(view, to_go_mm)
        room_mm = None if self._may_cross() else self._to_waiting_point_mm(view, to_go_mm)
        if room_mm is not None and room_mm <= CRAWL_MM_S * WHEEL_LAG_S:
            return Failed("must_wait") if view.sent.still else Running(STOP)
        if to_go_mm is not None and to_go_mm <= CRAWL_MM_S * WHEEL_LAG_S:
            return self._stop(view, to_go_mm)
        self._standing_since_s = None
        if to_go_mm is None and self._unread.beyond_mm(view.odometry) > self._unread.most_beyond_mm:
            return self._missed(view)
        if self._has_lost(view, to_go_mm):
            missed = self._may_be_at_post(view) and not self._post.supposed
            return self._missed(view) if missed else self._lost(view, now)
        wanted_mm_s = self._cruise_mm_s if to_go_mm is not None else self._looking_mm_s(view)
        return Running(self._speeds(to_go_mm if room_mm is None else room_mm, min(wanted_mm_s, most_mm_s(view))))

    def _to_waiting_point_mm(self, view: View, to_go_mm: float | None) -> float | None:
        """By the marker of the post; before it is read so early that the post cannot be nearer than that."""
        if to_go_mm is not None:
            return to_go_mm - WAITS_BEFORE_MM
        beyond_mm = self._unread.beyond_mm(view.odometry) + self._unread.doubt_mm
        return None if beyond_mm == -math.inf else -beyond_mm - WAITS_BEFORE_MM

    # The post

    def _stop(self, view: View, to_go_mm: float) -> Step:
        if self._standing_since_s is None:
            self._standing_since_s = view.at_s
        if view.at_s - self._standing_since_s < STANDS_S:
            return Running(STOP)
        if to_go_mm < -BEYOND_MM:
            return Running(WheelSpeeds(-BACK_MM_S, -BACK_MM_S))
        # What it ran on while braking, or back, is done: a robot that stands does not begin again.
        return Done(self._post.name, unread=self._post.supposed) if view.sent.still else Running(STOP)

    def _may_be_at_post(self, view: View) -> bool:
        """Return whether a post whose marker has not been read may be here: where the line ends, or branches off."""
        return (self._post.name is None or self._post.supposed) and self._unread.may_be_here(view.odometry)

    def _missed(self, view: View) -> Step:
        """It goes back to where the post must be, if it knows which one that is."""
        end_mm = self._lit_ahead_mm + self._shape.sensor_lead_mm - TAPE_HALF_MM
        self._line_end_mm = end_mm if self._has_lost(view, None) else None
        return Running(STOP) if self._suppose_post() else Failed("post_missed")

    def _suppose_post(self) -> bool:
        """Its marker cannot be read: it is where the tape shows it, else where the map says. False: not known, or a
        foreign marker says that the robot may be elsewhere."""
        at_mm = self._unread.place_mm(self._line_end_mm)
        if self._ahead is None or at_mm is None or self._post.foreign:
            return False
        self._post.suppose(self._ahead, at_mm)
        return True

    # The line

    def _look_at_line(self, view: View, to_go_mm: float | None) -> None:
        here, before = view.odometry, self._last
        self._last = here
        self._line.move(here.ahead_mm - before.ahead_mm, here.heading_rad - before.heading_rad)
        near_post = to_go_mm is not None and to_go_mm < self._shape.sensor_lead_mm + BLIND_BEFORE_POST_MM
        unread = self._may_be_at_post(view)
        on_branch = unread and self._is_on_branch(view)
        if not near_post and not on_branch:
            self._line.see(view.reading, OTHER_LINE_MM if unread else math.inf)
        if over_line(view):
            self._lit_mm, self._lit_ahead_mm = here.travelled_mm, here.ahead_mm

    def _is_on_branch(self, view: View) -> bool:
        """Return whether what the diodes read may be a branch beside the line; where it is tells where the post is."""
        here, knew_mm = view.odometry, self._unread.branch_mm
        self._unread.look(view.reading, here)
        if self._post.supposed or self._unread.branch_mm != knew_mm:
            self._suppose_post()
        if not self._unread.like_branch(view.reading):
            self._branch_since_mm = None
        elif self._branch_since_mm is None:
            self._branch_since_mm = here.travelled_mm
        return self._branch_since_mm is not None and here.travelled_mm - self._branch_since_mm < BRANCH_MM

    def _looking_mm_s(self, view: View) -> float:
        due = self._unread.beyond_mm(view.odometry) > -self._unread.doubt_mm - LOOKS_FROM_MM
        return min(self._cruise_mm_s, LOOKS_MM_S) if due else self._cruise_mm_s

    def _speeds(self, to_go_mm: float | None, most_mm_s: float) -> WheelSpeeds:
        off_mm = self._line.at(self._gains.look_ahead_mm)
        off_share = min(1.0, max(0.0, abs(off_mm) - CLOSE_MM) / SLOW_BY_MM)
        speed = most_mm_s - (most_mm_s - SLOWEST_MM_S) * off_share
        if to_go_mm is not None:
            speed = min(speed, max(CRAWL_MM_S, math.sqrt(2 * BRAKE_MM_S2 * max(0.0, to_go_mm - 5.0))))
        return curve(speed, self._bend(), self._shape)

    def _bend(self) -> float:
        """Curvature (1/mm, left positive) of the arc that meets the line ahead.

        Each curve costs speed, since the outer wheel is at its pace already. So a line that is near and nearly straight
        is met farther ahead.
        """
        near_mm, far_mm = self._gains.look_ahead_mm, self._gains.straight_look_ahead_mm
        off_share = min(1.0, abs(self._line.at(near_mm)) / STRAIGHT_OFF_MM)
        bent_share = min(1.0, abs(self._line.curvature) * STRAIGHT_RADIUS_MM)
        look_mm = near_mm + (far_mm - near_mm) * (1 - off_share) * (1 - bent_share)
        return 2 * self._line.at(look_mm) / look_mm**2

    def _has_lost(self, view: View, to_go_mm: float | None) -> bool:
        near = to_go_mm is not None and to_go_mm < UNSEEN_BEFORE_POST_MM
        return not near and view.odometry.travelled_mm - self._lit_mm > LOST_AFTER_MM

    def _lost(self, view: View, now: float) -> Step:
        fruitless = view.odometry.travelled_mm - self._searched_mm < FRUITLESS_MM
        self._searches = self._searches + 1 if fruitless else 1
        if self._searches > MOST_SEARCHES:
            return Failed("line_lost")
        heading, side = view.odometry.heading_rad + self._line.heading, self._line.at(self._shape.sensor_lead_mm)
        return self._begin_search(FindLine(self._shape, side=side, heading_rad=heading), view, now)

    def _begin_search(self, search: FindLine, view: View, now: float) -> Step:
        self._search = search
        search.start(view, now)
        return self._searched(search, view, now)

    def _searched(self, search: FindLine, view: View, now: float) -> Step:
        step = search.step(view, now)
        if isinstance(step, Done):
            self._resume(view)
            return Running(STOP)
        return step

    def _resume(self, view: View) -> None:
        """The line begins anew; a post that was in sight is where it was."""
        self._search = None
        self._line = LineEstimate(self._shape)
        self._last = view.odometry
        self._lit_mm = self._searched_mm = view.odometry.travelled_mm
        self._post.after_search(view.odometry)


def curve(speed_mm_s: float, curvature_per_mm: float, shape: BodyShape) -> WheelSpeeds:
    """Wheels for a curve (left positive): so slow in it that the outer one may run at its pace, and the inner one never
    below 30 mm/s."""
    half = shape.wheel_base_mm / 2
    speed = min(speed_mm_s, OUTER_WHEEL_MM_S / (1 + abs(curvature_per_mm) * half))
    speed = max(speed, INNER_WHEEL_MM_S)
    tightest = max(0.0, 1 - INNER_WHEEL_MM_S / speed) / half
    bend = min(max(curvature_per_mm, -tightest), tightest) * half
    return WheelSpeeds(speed * (1 - bend), speed * (1 + bend))
