"""Keeps the schedule in step with what the database knows, and says which claims it grants.

In memory, and made anew from one look at the database whenever there is none: after a start of the service, and after
anything went wrong.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from random import Random
from typing import Final

import structlog

from app.core.settings import Settings
from app.traffic.snapshot import OF_ITS_OWN, Hold, RobotLocation, Stop, TrafficSnapshot
from fleet.charging.curve import ASSUMED
from fleet.eta.arrivals import Estimates
from fleet.schedule.answers import ComeIn, Denied, Granted, Waits
from fleet.schedule.controller import TrafficController
from fleet.schedule.journey import Goal
from fleet.schedule.network import Lane, Network, network_of
from maps import CampusMap, CampusMapError, Corridor, Post, corridor_name, shortest_route

log = structlog.get_logger(__name__)
ASSUMED_CROSSING_S: Final = 15.0
"""From a bay or a corridor over the crossing until the robot is wholly in what follows: what robots took in the
simulated world with spurs of a metre, and a little more."""
CHARGES_S: Final = 1800.0
"""Less than a charge takes, and more than a hand-over."""
Leg = tuple[str, str]
"""From which post to which."""


@dataclass(frozen=True)
class MayEnter:
    """These corridors are this robot's now. `aside`: not the way that it asked for, but so that these can pass."""

    robot: str
    legs: tuple[Leg, ...]
    aside: bool = False


@dataclass(frozen=True)
class HasToWait:
    """For this corridor, for these robots. `in_turn`: until they have gone on, about `for_s` from now; `closed`: until
    it is opened."""

    robot: str
    leg: Leg
    robots: tuple[str, ...]
    in_turn: bool = False
    for_s: float | None = None
    closed: bool = False


@dataclass(frozen=True)
class Elsewhere:
    """The robot cannot be told which way to go instead; it has to find another one by itself."""

    robot: str
    leg: Leg


Verdict = MayEnter | HasToWait | Elsewhere


@dataclass
class TrafficSchedule:
    """One for a campus. `vanished`: robots that were not heard of for long; they count as standing.
    `estimates`: how long corridors took, as it was known when this was made; without them lengths decide. `rng`: the
    caller's, who makes this anew and goes on with it."""

    campus: CampusMap
    settings: Settings
    vanished: frozenset[str] = frozenset()
    estimates: Estimates | None = None
    rng: Random = field(default_factory=lambda: Random(0))
    controller: TrafficController = field(init=False)
    track: CampusMap = field(init=False)
    _known: dict[str, RobotLocation] = field(default_factory=dict)
    _frozen: set[str] = field(default_factory=set)
    _closed: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        self.track = self.campus.track
        self.controller = TrafficController(network_for(self.campus, self.settings, self.estimates), self.rng)

    @property
    def known(self) -> Mapping[str, RobotLocation]:
        """Every robot as it was told last."""
        return self._known

    # What has happened.

    def follow(self, snapshot: TrafficSnapshot, left_at: Mapping[int, str], now_s: float) -> None:
        """Take over everything that has changed since the last picture."""
        self._follow_closed(snapshot, now_s)
        for name in self._known.keys() - snapshot.robots.keys():
            self.controller.leaves(name, now_s)
            self._frozen.discard(name)
            del self._known[name]
        for name, one in snapshot.robots.items():
            before = self._known.get(name)
            now = _on_its_way(before, self._placed(before, one, left_at))
            self._known[name] = now
            if before is None or self._is_elsewhere(before, now):
                self._join(now, now_s)
            else:
                self._follow_one(before, now, now_s)
            self._follow_standing(now, now_s)
            self._follow_goals(now, now_s)

    def _follow_closed(self, snapshot: TrafficSnapshot, now_s: float) -> None:
        """Take over what people have closed, and what a robot may enter besides the corridor that it is thought to be
        in."""
        self._close_and_open(snapshot.closed.union(*map(_spare, snapshot.robots.values())), now_s)

    def _close_and_open(self, closed: frozenset[str], now_s: float) -> None:
        for corridor in sorted(closed - self._closed):
            self.controller.close(corridor, now_s)
        for corridor in sorted(self._closed - closed):
            self.controller.open(corridor, now_s)
        self._closed = closed

    def _placed(self, before: RobotLocation | None, now: RobotLocation, left_at: Mapping[int, str]) -> RobotLocation:
        """Where it stands: what it says with a `clear` comes before what it is seen to say a moment later."""
        if now.holds:
            return replace(now, post=now.holds[0].from_post)
        if before is not None and before.holds:
            last = before.way[-1]
            there = now.request.first[0][0] if now.request else last.to_post
            return replace(now, post=left_at.get(last.grant_id, there))
        if now.request is not None:
            return replace(now, post=now.request.first[0][0])
        if before is None:
            return now
        news = now.seen_at is not None and (before.seen_at is None or now.seen_at > before.seen_at)
        return now if news else replace(now, post=before.post)

    def _is_elsewhere(self, before: RobotLocation, now: RobotLocation) -> bool:
        """Not where the schedule has it."""
        if before.home != now.home:
            return True
        was_in, is_in = before.way, now.way
        if not was_in:
            return bool(is_in) or before.post != now.post
        if is_in:
            return was_in[-len(is_in) :] != is_in
        return now.post != was_in[-1].to_post

    def _join(self, now: RobotLocation, now_s: float) -> None:
        post, towards = now.way[0].from_post if now.way else now.post, [hold.to_post for hold in now.way]
        self.controller.joins(now.robot, post=post, home=now.home, at_home=now.at_home, now_s=now_s, towards=towards)
        self._frozen.discard(now.robot)

    def _follow_one(self, before: RobotLocation, now: RobotLocation, now_s: float) -> None:
        for hold in before.way[: len(before.way) - len(now.way)]:
            self.controller.cleared(now.robot, hold.from_post, hold.to_post, now_s)
        if now.at_home and not now.holds:
            self.controller.docked(now.robot)

    def _follow_goals(self, now: RobotLocation, now_s: float) -> None:
        goals = self._wanted(now)
        left = {goal.key for goal in goals}
        for goal in self.controller.goals(now.robot):
            if goal.key not in left:
                self.controller.served(now.robot, goal.key, now_s)
        known = _are_known(self.controller.goals(now.robot), goals)
        if not known and not self.controller.give(now.robot, goals, now_s):
            log.warning("no_schedule", robot=now.robot, goals=_places(goals))

    def _wanted(self, now: RobotLocation) -> tuple[Goal, ...]:
        number = self.controller.network.number_of
        return tuple(
            Goal(number(stop.post), self._takes_s(stop, now), key=stop.key)
            for stop in now.goals
            if stop.post in self.campus.posts
        )

    def _takes_s(self, stop: Stop, now: RobotLocation) -> float:
        """A charge takes hours: others that would go after it on the schedule go before it."""
        if stop.charges_to is not None:
            return ASSUMED.time_s(now.battery_ratio or 0.0, stop.charges_to)
        return 0.0 if stop.key == OF_ITS_OWN else self.settings.assumed_handover_s

    def _follow_standing(self, now: RobotLocation, now_s: float) -> None:
        stands = now.stopped or now.robot in self.vanished
        if stands and now.robot not in self._frozen:
            self._frozen.add(now.robot)
            self.controller.freeze(now.robot, now_s)
        elif not stands and now.robot in self._frozen:
            self._frozen.discard(now.robot)
            self.controller.unfreeze(now.robot, now_s)

    # What follows.

    def follow_and_answer(
        self, snapshot: TrafficSnapshot, left_at: Mapping[int, str], understood: Mapping[str, bool], now_s: float
    ) -> list[Verdict]:
        """Both, with how long robots have to wait: that is not known before all that may be granted is."""
        self.follow(snapshot, left_at, now_s)
        return self._timed([*self.verdicts(understood, now_s)], now_s)

    def verdicts(self, understood: Mapping[str, bool], now_s: float) -> Iterator[Verdict]:
        """On every claim that waits; granted is at once what may be. `understood`: who knows what a detour is."""
        for name, one in self._known.items():
            if one.request is None or one.holds or not one.online or name in self._frozen:
                continue
            if one.request.is_for_later and one.goals and one.goals[0].post == one.request.goal:
                continue  # first it does there what it has to do
            verdict = self._verdict(one, understood.get(name, False), now_s)
            if isinstance(verdict, MayEnter):
                self._note_grant(one, verdict, now_s)
            yield verdict

    def _timed(self, verdicts: Sequence[Verdict], now_s: float) -> list[Verdict]:
        waiting = [one.robot for one in verdicts if isinstance(one, HasToWait) and one.in_turn]
        for_s = {name: max(0.0, at_s - now_s) for name, at_s in self.controller.go_on_s(waiting, now_s).items()}
        return [replace(one, for_s=for_s.get(one.robot)) if isinstance(one, HasToWait) else one for one in verdicts]

    def _verdict(self, one: RobotLocation, knows_detours: bool, now_s: float) -> Verdict:
        assert one.request is not None  # noqa: S101  # only those are asked
        first = one.request.first
        if isinstance(self.controller.next_move(one.robot, now_s), ComeIn):
            # Home places of maps without bays on the floor are nowhere: who is to make room has done so.
            self.controller.comes_in(one.robot, one.post, now_s)
        leads = self.controller.leads(one.robot)
        leg = self._names(leads) if leads is not None else None
        asked = leg if leg in first else first[0]
        if len(first) > 1 and (holders := [name for leg in first for name in self._holders(leg)]):
            return HasToWait(one.robot, asked, tuple(holders))
        answer = self.controller.claims(one.robot, *asked, now_s)
        if isinstance(answer, Denied) and answer.instead is not None:
            if not knows_detours:
                return Elsewhere(one.robot, first[0])
            asked = self._names(answer.instead)
            answer = self.controller.claims(one.robot, *asked, now_s)
        if isinstance(answer, Granted):
            if asked not in first:
                return MayEnter(one.robot, (asked,), aside=True)
            others = tuple(leg for leg in first if leg != asked)
            ahead = self.controller.goes_on(one.robot, one.request.then, now_s)
            return MayEnter(one.robot, (asked, *others, *map(self._names, ahead)))
        if isinstance(answer, Waits):
            return HasToWait(one.robot, asked, answer.robots, in_turn=True)
        before = dict.fromkeys((*self._holders(asked), *self._in_the_way(one, one.request.goal)))
        return HasToWait(one.robot, asked, tuple(before), closed=corridor_name(*asked) in self._closed)

    def _holders(self, leg: Leg) -> tuple[str, ...]:
        corridor = corridor_name(*leg)
        return tuple(name for name, one in self._known.items() if any(h.corridor == corridor for h in one.holds))

    def _in_the_way(self, one: RobotLocation, goal: str) -> tuple[str, ...]:
        """Those that stand, until a person lets them go on, in a corridor of its way or in a bay at its end."""
        try:
            way = shortest_route(self.campus, one.post, goal).posts
        except CampusMapError:
            return ()
        corridors = {corridor_name(a, b) for a, b in pairwise(way)}
        standing = (self._known[name] for name in sorted(self._frozen))
        return tuple(
            other.robot
            for other in standing
            if any(hold.corridor in corridors for hold in other.holds)
            or (other.post == goal and not other.holds and not other.at_home)
        )

    def _names(self, lane: Lane) -> Leg:
        posts = self.controller.network.posts
        return posts[lane.start], posts[lane.end]

    def _note_grant(self, one: RobotLocation, verdict: MayEnter, now_s: float) -> None:
        """As the next picture will have it; what it may enter besides is closed for those who are asked after it."""
        holds = tuple(Hold(*leg) for leg in verdict.legs)
        noted = replace(one, request=None, at_home=False, holds=holds)
        self._known[one.robot] = noted
        self._close_and_open(self._closed | _spare(noted), now_s)


def _are_known(known: Sequence[Goal], goals: Sequence[Goal]) -> bool:
    """The same, and they take about as long: a stop may turn out to be a charge, and what is charged is not to come."""
    takes = zip(known, goals, strict=False)
    return _places(known) == _places(goals) and all(abs(a.handling_s - b.handling_s) < CHARGES_S for a, b in takes)


def _places(goals: Iterable[Goal]) -> list[tuple[str, int]]:
    return [(goal.key, goal.post) for goal in goals]


def _spare(one: RobotLocation) -> frozenset[str]:
    return frozenset(hold.corridor for hold in one.holds[len(one.way) :])


def _on_its_way(before: RobotLocation | None, now: RobotLocation) -> RobotLocation:
    """A place to which it goes for reasons of its own is where it goes until it is there, asks for another way, or
    takes back what it waited for or was granted."""
    own = before.goals[0] if before and before.goals and before.goals[0].key == OF_ITS_OWN else None
    is_there = not now.holds and own is not None and now.post == own.post
    if before is None or own is None or is_there or now.request is not None or _gave_up(before, now):
        return now
    return replace(now, goals=(own, *now.goals))


def _gave_up(before: RobotLocation, now: RobotLocation) -> bool:
    """Nothing is asked for or held any more, and it has not moved."""
    waited, held = before.request is not None, bool(before.holds)
    return not now.holds and ((waited and not held) or (held and now.post == before.way[0].from_post))


def network_for(campus: CampusMap, settings: Settings, estimates: Estimates | None = None) -> Network:
    """Return the network: how long corridors take is learned, or assumed from their lengths."""

    def travel_s(corridor: Corridor, start: str) -> float:
        learned_s = estimates.usual_s(start, corridor.other(start)) if estimates is not None else None
        return corridor.length_m / settings.assumed_speed_m_s if learned_s is None else learned_s

    def crossing_s(post: Post) -> float:
        return ASSUMED_CROSSING_S if post.spurs else 0.0

    return network_of(campus, travel_s, lambda corridor: corridor.following_s, crossing_s=crossing_s)
