"""The robot's idea of where it is and where it goes: kept up with what the body sees, written down for a power cut."""

import math
from contextlib import suppress
from dataclasses import replace
from functools import partial
from itertools import pairwise

from maps import CampusMap, NoRoute, corridor_name, shortest_route
from maps.geometry import wrapped
from protocol.parts import Leg
from robot.drivers.interfaces import Odometry, Sighting
from robot.duties import Duties
from robot.navigation.approach import is_aslant
from robot.navigation.astray import FROM_MM, TO_MM, Compass, really_towards
from robot.navigation.by_fixes import near_dock
from robot.navigation.closed import Closed, open_way
from robot.navigation.directions import PLAIN_TURNS, Way, kept_from, next_post
from robot.navigation.docks import in_dock, nearest_dock, way_out
from robot.navigation.granted import behind
from robot.navigation.moved import cannot_be_next, found_at, nowhere
from robot.navigation.position import REACHED_MM, Position
from robot.navigation.remembering import remembered
from robot.navigation.way_scale import WayScale
from robot.skills.interfaces import View

RESTS_MM = 25.0
"""A pulse or two of the paper's `drive`. Its program does not look at the line as long as it perceives a post."""
SAME_WAY_RAD = math.radians(60)
"""A robot that looks along a corridor to within this is taken to be going there."""
STRAIGHT_RAD = math.radians(12)
"""Within this the line is under the diodes, and following it straightens the robot up."""
TURNING = frozenset({"turn", "undock", "find_line"})
"""Skills during which a marker is seen from aslant: it says nothing about the way that is left to its post."""
FOLLOWING = "follow_line"
LIFTED = "wheel_drop"
"""The fault during which somebody holds the robot in their hands, perhaps to put it down elsewhere."""
MARKER_UNREAD = "marker_unread"
KEPT_POSTS = 500
"""More than a run with a summary visits; a robot runs for months."""
SURELY_PAST_M = 0.3


class Navigator:
    """Position and destination. Told by actions what they are about to do, and by the body what it sees."""

    def __init__(self, campus: CampusMap, home: str | None, duties: Duties, now: float) -> None:
        self.campus, self.home = campus, home
        self.destination: str | None = None
        self.visited: list[str] = []
        """The posts reached, in order, the newest ones; the same one twice only after another."""
        self.arrivals = 0
        """How many posts it has reached so far."""
        self.position = remembered(campus, duties.held.position)
        self.towards = duties.held.position.towards
        """The post ahead, once the robot has set out."""
        self.closed = Closed(duties.closed_ages_s(), duties.keep_closed, now)
        duties.open_way = partial(open_way, campus, self.closed)
        self._duties = duties
        self._odometry = Odometry()
        self._disturbed = 0  # by searches and bumps, so far
        self._scale = WayScale()
        self._docked = False
        self._leaving = self.position.has_left
        self._ignored_until_s = -math.inf
        self._arrived_mm = 0.0
        self._nearest: tuple[object, str | None] = ((), home)  # asked ten times a second, answered once per post
        self._far_end: str | None = None  # of the corridor that it turned round in
        self._lifted = False
        self._lifted_from: set[str] = set()
        self.unread: set[str] = set()
        """Posts whose marker could not be read when the robot was there last."""
        self.astray: str | None = None
        """The post that it drives towards by mistake, until it has turned round."""
        self._compass = Compass()
        self.moved: str | None = None
        """Where it found itself after somebody had moved it, until that is noted."""

    def look(self, view: View) -> None:
        """Take in what the body sees now."""
        self._odometry, self._disturbed = view.odometry, view.find_line_episodes + view.bumps
        self.closed.pass_time(view.at_s)
        docked = bool(view.base and view.base.docked)
        post = self._sighted(view)
        if not docked:
            self._find_place(view, post)
        before = self.position
        self.position = before.after(self.campus, view.odometry, post, view.post_odometry, docked)
        if docked and not self._docked:
            self.position = in_dock(self.campus, self.position, self.home, view.odometry)
        self._docked = docked
        self._note_change(before, docked)
        if view.motion == FOLLOWING and not view.searching:
            self._check_way()

    def _sighted(self, view: View) -> Sighting | None:
        """The marker that it has seen, unless from aslant."""
        if view.post and (view.motion in TURNING or is_aslant(view.post)):
            self._ignored_until_s = view.post.at_s
        return view.post if view.post and view.post.at_s > self._ignored_until_s else None

    def _find_place(self, view: View, post: Sighting | None) -> None:
        """Whether it is somewhere else than it believed."""
        self.position = near_dock(self.campus, self.position, view.fixes, self.home, view.at_s)
        if LIFTED in view.faults:
            if not self._lifted:
                self.lose_place(view, nowhere(self.position))
            self._ignored_until_s = view.post.at_s if view.post else self._ignored_until_s
        elif post and post.at_s != self.position.seen_at_s:
            self._check_place(post, view.post_odometry)

    def _note_change(self, before: Position, docked: bool) -> None:
        after = self.position
        reached = after.current != before.current and not after.has_left
        reached = reached or (before.approaching is not None and after.approaching is None)
        reached = reached or self._is_back(after)
        if after.current and (reached or (docked and self._leaving)):
            self._note_arrival(after.current, before.current)
        elif after.has_left and not self._leaving:
            self._set_out()

    def _check_way(self) -> None:
        """Whether it follows the line that it was going to."""
        driven_mm, looks_rad = self._odometry.ahead_mm - self._arrived_mm, self._compass.looks_rad(self._odometry)
        if not (self._leaving and FROM_MM < driven_mm < TO_MM) or self._far_end or looks_rad is None:
            return
        if self.here and self.towards and (really := really_towards(self.campus, self.here, self.towards, looks_rad)):
            self.astray = really
            self._looks(self.campus.corridor(self.here, really).heading_leaving(self.here))
            self._head_for(really)

    def lose_place(self, view: View, position: Position | None = None) -> None:
        """It is being lifted (`position` is where it was), or was taken away: where it is put down, only a marker or a
        dock can say."""
        self._lifted = self._leaving = True
        self._lifted_from = {post for post in (self.here, self.towards, self._far_end) if post} if position else set()
        self.position, self.towards, self._far_end = position or Position(has_left=True), None, None
        self._ignored_until_s = view.post.at_s if view.post else self._ignored_until_s
        self._docked = False
        self._compass.set(None, view.odometry)

    def _check_place(self, post: Sighting, odometry: Odometry) -> None:
        """A marker that cannot come next: somebody has moved the robot, out of whatever corridor it held."""
        lifted, self._lifted = self._lifted, False
        elsewhere = cannot_be_next(self.campus, self.position, post)
        if lifted and not elsewhere and post.text in self._lifted_from and post.text != self.here:
            return  # put back where it was, or nearly
        if not lifted and not elsewhere:
            return
        self.position = found_at(self.campus, self.position, post, odometry, lifted)
        self._compass.set(None, odometry)
        self._leaving, self.towards, self._far_end = True, post.text, None
        if elsewhere or post.text not in self._lifted_from:
            self.moved = post.text
            self._duties.claims.clear(self._duties.held.grants)

    def _note_arrival(self, post: str, before: str | None) -> None:
        self._learn_scale(post, before)
        self._leaving, self.towards, self.astray = False, None, None
        self._arrived_mm = self._odometry.ahead_mm
        self._compass.set(self.position.facing_now_rad(self._odometry), self._odometry)
        self._duties.seen(post)
        if before and before != post:
            self._duties.claims.clear(behind(self._duties.held.grants, post, Leg(from_post=before, to_post=post)))
        # Where it turned back is not given back here: it may wish to go in again (decision 0022).
        self._far_end = None
        if self.visited[-1:] != [post]:
            self.visited.append(post)
            self.arrivals += 1
            del self.visited[:-KEPT_POSTS]

    def _learn_scale(self, post: str, before: str | None) -> None:
        beside = {other.name: corridor.length_m for other, corridor in self.campus.neighbours(post)}
        straight = before is not None and self._far_end is None and post not in self.unread
        self._scale.arrive(self.position.post_at_mm, beside.get(before or "") if straight else None, self._disturbed)

    def _set_out(self) -> None:
        self._leaving = True
        told = self.here not in self.unread and self.position.approaching is None
        self._scale.set_out(self.position.post_at_mm if told else None, self._disturbed)
        self._head_for(self.position.approaching or self._post_ahead())

    def _head_for(self, towards: str | None) -> None:
        self.towards = towards
        self._duties.heading_for(towards)

    def _post_ahead(self) -> str | None:
        """The neighbour that the robot looks towards."""
        here = self.position.current
        turns = {post.name: self._turn_to(post.name) for post, _ in self.campus.neighbours(here)} if here else {}
        known = {abs(turn): name for name, turn in turns.items() if turn is not None}
        return known[min(known)] if known and min(known) < SAME_WAY_RAD else None

    def _turn_to(self, neighbour: str) -> float | None:
        return self.position.turn_rad(self.campus, neighbour, self._odometry)

    def place(self, post: str, towards: str | None) -> None:
        """A person has put the robot down at a post, looking along a corridor. Raises UnknownPost."""
        self.position = Position.placed(self.campus, post, towards, self._odometry)
        self._note_arrival(post, None)

    # What actions and percepts ask.

    @property
    def at(self) -> str | None:
        """The post where the robot stands; None once it follows the line away from there."""
        return None if self._leaving else self.position.at

    @property
    def rests_at(self) -> str | None:
        """The post, as long as the robot has not rolled on from where it reached it."""
        return self.at if abs(self._odometry.ahead_mm - self._arrived_mm) <= RESTS_MM else None

    @property
    def here(self) -> str | None:
        """The last post reached: the place to name in a report."""
        return self.position.current

    def reached_after(self, arrivals: int) -> list[str]:
        """The posts reached after so many others; of very many the newest."""
        new = self.arrivals - arrivals
        return self.visited[-new:] if new else []

    def way(self) -> Way | None:
        """The way from here to the destination; None between posts, and where no way leads."""
        with suppress(NoRoute):
            if self.destination is not None and self.at is not None:
                return self.position.way_to(self.campus, self.destination, self._odometry, self._not_next())
        return None

    def _not_next(self) -> frozenset[str]:
        """What it avoids where it stands: all that does not lead straight to where the service sends it first."""
        return kept_from(self.campus, self._duties.held.detour, self.at, self.destination, self._avoided())

    def _avoided(self) -> frozenset[str]:
        return self.closed.names | {corridor_name(leg.from_post, leg.to_post) for leg in self._duties.claims.avoid}

    @property
    def corridor(self) -> Leg | None:
        """The corridor that the robot is in, in the direction in which it was granted; None at a post."""
        end = self._far_end or self.towards
        known = self._leaving and self.here and end and end != self.here
        return Leg(from_post=self.here, to_post=end) if known else None

    @property
    def came_from(self) -> str | None:
        """The post that lies behind it: the last one reached, unless it has turned round on the way."""
        return self._far_end or self.here

    def legs_to(self, *posts: str) -> tuple[Leg, ...]:
        """The corridors from here to each of these posts in turn. Raises NoRoute."""
        way: list[str] = [self.here] if self.here else []
        for post in posts if way else ():
            way += shortest_route(self.campus, way[-1], post, self._avoided()).posts[1:]
        return tuple(Leg(from_post=a, to_post=b) for a, b in pairwise(way))

    def first_legs(self, goal: str) -> tuple[Leg, ...]:
        """The corridors that it may be in next on the way to a post: every one here while it does not know which way it
        looks. All markers of a post carry the same text, so after a lift only the next post tells. Raises NoRoute."""
        first = self.legs_to(goal)[:1]
        if not first or self.position.facing_now_rad(self._odometry) is not None:
            return first
        here = first[0].from_post
        return tuple(Leg(from_post=here, to_post=post.name) for post, _ in self.campus.neighbours(here))

    def turn_rad(self, way: str) -> float:
        """How far to turn, left is positive: to the corridor of the destination if that lies there, else a quarter.

        The paper's program turns left for what lies behind.
        """
        plain_rad = PLAIN_TURNS[way]
        towards = self._next_post()
        by_map_rad = self._turn_to(towards) if towards else None
        if by_map_rad is None or self.way() not in (way, Way.BEHIND):
            return plain_rad
        # A hair beyond 180 degrees must not turn the other way round than asked.
        return by_map_rad if abs(by_map_rad) < math.radians(170) else math.copysign(by_map_rad, plain_rad)

    @property
    def aslant_rad(self) -> float:
        """How far it must turn to look along the corridor that its way takes; 0 if it does, or if none is known."""
        towards = self._next_post()
        turn_rad = self._turn_to(towards) if towards else None
        return turn_rad if turn_rad is not None and abs(turn_rad) > STRAIGHT_RAD else 0.0

    def _next_post(self) -> str | None:
        with suppress(NoRoute):
            if self.destination is not None and self.at is not None:
                return next_post(self.campus, self.at, self.destination, self._not_next())
        return None

    @property
    def ahead_m(self) -> float:
        """The length of the corridor it is in or about to enter; of the longest one while that is not known."""
        if self.corridor:
            return self.campus.corridor(self.corridor.from_post, self.corridor.to_post).length_m
        return max((corridor.length_m for corridor in self.campus.corridors), default=0.0)

    @property
    def way_left_mm(self) -> float | None:
        """To the end of the corridor, by the map and by odometry; None where it is not known or long past."""
        leg, at_mm, here_mm = self.corridor, self.position.post_at_mm, self._odometry.ahead_mm
        if leg is None or at_mm is None or self.position.approaching:
            return None
        length_mm = 1000 * self.campus.corridor(leg.from_post, leg.to_post).length_m / self._scale.real_per_counted
        left_mm = at_mm - here_mm if self._far_end else length_mm - (here_mm - at_mm)
        return left_mm if left_mm > -1000 * SURELY_PAST_M else None

    def nearest_dock(self) -> str | None:
        """The dock with the shortest way from here that is open; the robot's own while the place is unknown."""
        asked = (self.here, self._duties.claims.avoid, self.closed.names)
        if asked != self._nearest[0]:
            near = nearest_dock(self.campus, self.here, self._avoided()) if self.here else self.home
            self._nearest = (asked, near)
        return self._nearest[1]

    # What actions tell.

    def leave(self) -> None:
        """The robot is about to follow the line away from its post."""
        if not self._leaving:
            self._set_out()

    def begin_turn(self) -> None:
        """After a power cut in the middle of a turn, going on along the line is the way to find out."""
        if not self._leaving:
            self._duties.heading_for(self._next_post())

    def turned(self) -> None:
        """A turn has ended on the line: what was left of odometry's error is forgotten."""
        if self._leaving:
            self._turn_back()
            return
        ahead = self._post_ahead()
        if ahead and self.here:
            heading_rad = self.campus.corridor(self.here, ahead).heading_leaving(self.here)
            self._looks(heading_rad)

    def _turn_back(self) -> None:
        """It has turned round between two posts: what lay behind lies ahead, as far as it was behind."""
        leg, here = self.corridor, self.position
        self.astray = None
        if leg is None:
            return
        self._far_end = None if self._far_end else leg.to_post
        self._head_for(leg.from_post if self._far_end else leg.to_post)
        behind_mm = self._odometry.ahead_mm - here.post_at_mm if here.post_at_mm is not None else None
        post_at_mm = None if behind_mm is None or here.approaching else self._odometry.ahead_mm + behind_mm
        self.position = replace(here, approaching=None, post_at_mm=post_at_mm, has_left=True)

    def _is_back(self, position: Position) -> bool:
        """It has turned round, and stands at the post that it had left."""
        at_mm = position.post_at_mm
        near = at_mm is not None and abs(at_mm - self._odometry.ahead_mm) <= REACHED_MM
        return self._far_end is not None and position.approaching is None and near

    def noted_move(self) -> None:
        """The agent knows that it was moved."""
        self.moved = None

    def reached(self, post: str | None, unread: bool = False) -> None:
        """follow_line has stopped there. Both go by the same marker, but the body has the last word; `unread`: by the
        map alone."""
        before = self.position
        if post is not None:
            self._note_marker(post, unread)
        if post is None or (self.at == post and before.approaching is None):
            return
        self.position = before.stands_at(self.campus, post, self._odometry)
        self._note_arrival(post, before.current)

    def _note_marker(self, post: str, unread: bool) -> None:
        """People are told of a marker that somebody should clean, and when all can be read again."""
        reason = f"The marker of {post} cannot be read. The robot went there by the length of the way."
        if unread:
            self.unread.add(post)
            self._duties.report_fault(MARKER_UNREAD, reason, post)
        else:
            self.unread.discard(post)
        if not self.unread:
            self._duties.report_fault(MARKER_UNREAD, "Every marker has been read again.", post, cleared=True)

    def undock_way(self) -> tuple[float | None, bool]:
        """From the dock that it stands in to the post, in mm, and whether the line that it takes leads straight on."""
        return way_out(self.campus, self.here, self._next_post())

    def undocked(self) -> None:
        """The robot stands at the dock's post and looks away from the dock: along the line, or as far as it turned."""
        dock = self.campus.post(self.here).dock if self.here else None
        if dock:
            away_rad, facing_rad = dock.heading_rad + math.pi, self.position.facing_now_rad(self._odometry)
            if facing_rad is None or abs(wrapped(facing_rad - away_rad)) < STRAIGHT_RAD:
                self._looks(away_rad)
            self.position = replace(self.position, post_at_mm=self._odometry.ahead_mm, has_left=False)
            self._leaving, self.towards = False, None
            self._arrived_mm = self._odometry.ahead_mm

    def _looks(self, heading_rad: float) -> None:
        self.position = replace(self.position, facing_rad=heading_rad, spot_turn_rad=self._odometry.spot_turn_rad)
        self._compass.confirm(heading_rad, self._odometry)
