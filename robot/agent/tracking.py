"""Keeping track of the place: every sighting, every bit of way and every turn is fed to `localization/place.py`, and
what must survive a power cut is written down."""

import math
from dataclasses import replace

from maps import CampusMap, Corridor
from maps.geometry import wrapped
from protocol.parts import Leg
from robot.agent.unread_markers import UnreadMarkers
from robot.drivers.interfaces import BodyShape, Odometry, Sighting
from robot.localization.approach import is_aslant, post_ahead_mm
from robot.localization.astray import FROM_MM, TO_MM, Compass, really_towards
from robot.localization.bays import evidence_of, occupied
from robot.localization.by_fixes import near_dock
from robot.localization.counted_turn import CountedTurn, Turned
from robot.localization.directions import corridor_ahead, looks_otherwise, turn_towards_rad
from robot.localization.docks import dock_post
from robot.localization.expected import Expected, Foreign, agree, expected, hangs_beside_this_line, is_own
from robot.localization.facing import facing_by
from robot.localization.granted import behind
from robot.localization.place import AtPost, Between, Coming, Facing, Leaving, Place, Unknown
from robot.localization.remembering import Moment, looks_as_arrived, remembered
from robot.localization.steps import corridor_between, gone_astray, has_left, has_reached, marked, searched, set_out
from robot.localization.way_scale import WayScale
from robot.mission.mission import MissionManager
from robot.skills.interfaces import View

TURNING = frozenset({"turn", "undock", "find_line"})
"""Skills during which a marker is seen from aslant: it says nothing about the way that is left to its post."""
AT_THE_POST = frozenset({"turn", "find_line", "dock", "undock"})
"""Skills that look for the line or the dock around a post: they leave it by some steps without being on their way, and
drive curves which are no bends of a corridor."""
FOLLOWING = "follow_line"
LIFTED = "wheel_drop"
"""The fault during which a person holds the robot in their hands, perhaps to put it down elsewhere."""
AWAY_RAD = math.radians(35)
"""Turned away from its corridor by more, a robot in search of the line sees no marker where it is."""
FOREIGN_MARKER = "foreign_marker"
KEPT_POSTS = 500
"""More than a run with a summary visits; a robot runs for months."""
UNREAD_MM = 300.0
"""So near to the post ahead, abreast of its marker, that should have been read. Where it was not, it cannot be counted
on."""


class Tracker:
    """The place as of the last look. What is driven is told by odometry, what is meant by `Navigator`."""

    def __init__(
        self, campus: CampusMap, home: str | None, missions: MissionManager, now: float, shape: BodyShape
    ) -> None:
        self.campus, self._own_home = campus, home
        self.visited: list[str] = []
        """The posts reached, in order, the newest ones; the same one twice only after another."""
        self.arrivals = 0
        """How many posts it has reached so far."""
        self.unread = UnreadMarkers(missions)
        self.moved: str | None = None
        """Where it found itself after it had been moved, until that is noted."""
        self.crossed: tuple[Leg, ...] = ()
        """The corridors that it has come through and not given back, since the service cannot hear of it."""
        self._duties = missions
        self._moment = Moment(missions.held.moment) if missions.held.moment else None
        turned = missions.turns.kept()
        self._place, self._facing = remembered(campus, missions.held.position, self._moment, turned.back_from)
        begun = turned.begun if self._moment is Moment.TURNING else None
        self._turning = CountedTurn(begun, shape, now)
        self._odometry = Odometry()
        self._disturbed = self._set_out_disturbed = 0  # by searches and bumps, so far
        self._scale = WayScale()
        self._compass = Compass()
        self._seen_at_s = -math.inf  # when the newest marker was read that has been judged
        self._foreign: Foreign | None = None

    @property
    def home(self) -> str | None:
        """Where it rests: the bay that the service has given it, else the home of its settings."""
        given = self._duties.held.home
        return given if given in self.campus.posts else self._own_home

    @property
    def at(self) -> str | None:
        """The post where the robot stands; None once it follows the line away from there."""
        return self._place.here if isinstance(self._place, AtPost) else None

    @property
    def here(self) -> str | None:
        """The last post reached: the place to name in a report."""
        return self._place.here

    @property
    def towards(self) -> str | None:
        """The post ahead, once the robot has set out."""
        return self._place.towards

    @property
    def sighted(self) -> tuple[str, float] | None:
        """The post ahead whose marker has been read, and odometry's reading there."""
        match self._place:
            case Coming(towards=post, at_mm=at_mm):
                return post, at_mm
            case Between(towards=post, ahead_mm=float() as at_mm, by_marker=True):
                return post, at_mm
        return None

    # What the body sees.

    def look(self, view: View) -> None:
        """Take in what the body sees now."""
        if view.base and (looks_rad := self._turning.hear(view.base)) is not None:
            self._facing = Facing.of(looks_rad, view.odometry)
            self._compass.set(looks_rad, view.odometry)
        before, self._odometry = self._odometry, view.odometry
        self._disturbed = view.find_line_episodes + view.bumps
        if view.motion in AT_THE_POST and isinstance(self._place, AtPost | Leaving) and self._facing:
            self._facing = self._facing.curved(before, self._odometry)
        post = self._new_marker(view)
        if view.base and view.base.docked:
            self._stand_in_dock(view)
        elif LIFTED in view.faults:
            self._lift(view)
        else:
            self._drive(view, post)
        here_mm = self._odometry.ahead_mm
        if now := occupied(self.campus, self._place, here_mm):
            self._duties.occupies(now.where, now.post, now.towards, *evidence_of(self._place, here_mm))

    def _new_marker(self, view: View) -> Sighting | None:
        """The marker that it has read since the last look, unless from aslant."""
        post = view.post
        if post is None or post.at_s <= self._seen_at_s:
            return None
        self._seen_at_s = post.at_s
        turns = view.motion in TURNING or (view.searching and not self._looks_along())
        return None if turns or is_aslant(post) or post.text not in self.campus.posts else post

    def _looks_along(self) -> bool:
        """Return whether it looks the way of its corridor: a search for the line turns it away, and what it sees then
        lies elsewhere than it seems."""
        place, looks_rad = self._place, self._looks_rad(self._odometry)
        if not isinstance(place, Between) or looks_rad is None:
            return False
        return abs(wrapped(looks_rad - place.corridor.heading_leaving(place.behind))) < AWAY_RAD

    def _drive(self, view: View, post: Sighting | None) -> None:
        if isinstance(self._place, AtPost) and self._place.docked:
            self._place = replace(self._place, docked=False)
        self._place = near_dock(self.campus, self._place, view.fixes, self.home, view.at_s)
        if post:
            self._see(post, view)
        self._roll(view)
        if view.motion == FOLLOWING and not view.searching:
            self._check_way()

    def _stand_in_dock(self, view: View) -> None:
        """In a dock the robot knows its place, whatever it believed."""
        if isinstance(self._place, AtPost) and self._place.docked:
            return
        foreign = self._foreign.post if self._foreign else None
        post = dock_post(self.campus, self._place.here, foreign, self.home)
        if post is None or post.dock is None:
            return
        now_mm = self._odometry.ahead_mm
        self._facing = Facing.of(post.dock.heading_rad, self._odometry)
        if isinstance(self._place, AtPost) and self._place.here == post.name:
            self._place = replace(self._place, at_mm=now_mm, docked=True)
            self._compass.set(post.dock.heading_rad, self._odometry)
            if self._moment and view.motion != "undock":  # contacts may bounce on the way out
                self._note_seen(post.name)
        else:
            self._arrive(AtPost(post.name, now_mm, now_mm, docked=True))

    def _lift(self, view: View) -> None:
        if not (isinstance(self._place, Unknown) and self._place.lifted):
            self.lose_place(view, keep=True)

    def lose_place(self, view: View, keep: bool = False) -> None:
        """It is being lifted, or was taken away: where it is put down, only a marker or a dock can say. `keep`: it may
        be put back to where it was."""
        match self._place:
            case Between(corridor=corridor):
                was = {corridor.a, corridor.b}
            case place:
                was = {post for post in (place.here, place.towards) if post}
        self._place = Unknown(self._place.here, frozenset(was), lifted=True) if keep else Unknown(lifted=True)
        self._note_moment(Moment.LIFTED)
        self._facing = self._foreign = None
        self._seen_at_s = view.post.at_s if view.post else self._seen_at_s
        self._compass.set(None, view.odometry)
        self._duties.occupancy.forget()

    # Markers.

    def expected(self) -> Expected:
        """Which markers may be read next, and where."""
        foreign = self._foreign is not None
        return expected(self.campus, self._place, self._scale.real_per_counted, self._set_out_disturbed, foreign)

    def _see(self, post: Sighting, view: View) -> None:
        at_mm = self._post_at_mm(post, view.post_odometry)
        if at_mm is None:
            return
        if isinstance(self._place, Unknown):
            self._find(post.text, view.post_odometry, at_mm)
        elif self.expected().allows(post.text, at_mm, self._disturbed):
            before = self._place
            self._place = marked(self.campus, before, post.text, at_mm, view.post_odometry.ahead_mm)
            if isinstance(before, Leaving | Between) and self._place.towards != before.towards:
                self._head_for(self._place.towards)
            if not isinstance(self._place, AtPost):
                self._forget_foreign()
            if isinstance(before, Between) and before.meant == post.text:
                self._was_right()
        elif self._is_strange(post, view.post_odometry, at_mm):
            self._doubt(post.text, view.post_odometry, at_mm)

    def _was_right(self) -> None:
        """It is in the corridor that it was granted, though the compass had it elsewhere."""
        if isinstance(self._place, Between):
            self._look_along(self._place.corridor.heading_leaving(self._place.here))
            self._compass.set(None, self._odometry)
            self._head_for(self._place.towards)

    def _is_strange(self, post: Sighting, odometry: Odometry, at_mm: float) -> bool:
        own = is_own(self._place, post.text, odometry.ahead_mm, at_mm)
        return not own and hangs_beside_this_line(self.campus, post)

    def _doubt(self, post: str, odometry: Odometry, at_mm: float) -> None:
        """A marker that cannot be here: a stranger's, or the robot has been carried. A second one decides."""
        first, second = self._foreign, Foreign(post, odometry.travelled_mm, at_mm)
        if first and agree(self.campus, first, second):
            self._find(post, odometry, at_mm)
            return
        self._foreign = second
        reason = f"A marker of {post} was read where it cannot be. The robot does not believe it."
        self._duties.report_fault(FOREIGN_MARKER, reason, self.here)

    def _post_at_mm(self, post: Sighting, odometry: Odometry) -> float | None:
        """Odometry's reading with the axle on that post."""
        place = self._place
        origin = place.behind if isinstance(place, Between) else place.here
        corridor = corridor_between(self.campus, post.text, origin) if origin else None
        facing_rad = corridor.heading_arriving(post.text) if corridor else self._looks_rad(odometry)
        ahead_mm = post_ahead_mm(self.campus, post, facing_rad)
        return None if ahead_mm is None else odometry.ahead_mm + ahead_mm

    def _forget_foreign(self) -> None:
        self._foreign = None
        self._duties.report_fault(FOREIGN_MARKER, "The robot knows where it is.", self.here, cleared=True)

    def _find(self, post: str, odometry: Odometry, at_mm: float) -> None:
        """It was not known where it is, or it is elsewhere: it was moved, out of whatever corridor it held."""
        place, looks_rad = self._place, self._looks_rad(odometry)
        unknown = isinstance(place, Unknown)
        put_back = isinstance(place, Unknown) and post in place.was
        self._place = marked(self.campus, place if unknown else Unknown(), post, at_mm, odometry.ahead_mm)
        self._facing = Facing.of(facing_by(self.campus, post, None if unknown else looks_rad), odometry)
        self._compass.set(None, odometry)
        self._forget_foreign()
        if not put_back:
            self._note_moment(Moment.LIFTED)
        if not put_back and not (isinstance(place, Unknown) and not place.lifted):
            self.moved = post
            self.crossed = ()
            self._duties.claims.clear(self._duties.held.grants)

    # Way driven.

    def _roll(self, view: View) -> None:
        now_mm = self._odometry.ahead_mm
        match self._place:
            case AtPost() if view.motion in AT_THE_POST:
                self._place = searched(self._place, now_mm)
            case AtPost() if has_left(self._place, now_mm):
                self._set_out()
            case Coming(at_mm=at_mm) | Between(ahead_mm=float() as at_mm) if has_reached(self._place, now_mm):
                self._arrive_along(at_mm, by_marker=self.sighted is not None)
        self._note_nearing()

    def _note_nearing(self) -> None:
        """Written down once the marker ahead is read, or should have been: a base that is left alone rolls on. Before
        that the marker is still to come, and a robot that starts again may drive on to it."""
        place = self._place
        if not isinstance(place, Between) or self._moment is Moment.NEARING:
            return
        is_near = place.ahead_mm is not None and place.ahead_mm - self._odometry.ahead_mm < UNREAD_MM
        if place.by_marker or (is_near and self._moment is not Moment.BLIND):
            self._note_moment(Moment.NEARING)

    def _note_moment(self, moment: Moment) -> None:
        self._moment = moment
        self._duties.note_moment(moment)

    def _note_seen(self, post: str) -> None:
        """It stands at this post; what was under way, if anything, has ended where it should. One that has come back to
        it does not look as it did when it came there first: then the way it looks is kept as in a turn."""
        looks_rad = self._looks_rad(self._odometry)
        as_arrived = looks_as_arrived(self.campus, self._duties.held.position, post, looks_rad)
        self._moment = None if as_arrived else Moment.TURNING
        begun = None if as_arrived else self._turning.begun(looks_rad)
        self._duties.seen(post, self._moment, Turned(begun))

    def _check_way(self) -> None:
        """Check that it follows the line that it was going to."""
        place, looks_rad = self._place, self._compass.looks_rad(self._odometry)
        if not isinstance(place, Between) or place.begin_mm is None or place.turned_round or looks_rad is None:
            return
        if not FROM_MM < self._odometry.ahead_mm - place.begin_mm < TO_MM:
            return
        really = really_towards(self.campus, place.here, place.towards, looks_rad)
        corridor = corridor_between(self.campus, place.here, really) if really else None
        if corridor:
            self._place = gone_astray(place, corridor, self._counted_m(corridor.length_m))
            self._look_along(corridor.heading_leaving(place.here))
            self._head_for(really)

    def _counted_m(self, length_m: float) -> float:
        return length_m / self._scale.real_per_counted

    def _arrive_along(self, at_mm: float, by_marker: bool) -> None:
        """It has come to the post ahead."""
        place, now_mm = self._place, self._odometry.ahead_mm
        corridor = place.corridor if isinstance(place, Between) else None
        if place.towards is None:
            return
        arrived = AtPost(place.towards, at_mm, now_mm, corridor, by_marker)
        looks_rad = self._looks_rad(self._odometry)
        if corridor and not (arrived.here == place.here and looks_otherwise(corridor, arrived.here, looks_rad)):
            self._facing = Facing.of(corridor.heading_arriving(arrived.here), self._odometry)
        self._arrive(arrived)

    def _arrive(self, arrived: AtPost) -> None:
        before, self._place, post = self._place, arrived, arrived.here
        self._learn_scale(arrived, before)
        self._compass.set(self._looks_rad(self._odometry), self._odometry)
        if self._foreign:
            self._forget_foreign()
        self._note_seen(post)
        # Where it turned back is not given back here: it may want to go in again (decision 0022).
        if before.here is not None and before.here != post:
            self.crossed += (Leg(from_post=before.here, to_post=post),)
            self.give_back_crossed()
        if self.visited[-1:] != [post]:
            self.visited.append(post)
            self.arrivals += 1
            del self.visited[:-KEPT_POSTS]

    def give_back_crossed(self) -> None:
        """Let others into the corridors behind it, at a post. Without network it keeps them: they may be its only way.
        Not to be called between a claim and the corridor that it was for: that may be one of them."""
        if self.at is None or not self._duties.online:
            return
        held, crossed = self._duties.held.grants, self.crossed
        over = {*crossed, *behind(held, self.at, crossed[-1] if crossed else None)}
        self.crossed = ()
        if left := [leg for leg in held if leg in over]:
            self._duties.claims.clear(left)

    def _learn_scale(self, arrived: AtPost, before: Place) -> None:
        straight = isinstance(before, Between) and not before.turned_round and arrived.here not in self.unread
        length_m = before.corridor.length_m if isinstance(before, Between) and straight else None
        self._scale.arrive(arrived.at_mm, length_m, self._disturbed)

    def _set_out(self) -> None:
        place = self._place
        if not isinstance(place, AtPost):
            return
        self._set_out_disturbed = self._disturbed
        self._scale.set_out(place.at_mm if place.here not in self.unread else None, self._disturbed)
        corridor = self._corridor_ahead()
        self._place = set_out(place, corridor, self._counted_m(corridor.length_m) if corridor else 0.0)
        self._head_for(self._place.towards, None if corridor else Moment.LEAVING)

    def _head_for(self, towards: str | None, moment: Moment | None = None) -> None:
        self._moment, place = moment, self._place
        back_from = place.far if isinstance(place, Between) and place.turned_round else None
        begun = self._turning.begun(self._looks_rad(self._odometry)) if moment is Moment.TURNING else None
        self._duties.heading_for(towards, moment, Turned(begun, back_from))

    def _corridor_ahead(self) -> Corridor | None:
        """The one that the robot looks along."""
        here, looks_rad = self.at, self._looks_rad(self._odometry)
        return None if here is None or looks_rad is None else corridor_ahead(self.campus, here, looks_rad)

    def _turn_to(self, neighbour: str) -> float | None:
        """None while the way it looks is not known."""
        looks_rad = self._looks_rad(self._odometry)
        if looks_rad is None or self.here is None:
            return None
        return turn_towards_rad(self.campus, looks_rad, self.here, neighbour)

    def _looks_rad(self, odometry: Odometry) -> float | None:
        return self._facing.now_rad(odometry) if self._facing else None

    def _look_along(self, heading_rad: float) -> None:
        self._facing = Facing.of(heading_rad, self._odometry)
        self._compass.confirm(heading_rad, self._odometry)
