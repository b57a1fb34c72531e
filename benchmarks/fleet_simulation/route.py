"""The way that a robot goes, and the spurs and corridors that it asks for: what `robot.agent` does, with a simulated
body (on a robot: `robot/agent/actions/corridors.py`, `Navigator` and `Tracker`)."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from enum import Enum, auto
from itertools import pairwise

from benchmarks.fleet_simulation.body import Body
from maps import CampusMap, NoRoute, corridor_name, shortest_route
from protocol.parts import Leg
from robot.localization.bays import bay_for, places_to_stand
from robot.localization.detour import detour_from, place_aside
from robot.localization.granted import behind
from robot.mission.mission import MissionManager


class Crossing(Enum):
    """Of a robot that waits before a crossing."""

    MAY = auto()
    WAITS = auto()
    TURNS_BACK = auto()


@dataclass
class Route:
    """`crossed`: ways that it has come through and not given back, since the service cannot hear of it. `unasked`: it
    waits for no permission."""

    track: CampusMap
    body: Body
    missions: MissionManager
    unasked: bool = False
    crossed: list[Leg] = field(default_factory=list)
    _claim: str | None = None
    _stops_ahead: bool = False
    """The way on was denied: it asks for a bay at the post ahead."""

    # Asking.

    def next_leg(self, goal: str) -> Leg | None:
        """The spur or corridor that it may enter now on its way to `goal`; None: it waits. Raises NoRoute."""
        claims = self.missions.claims
        way = self._way(goal)
        first = way[: 2 if self.is_in_bay else 1]
        self._give_back(way)
        detour = self.detour
        if detour is None and not claims.may_enter(first):
            self._claim = claims.ask(way, goal) or self._claim
        self._give_back(way)
        if detour is not None:
            return detour if detour.from_post == self.body.at else way[0]
        return first[0] if self.unasked or claims.may_enter(first) else None

    @property
    def is_in_bay(self) -> bool:
        return self.body.at is not None and self.track.post(self.body.at).bay_of is not None

    @property
    def detour(self) -> Leg | None:
        """Where the service sends it from here."""
        return detour_from(self.track, self.missions.held.detour, self.body.at, self._waits_before)

    @property
    def stops_aside(self) -> str | None:
        """Where it has to stand there first."""
        return place_aside(self.track, self.detour)

    @property
    def _waits_before(self) -> str | None:
        return self.body.corridor.to_post if self.body.corridor else None

    def out_of_silence(self) -> bool:
        """Where no answer comes any more it goes on by a corridor that it holds, if it does."""
        held = self.missions.held.grants
        unused = [leg for leg in held if leg.from_post == self.body.at and leg not in self.crossed]
        if unused and not self.is_in_bay:
            self.missions.claims.turn_aside(unused[0])
        return bool(unused)

    def is_denied(self) -> bool:
        """Whether what it asked for last was refused; told once."""
        denied = self._claim is not None and self.missions.claims.denial(self._claim) is not None
        if denied:
            self._claim = None
        return denied

    def asks_anywhere(self) -> None:
        """What was denied may be open by now."""
        self.missions.claims.avoid = frozenset()

    def release(self) -> None:
        """It goes nowhere: others may."""
        self.missions.claims.withdraw()
        inside = self.body.lane
        self.missions.claims.clear([leg for leg in self.missions.held.grants if not _same(leg, inside)])

    # Before a crossing.

    def ask_ahead(self, goal: str) -> None:
        """Some metres before it: for what comes after it."""
        if not self.may_cross:
            with suppress(NoRoute):
                self._claim = self.missions.claims.ask(self._legs(goal), goal) or self._claim

    def waits_to_cross(self, goal: str) -> Crossing:
        """Where it may go no further without permission. Raises NoRoute."""
        if self.may_cross:
            self._stops_ahead = False
            return Crossing.MAY
        claims = self.missions.claims
        denial = claims.denial(self._claim) if self._claim else None
        if denial is not None and self._as_granted in denial.avoid:
            return Crossing.TURNS_BACK
        self._stops_ahead = self._stops_ahead or denial is not None
        goal = (self._waits_before or goal) if self._stops_ahead else goal
        self._claim = claims.ask(self._legs(goal), goal) or self._claim
        return Crossing.WAITS

    @property
    def may_cross(self) -> bool:
        corridor = self.body.corridor
        if corridor is None or self.unasked:
            return True
        return self.missions.claims.may_leave(corridor.to_post, but_to=corridor.from_post)

    @property
    def _as_granted(self) -> Leg | None:
        corridor = self.body.corridor
        if corridor is None or not self.body.turned:
            return corridor
        return Leg(from_post=corridor.to_post, to_post=corridor.from_post)

    # Ways.

    def _way(self, goal: str) -> tuple[Leg, ...]:
        """To the goal, the rest of its mission and home."""
        held = self.missions.held
        later = [stop.post for stop in (held.mission.stops if held.mission else ())[held.next_stop :]]
        home = [held.home] if held.home else []
        try:
            return self._legs(goal, *(later if later[:1] == [goal] else []), *home)
        except NoRoute:
            return self._legs(goal)

    def _legs(self, *posts: str) -> tuple[Leg, ...]:
        avoided = frozenset(corridor_name(leg.from_post, leg.to_post) for leg in self.missions.claims.avoid)
        way = [self._waits_before or self.body.post]
        for post in posts:
            if way[-1] not in places_to_stand(self.track, post):
                way += shortest_route(self.track, way[-1], self._bay_for(post, avoided), avoided).posts[1:]
        return tuple(Leg(from_post=a, to_post=b) for a, b in pairwise(way))

    def _bay_for(self, post: str, avoided: frozenset[str]) -> str:
        held = self.missions.held
        return bay_for(self.track, post, held.home, held.grants, avoided)

    # Giving back.

    def came_through(self, leg: Leg, *, turned: bool) -> None:
        """It has come to the end of a spur or corridor."""
        self.missions.seen(leg.to_post)
        if not turned:
            self.crossed.append(leg)
            self.give_back_crossed()
        self.tells_place()

    def tells_place(self) -> None:
        """What it is wholly in; told once."""
        corridor = self.body.corridor
        if corridor is not None and self.body.is_wholly_inside:
            evidence = ("marker", None) if self.body.turned else ("distance", 450)
            self.missions.occupies("corridor", corridor.from_post, corridor.to_post, *evidence)
        elif (at := self.body.at) is not None:
            self.missions.occupies("bay" if self.is_in_bay else "crossing", at, None, "marker", None)

    def give_back_crossed(self) -> None:
        """Let others into what lies behind it. Without network it keeps that: it may be its only way."""
        here = self.body.at
        if here is None or not self.missions.online:
            return
        held = self.missions.held.grants
        over = {*self.crossed, *behind(held, here, self.crossed[-1] if self.crossed else None)}
        self.crossed = []
        if left := [leg for leg in held if leg in over]:
            self.missions.claims.clear(left)

    def was_moved(self, place: str) -> None:
        """A person has put it down here, and it has read where that is."""
        self.missions.occupancy.forget()
        self.missions.seen(place)
        self.crossed = []
        self.missions.claims.clear(self.missions.held.grants)
        self.tells_place()

    def _give_back(self, way: Sequence[Leg]) -> None:
        if self.body.at is None or not self.missions.online:
            return
        kept = (*way[: 2 if self.is_in_bay else 1], *self._granted_ahead(way), self.detour)
        self.missions.claims.clear([leg for leg in self.missions.held.grants if leg not in kept])

    def _granted_ahead(self, way: Sequence[Leg]) -> Sequence[Leg]:
        granted, end, ahead = self.missions.held.grants, self.body.at, list[Leg]()
        for leg in way:
            if leg not in granted or leg.from_post != end:
                break
            end = leg.to_post
            ahead.append(leg)
        return ahead


def _same(leg: Leg, other: Leg | None) -> bool:
    return other is not None and {leg.from_post, leg.to_post} == {other.from_post, other.to_post}
