"""The way that a robot goes, and the corridors that it asks for: what `robot.agent` does, with a simulated body.

All that knows of corridors between posts is in here (on a robot: `robot/agent/actions/corridors.py` and `Tracker`).
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise, takewhile
from random import Random

from benchmarks.fleet_simulation.body import Body
from maps import CampusMap, NoRoute, corridor_name, shortest_route
from protocol.parts import Leg
from robot.localization.granted import behind
from robot.mission.mission import MissionManager


@dataclass
class Route:
    """`crossed`: corridors that it has come through and not given back, since the service cannot hear of it."""

    campus: CampusMap
    body: Body
    missions: MissionManager
    home: str | None
    rng: Random
    crossed: list[Leg] = field(default_factory=list)
    _claim: str | None = None

    # Asking.

    def next_leg(self, goal: str) -> Leg | None:
        """The corridor that it may enter now on its way to `goal`; None: it waits. Raises NoRoute."""
        claims = self.missions.claims
        way = self._way(goal)
        first = self._first(way)
        self._give_back(first, way)
        if (leg := self.detour) is not None:
            return leg
        self._claim = claims.ask((*first, *way), goal) or self._claim
        self._give_back(first, way)
        return self._chosen(first) if claims.may_enter(first) else None

    @property
    def detour(self) -> Leg | None:
        """The corridor from here that the service sends it through first."""
        leg = self.missions.held.detour
        return leg if leg is not None and leg.from_post == self.body.at else None

    def out_of_silence(self) -> bool:
        """Where no answer comes any more it goes on by a corridor that it holds, if it does."""
        held = self.missions.held.grants
        unused = [leg for leg in held if leg.from_post == self.body.at and leg not in self.crossed]
        if unused:
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

    def _way(self, goal: str) -> tuple[Leg, ...]:
        """To the goal, the rest of its mission and home."""
        held = self.missions.held
        later = [stop.post for stop in (held.mission.stops if held.mission else ())[held.next_stop :]]
        home = [self.home] if self.home else []
        try:
            return self._legs(goal, *(later if later[:1] == [goal] else []), *home)
        except NoRoute:
            return self._legs(goal)

    def _legs(self, *posts: str) -> tuple[Leg, ...]:
        avoided = {corridor_name(leg.from_post, leg.to_post) for leg in self.missions.claims.avoid}
        way = [self.body.post]
        for post in posts:
            way += shortest_route(self.campus, way[-1], post, avoided).posts[1:]
        return tuple(Leg(from_post=a, to_post=b) for a, b in pairwise(way))

    def _first(self, way: Sequence[Leg]) -> tuple[Leg, ...]:
        """Every corridor here, if it does not know which way it looks."""
        if self.body.looks or not way:
            return tuple(way[:1])
        here = self.body.post
        return tuple(Leg(from_post=here, to_post=post.name) for post, _ in self.campus.neighbours(here))

    def _chosen(self, first: Sequence[Leg]) -> Leg | None:
        """Where it does not know which way it looks, it goes the way that it looks."""
        return None if not first else first[0] if len(first) == 1 else self.rng.choice(first)

    # Giving back.

    def came_through(self, leg: Leg) -> None:
        """It has come to the post at the end of a corridor."""
        self.missions.seen(leg.to_post)
        self.crossed.append(leg)
        self.give_back_crossed()

    def give_back_crossed(self) -> None:
        """Let others into the corridors behind it. Without network it keeps them: they may be its only way."""
        here = self.body.at
        if here is None or not self.missions.online:
            return
        held = self.missions.held.grants
        over = {*self.crossed, *behind(held, here, self.crossed[-1] if self.crossed else None)}
        self.crossed = []
        if left := [leg for leg in held if leg in over]:
            self.missions.claims.clear(left)

    def was_moved(self, post: str) -> None:
        """A person has put it down here, and it has read where that is."""
        self.missions.seen(post)
        self.crossed = []
        self.missions.claims.clear(self.missions.held.grants)

    def _give_back(self, first: Sequence[Leg], way: Sequence[Leg]) -> None:
        if self.body.at is None or not self.missions.online:
            return
        kept = (*first, *self._granted_ahead(way), self.detour)
        self.missions.claims.clear([leg for leg in self.missions.held.grants if leg not in kept])

    def _granted_ahead(self, way: Sequence[Leg]) -> tuple[Leg, ...]:
        granted = self.missions.held.grants
        return tuple(takewhile(lambda leg: leg in granted, way))


def _same(leg: Leg, other: Leg | None) -> bool:
    return other is not None and {leg.from_post, leg.to_post} == {other.from_post, other.to_post}
