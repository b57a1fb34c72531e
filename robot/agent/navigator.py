"""Where the robot is and where it goes, for actions and percepts: what they ask, and what they tell.

Keeping track of the place is `Tracker`'s.
"""

import math
from contextlib import suppress
from functools import partial
from itertools import pairwise

from maps import CampusMap, NoRoute, corridor_name, shortest_route
from maps.geometry import wrapped
from protocol.parts import Leg
from robot.agent.tracking import Tracker
from robot.drivers.interfaces import BodyShape
from robot.localization.bays import bay_for, places_to_stand
from robot.localization.closed import Closed, open_way
from robot.localization.detour import detour_from, place_aside
from robot.localization.directions import PLAIN_TURNS, Way, kept_from, next_post, sector
from robot.localization.docks import nearest_dock, way_out
from robot.localization.expected import SHARE, wrong_corridor
from robot.localization.place import AtPost, Between, Coming, Facing, Leaving, Unknown
from robot.localization.remembering import Moment, may_look_back_mm
from robot.localization.steps import gone_astray, marked, turned_round
from robot.mission.mission import MissionManager
from robot.skills.interfaces import View

RESTS_MM = 25.0
"""A pulse or two of the paper's `drive`. Its program does not look at the line as long as it perceives a post."""
STRAIGHT_RAD = math.radians(12)
"""Within this the line is under the diodes, and following it straightens the robot up."""
SURELY_PAST_M = 0.3
ASKS_BEFORE_MM = 2000.0
"""Some ten seconds before it is at the waiting point."""


class Navigator(Tracker):
    """Place and destination. Told by actions what they are about to do, and by the body what it sees."""

    def __init__(
        self, campus: CampusMap, home: str | None, missions: MissionManager, now: float, shape: BodyShape | None = None
    ) -> None:
        super().__init__(campus, home, missions, now, shape or BodyShape())
        self.destination: str | None = None
        self.closed = Closed(missions.closed_ages_s(), missions.keep_closed, now)
        missions.open_way = partial(open_way, campus, self.closed)
        self._nearest: tuple[object, str | None] = ((), home)  # asked ten times a second, answered once per post

    def look(self, view: View) -> None:
        """Take in what the body sees now."""
        self.closed.pass_time(view.at_s)
        super().look(view)

    # What actions and percepts ask.

    @property
    def rests_at(self) -> str | None:
        """The post, as long as the robot has not rolled on from where it reached it."""
        place = self._place
        rests = isinstance(place, AtPost) and abs(self._odometry.ahead_mm - place.since_mm) <= RESTS_MM
        return self.at if rests else None

    @property
    def is_known(self) -> bool:
        """Return whether anything has told where it is, since it was last lifted or taken away."""
        return not isinstance(self._place, Unknown)

    @property
    def astray(self) -> str | None:
        """The post that it drives towards by mistake, until it has turned round."""
        return self.towards if isinstance(self._place, Between) and self._place.astray else None

    @property
    def doubted(self) -> str | None:
        """The post just before which it was switched off, or turned back to it, while it may have passed it or its
        marker; where it was switched off in a turn, until its base is heard; and the crossing where it looks anywhere,
        if it has a service: each line may be another robot's there."""
        place = self._place
        looks_anywhere = self.crossing and self._facing is None and not self._duties.claims.alone
        if self.at and (self._turning.not_yet_known or looks_anywhere):
            return self.at
        in_doubt = isinstance(place, Between | Leaving) and place.doubted
        return (place.towards or place.here) if in_doubt else None

    @property
    def goes_by_length(self) -> bool:
        """Return whether no marker may come before the post ahead: it is where the map says."""
        return self.towards in self.unread or (isinstance(self._place, Between) and self._place.blind)

    @property
    def looks_anywhere(self) -> bool:
        """Return whether it may look any way: it was switched off at a post in a turn, or in a search for the line."""
        place = self._place
        if isinstance(place, Between):
            return place.begin_mm is None and place.ahead_mm is None
        return self._facing is None and isinstance(place, AtPost | Leaving)

    @property
    def beside_dock(self) -> bool:
        """Return whether it was switched off on its way into a dock or out of it, and has not left its post since."""
        place = self._place
        interrupted = self._moment is Moment.DOCKING and self._facing is None
        return interrupted and isinstance(place, AtPost) and not place.docked

    @property
    def look_back_mm(self) -> float:
        """Return how far it may go back in search of a marker."""
        return may_look_back_mm(self._place)

    def reached_after(self, arrivals: int) -> list[str]:
        """The posts reached after so many others; of very many the newest."""
        new = self.arrivals - arrivals
        return self.visited[-new:] if new else []

    def way(self) -> Way | None:
        """The way from here to the destination; None between posts, and where no way leads. As long as the way it looks
        is not known the word is `forward`: the next post will tell."""
        if self.destination is None or self.at is None:
            return None
        if self.at in places_to_stand(self.campus, self.destination):
            return Way.ARRIVED
        towards = self._next_post()
        turn_rad = self._turn_to(towards) if towards else None
        return None if towards is None else Way.FORWARD if turn_rad is None else sector(turn_rad)

    @property
    def detour(self) -> Leg | None:
        """The corridor from here that it has to take first, unless it knows that to be closed."""
        return detour_from(self.campus, self._duties.held.detour, self.at, self.waits_before, self.closed.names)

    @property
    def stops_aside(self) -> str | None:
        """The place to which that leads, if it has to stand there first."""
        return place_aside(self.campus, self.detour)

    def _not_next(self) -> frozenset[str]:
        """Return the corridors to avoid here: all that does not lead straight to where the service sends it first."""
        return kept_from(self.campus, self._duties.held.detour, self.at, self.destination, self._avoided())

    def _avoided(self) -> frozenset[str]:
        return self.closed.names | {corridor_name(leg.from_post, leg.to_post) for leg in self._duties.claims.avoid}

    @property
    def corridor(self) -> Leg | None:
        """The corridor that the robot is in, in the direction in which it was granted; None at a post."""
        place = self._place
        return Leg(from_post=place.here, to_post=place.far) if isinstance(place, Between) else None

    @property
    def goes_deeper(self) -> Leg | None:
        """The corridor into which it goes on, having come in since it was switched on; None: it goes back, or may."""
        place = self._place
        goes_back = not isinstance(place, Between) or place.turned_round or place.begin_mm is None
        return None if goes_back else self.corridor

    @property
    def came_from(self) -> str | None:
        """The post that lies behind it; None where it may look either way."""
        match self._place:
            case Between(begin_mm=None):
                return None
            case Between(behind=post):
                return post
        return self.here

    @property
    def reserves_from(self) -> str | None:
        """The place from which it needs corridors: where it stands, or before which it waits."""
        return self.waits_before or self.here

    @property
    def waits_before(self) -> str | None:
        """The post with bays ahead of it in its corridor: what comes after that is what it asks for."""
        place = self._place
        ahead = place.towards if isinstance(place, Between | Coming) else None
        return ahead if ahead and self.campus.bays_of(ahead) else None

    @property
    def nears_a_crossing(self) -> bool:
        """Return whether a crossing may come so soon that it has to ask for it now: asked for earlier, it would be kept
        from others for longer."""
        place = self._place
        if self.waits_before is None or not isinstance(place, Between | Coming):
            return False
        at_mm = place.at_mm if isinstance(place, Coming) else place.ahead_mm
        doubt_mm = SHARE * 1000 * place.corridor.length_m if isinstance(place, Between) else 0.0
        return at_mm is None or at_mm - self._odometry.ahead_mm < ASKS_BEFORE_MM + doubt_mm

    def may_cross(self) -> bool:
        """Return whether it may go on over the post ahead: into a corridor or a bay there. Any thread may ask."""
        ahead, place = self.waits_before, self._place
        behind = place.behind if isinstance(place, Between) else None
        return ahead is None or self._duties.claims.may_leave(ahead, but_to=behind)

    @property
    def crossing(self) -> str | None:
        """The post with bays on which it stands, where others drive."""
        return self.at if self.at and self.campus.bays_of(self.at) else None

    @property
    def asks_ahead_later(self) -> bool:
        """Return whether it stands at a post with bays: for what comes after its next corridor it asks in there."""
        return self.at is not None and bool(self.campus.bays_of(self.campus.address_of(self.at)))

    @property
    def comes_out_of_a_bay(self) -> bool:
        """Return whether it stands at a post that it came to from one of its bays: it has not come from elsewhere."""
        place = self._place
        spur = place.came_by if isinstance(place, AtPost) else None
        return spur is not None and self.campus.post(spur.b).bay_of is not None

    def bay_for(self, post: str) -> str:
        """The place where it stands for a post."""
        if self.at in places_to_stand(self.campus, post):
            return self.at or post
        return bay_for(self.campus, post, self.home, self._duties.held.grants, self._avoided())

    def legs_to(self, *posts: str) -> tuple[Leg, ...]:
        """The corridors from here to where it stands for each of these posts in turn. Raises NoRoute."""
        way: list[str] = [self.reserves_from] if self.reserves_from else []
        for post in posts if way else ():
            if way[-1] not in places_to_stand(self.campus, post):
                way += shortest_route(self.campus, way[-1], self.bay_for(post), self._avoided()).posts[1:]
        return tuple(Leg(from_post=a, to_post=b) for a, b in pairwise(way))

    def first_legs(self, goal: str) -> tuple[Leg, ...]:
        """The corridors that it may be in next on the way to a post: every one here while it does not know which way it
        looks. All markers of a post carry the same text, so after a lift only the next post tells. Out of a bay it goes
        only together with what comes after the crossing. Raises NoRoute."""
        legs = self.legs_to(goal)
        if legs and self.campus.post(legs[0].from_post).bay_of:
            return legs[:2]
        first = legs[:1]
        if not first or self._facing is not None or self.at is None:
            return first
        here = first[0].from_post
        return tuple(Leg(from_post=here, to_post=post.name) for post, _ in self.campus.neighbours(here))

    def turn_rad(self, way: str) -> float:
        """Return the angle to turn, left is positive: to the corridor of the destination if that lies there, else a
        quarter.

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
        """Return the angle to turn to look along the corridor that its way takes; 0 if it does, or if none is known."""
        towards = self._next_post()
        turn_rad = self._turn_to(towards) if towards else None
        return turn_rad if turn_rad is not None and abs(turn_rad) > STRAIGHT_RAD else 0.0

    def lines_ahead(self, within_rad: float) -> int:
        """Return how many lines lead away from its post within this angle of the way it looks."""
        turns = [self._turn_to(post.name) for post, _ in (self.campus.neighbours(self.here) if self.here else ())]
        return sum(turn_rad is not None and abs(turn_rad) < within_rad for turn_rad in turns)

    def _next_post(self) -> str | None:
        aside = self.detour
        if aside is not None and aside.from_post == self.at and self.stops_aside is None:
            return aside.to_post
        with suppress(NoRoute):
            if self.destination is not None and self.at is not None:
                return next_post(self.campus, self.at, self.bay_for(self.destination), self._not_next())
        return None

    @property
    def ahead_m(self) -> float:
        """The length of the corridor it is in or about to enter; of the longest one while that is not known."""
        if isinstance(self._place, Between):
            return self._place.corridor.length_m
        return max((corridor.length_m for corridor in self.campus.corridors), default=0.0)

    @property
    def way_left_mm(self) -> float | None:
        """To the end of the corridor, by the map and by odometry; None where it is not known or long past."""
        place = self._place
        if not isinstance(place, Between) or place.ahead_mm is None or place.by_marker:
            return None
        left_mm = place.ahead_mm - self._odometry.ahead_mm
        return left_mm if left_mm > -1000 * SURELY_PAST_M else None

    def nearest_dock(self) -> str | None:
        """Of its own dock and those that are lent the one with the shortest way that is open; its own home while the
        place is unknown."""
        asked = (self.here, self.home, self._duties.claims.avoid, self.closed.names)
        if asked != self._nearest[0]:
            near = nearest_dock(self.campus, self.here, self.home, self._avoided()) if self.here else self.home
            self._nearest = (asked, near)
        return self._nearest[1]

    # What actions and people tell.

    def leave(self) -> None:
        """The robot is about to follow the line away from its post."""
        self._set_out()

    def begin_turn(self) -> None:
        """At a post: after a power cut in the middle of a turn it may look anywhere."""
        if isinstance(self._place, AtPost):
            self._head_for(self._next_post(), Moment.TURNING)

    def begin_docking(self) -> None:
        """Into the dock or out of it: in between it stands beside the line, and looks anywhere."""
        if isinstance(self._place, AtPost):
            self._note_moment(Moment.DOCKING)

    def turned(self) -> None:
        """A turn has ended on the line: what was left of odometry's error is forgotten."""
        place = self._place
        if isinstance(place, Between):
            self._place = turned_round(self._after_a_miss(place), self._odometry.ahead_mm)
            self._head_for(self._place.towards, Moment.BLIND if self._place.blind else None)
            return
        corridor = self._corridor_ahead()
        if corridor and place.here:
            self._look_along(corridor.heading_leaving(place.here))
            self._head_for(corridor.other(place.here))

    def _after_a_miss(self, place: Between) -> Between:
        """It turns back after a foreign marker, and the one that was expected has not come."""
        missed = place.ahead_mm is not None and self._odometry.ahead_mm > place.ahead_mm
        if not missed or not self._foreign or place.by_marker:
            return place
        corridor = wrong_corridor(self.campus, place, self._foreign, self._scale.real_per_counted)
        return gone_astray(place, corridor, self._counted_m(corridor.length_m)) if corridor else place

    def noted_move(self) -> None:
        """The agent knows that it was moved."""
        self.moved = None

    def reached(self, post: str | None, unread: bool = False) -> None:
        """follow_line has stopped there: the body has the last word. `unread`: by the length of the way alone."""
        if post is None:
            return
        # Back at the post that it left it may have turned round beyond the marker.
        if not (isinstance(self._place, Between) and self._place.turned_round):
            self.unread.note(post, unread)
        place, now_mm = self._place, self._odometry.ahead_mm
        if self.at == post:
            return
        by_marker = not unread and isinstance(place, Between) and place.by_marker
        if place.towards != post:
            self._place = marked(self.campus, place, post, now_mm, now_mm)
        if self._place.towards == post:
            self._arrive_along(now_mm, by_marker)

    def undock_way(self) -> tuple[float | None, bool]:
        """From the dock that it stands in to the post, in mm, and whether the line that it takes leads straight on."""
        return way_out(self.campus, self.here, self._next_post())

    def undocked(self) -> None:
        """The robot stands at the dock's post and looks away from the dock: along the line, or as far as it turned."""
        dock = self.campus.post(self.here).dock if self.here else None
        if dock and self.here:
            away_rad, now_mm = dock.heading_rad + math.pi, self._odometry.ahead_mm
            looks_rad = self._looks_rad(self._odometry)
            if looks_rad is None or abs(wrapped(looks_rad - away_rad)) < STRAIGHT_RAD:
                self._look_along(away_rad)
            self._place = AtPost(self.here, now_mm, now_mm)
            self._head_for(self._next_post(), Moment.TURNING)

    def place(self, post: str, towards: str | None) -> None:
        """A person has put the robot down at a post, looking along a corridor. Raises UnknownPost, UnknownCorridor."""
        facing_rad = self.campus.corridor(post, towards).heading_leaving(post) if towards else None
        now_mm = self._odometry.ahead_mm
        self.campus.post(post)
        self._place, self._facing = Unknown(), Facing.of(facing_rad, self._odometry)
        self._arrive(AtPost(post, now_mm, now_mm))
