"""The traffic of a campus as it is now: who stands where, what each is to do, and who may enter which corridor.

    controller.joins("r1", post="mailroom", home="mailroom", at_home=True, now_s=0.0)
    controller.give("r1", [Goal(network.number_of("loeb"), 60.0)], now_s=0.0)      whether there is a schedule with it
    controller.claims("r1", "mailroom", "loeb", now_s=1.0)                         Granted, Waits or Denied
    controller.grants(now_s=9.0)                                                   who waited, and waits no longer
    controller.crossed("r1", "mailroom", now_s=13.0)                               wholly in the corridor
    controller.next_move("r1", now_s=299.0)                                        GoOn or ComeIn, at its end
    controller.comes_in("r1", "loeb", now_s=300.0)                                 LetIn or Waits
    controller.cleared("r1", "mailroom", "loeb", now_s=301.0)                      out of it, on the crossing
    controller.crossed("r1", "loeb", now_s=311.0)                                  wholly in its bay

What a robot holds is free again when it reports that it is elsewhere, and not before: the crossing and the bay that it
leaves with `crossed`, a corridor with `cleared` (or `crossed`, if that is what is heard). No grant, no time and no
question frees anything. Reports may come twice. Where the crossing of a post takes no time no robot holds it: a bay is
left with the grant, `cleared` says that the robot stands at the end, and `crossed` and `comes_in` are not needed.

In memory and pure: what it knows can be built again from the grants, the places and the goals of all robots.
"""

from collections.abc import Collection, Mapping, Sequence
from functools import partial
from math import inf
from random import Random
from typing import Final

from fleet.schedule.answers import Answer, ComeIn, Denied, GoOn, Granted, LetIn, Move, Waits
from fleet.schedule.execution import moves_over, next_move_s, waits_to_cross
from fleet.schedule.journey import Goal, Journey, Task, goes_aside, without_aside, without_first
from fleet.schedule.live import ROUNDS, LiveSchedule, UnsoundSchedule
from fleet.schedule.network import Lane, Network
from fleet.schedule.participant import Participant, is_full
from fleet.schedule.placing import Place, is_same, start_at
from fleet.schedule.planning import Schedule
from fleet.schedule.under_way import aside, crossed, further, is_on, let_in_after, out_of, placed, through

__all__ = ["CLAIMED", "ComeIn", "Denied", "GoOn", "Granted", "LetIn", "TrafficController", "UnsoundSchedule", "Waits"]

CLAIMED: Final = "claimed"
"""The key of a goal that no order gave: a robot goes somewhere for reasons of its own, to a dock for instance."""
SOON_S: Final = 5.0
"""A robot waits so long at the end of its corridor, if it can go straight on then."""


class TrafficController:
    """One for a campus. Every method takes the time, in seconds of one clock that never goes back."""

    def __init__(self, network: Network, rng: Random | None = None) -> None:
        self._whole = network
        self._live = LiveSchedule(network, rng or Random(0))

    # What there is.

    @property
    def network(self) -> Network:
        """As it is open now: without closed corridors, and without what robots that stand still are in."""
        return self._live.network

    def tasks(self, now_s: float) -> dict[str, Task]:
        """Every robot that can be planned for, as it is now: of its goals those that can be reached."""
        return self._live.tasks(now_s)

    def journeys(self, now_s: float) -> dict[str, Journey]:
        """The schedule from now on."""
        return self._live.journeys(now_s)

    def tasks_and_journeys(self, now_s: float) -> tuple[dict[str, Task], dict[str, Journey]]:
        """Both of one moment, for half of the work."""
        return self._live.tasks_and_journeys(now_s)

    def can_be_planned(self) -> tuple[str, ...]:
        """Robots that do not stand still until a person lets them go on."""
        return tuple(name for name, one in self._robots.items() if not one.stands_still)

    def goals(self, robot: str) -> tuple[Goal, ...]:
        return self._robots[robot].goals

    def out_of_reach(self) -> frozenset[str]:
        """Robots of which some goal, or home, cannot be reached as long as the ways are closed that are closed."""
        robots = self._robots.items()
        return frozenset(name for name, one in robots if not one.frozen and (one.is_shut_in or one.lacks(self.network)))

    # What people and dispatch do.

    def joins(
        self,
        robot: str,
        *,
        post: str,
        home: str | None,
        at_home: bool,
        now_s: float,
        towards: Sequence[str] = (),
        on_crossing: bool = False,
        to_home: bool = False,
        is_let_in: bool = False,
    ) -> None:
        """A robot is there that was not: switched on, carried there, or known from before a restart. It stands at its
        home place at this post (`at_home`), or in a bay there; where every bay is taken beside them, as the person who
        carried it there must have put it.

        `towards`: the corridors that it was let into and has not reported to be out of, by the posts they lead to. At
        its home post among these `to_home` keeps its home place for it, else a bay is kept. `is_let_in`: the crossing
        at the end of the last is its own, too.
        `on_crossing`: it has not reported to be off the crossing of the post, on its way out of its bay or home there
        into the first of these corridors; without any, from a corridor into its bay or home, or, if it is not `at_home`
        but on its way `to_home`, from its bay there to make room.
        Robots that follow each other in a corridor join in the order in which they were let in."""
        before = self._robots.pop(robot, None)
        home_number = None if home is None else self._whole.number_of(home)
        place = Place(post, at_home, tuple(towards), on_crossing, to_home, is_let_in)
        full = partial(is_full, self._whole, robots=self._robots.values())
        start = start_at(self._whole, place, home_number, full, now_s)
        start = let_in_after(start, [one.start for one in self._robots.values()])
        self._robots[robot] = Participant(home_number, start, before.goals if before else ())
        self._live.planned.pop(robot, None)
        self._live.plan_some(now_s, [robot])

    def is_at(self, robot: str, place: Place, home: str | None) -> bool:
        """Tell if this robot is known to be there. Which place at a post it leaves or comes to is not compared but
        where it stands in it."""
        home_number = None if home is None else self._whole.number_of(home)
        return is_same(self._robots[robot].start, start_at(self._whole, place, home_number, lambda _: False, 0.0))

    def leaves(self, robot: str, now_s: float) -> None:
        """A robot is taken away: what it had is free."""
        self._robots.pop(robot, None)
        self._live.plan_some(now_s, rounds=ROUNDS)

    def give(self, robot: str, goals: Sequence[Goal], now_s: float, rounds: int = ROUNDS) -> bool:
        """These are its goals from now on, all of them, if there is a schedule with them; else nothing changes. Those
        of a frozen robot are planned for when it goes on."""
        return self._live.give(robot, goals, now_s, rounds)

    def adopt(self, goals: Mapping[str, Sequence[Goal]], schedule: Schedule, now_s: float) -> bool:
        """The same for several robots with a schedule worked out elsewhere, if none has gone otherwise since then."""
        return self._live.adopt(goals, schedule, now_s)

    def close(self, corridor: str, now_s: float) -> None:
        """Let no robot into it any more; one that is in it drives on."""
        self._live.closed |= {corridor}
        self._live.plan_some(now_s)

    def open(self, corridor: str, now_s: float) -> None:
        self._live.closed -= {corridor}
        self._live.plan_some(now_s, rounds=ROUNDS)

    def freeze(self, robot: str, now_s: float) -> None:
        """It stays where it is, dead or paused: its corridor, its bay, and the crossing that it may be on stay taken.
        All others go round it; those in corridors that lead to that crossing turn round."""
        its = self._robots[robot]
        its.frozen, its.claim, its.asks_in = True, None, False
        self._live.plan_some(now_s)

    def unfreeze(self, robot: str, now_s: float) -> None:
        """It goes on from where it was."""
        self._robots[robot].frozen = False
        self._robots[robot].begins(now_s)
        self._live.plan_some(now_s, [robot], ROUNDS)

    # What robots ask.

    def claims(self, robot: str, start: str, end: str, now_s: float) -> Answer:
        """May this robot enter the corridor between these posts, over the crossing before it? From the end of another
        corridor that means straight on, and is asked when the robot is there. What waits is answered again by `grants`;
        what is denied is asked no more. Raises LookupError if there is no such corridor."""
        lane, its = self._lane(start, end), self._robots[robot]
        its.claim, its.asks_in = lane, False
        if not self._leads_through(robot, lane) and all(goal.key == CLAIMED for goal in its.goals):
            self.give(robot, (Goal(lane.end, 0.0, key=CLAIMED),), now_s, rounds=0)  # it goes for reasons of its own
        return self._answer(robot, lane, now_s)

    def goes_on(self, robot: str, way: Sequence[tuple[str, str]], now_s: float) -> list[Lane]:
        """It was let into a corridor, and means to take this way from there without a stop: as much of it is granted,
        too, as no robot enters before it, with the crossings between. All of that is its own until it reports to have
        left it, one after the other."""
        granted = []
        for start, end in way:
            lane = self._lane(start, end)
            if not self._may_go_on(robot, lane, now_s):
                break
            self._lets_in(robot, lane, now_s)
            granted.append(lane)
        return granted

    def comes_home(self, robot: str) -> bool:
        """At the end of all that it was let into its home place is kept for it, and no bay."""
        return self._robots[robot].start.at_home

    def comes_in(self, robot: str, post: str, now_s: float) -> LetIn | Waits:
        """May this robot cross into its bay or home place at this post: from the end of its corridor, instead of
        straight on; or, to make room, from its bay there to its home place, where it still waits for what it has
        claimed? What waits is answered again by `grants`."""
        its, number = self._robots[robot], self._whole.number_of(post)
        its.asks_in = True
        if its.start.lane is not None:
            its.claim = None
        return self._lets_come_in(robot, number, now_s)

    def gives_up_claim(self, robot: str) -> None:
        self._robots[robot].claim, self._robots[robot].asks_in = None, False

    def grants(self, now_s: float) -> list[tuple[str, Granted | LetIn | Denied]]:
        """Those who waited and may go on now, or are led another way now. Asked after every change, and when a time
        that was named has come."""
        waiting = [name for name, one in self._robots.items() if one.claim is not None or one.asks_in]
        if self._whole.has_crossings:
            waiting.sort(key=self._moves_s)
        answers: list[tuple[str, Granted | LetIn | Denied]] = []
        for name in waiting:
            its = self._robots[name]
            lane = its.claim
            answer = (
                self._lets_come_in(name, its.start.post, now_s) if lane is None else self._answer(name, lane, now_s)
            )
            if not isinstance(answer, Waits):
                answers.append((name, answer))
        return answers

    def go_on_s(self, robots: Collection[str], now_s: float) -> dict[str, float]:
        """About when each of those that wait is to go on; without those that the schedule leads nowhere. To be asked
        when all is answered: each grant has it timed anew."""
        journeys = self._live.journeys(now_s) if robots else {}
        at_s = ((name, next_move_s(self._robots[name].start, journeys.get(name))) for name in robots)
        return {name: one for name, one in at_s if one < inf}

    def next_move(self, robot: str, now_s: float) -> Move | None:
        """What it is to do where it is, or where it comes to. At the end of its corridor it goes straight on if it has
        nothing to do there and the schedule has it enter the next corridor about when it is there; else it comes in.
        None: it stays."""
        start, journey = self._robots[robot].start, self._live.planned.get(robot)
        if journey is None:
            return None
        if not start.rests and (start.crosses or not self._goes_straight_on(robot, now_s)):
            return ComeIn(start.post, start.at_home)
        if goes_aside(journey):
            return ComeIn(start.post, at_home=True)
        lane = self._coming(journey)
        return None if lane is None else GoOn(lane)

    def leads(self, robot: str) -> Lane | None:
        """The corridor that the schedule has this robot enter next: home, when there is nothing else to do, or aside.
        None: it stays."""
        journey = self._live.planned.get(robot)
        return None if journey is None else self._coming(journey)

    # What robots report.

    def cleared(self, robot: str, start: str, end: str, now_s: float) -> None:
        """The robot has left this corridor and is on the crossing at its end, or beyond. Where crossings take no time
        it stands there. Nothing happens if it was not in it."""
        lane, its = self._lane(start, end), self._robots[robot]
        passed = next((one.lane for one in its.start.before if one.lane and one.lane.corridor == lane.corridor), None)
        if passed is not None:
            its.start = through(its.start, passed, now_s)
        elif its.start.lane is not None and its.start.lane.corridor == lane.corridor:
            its.start = out_of(its.start, self._whole.crossing_s[its.start.post], now_s)
            self._has_moved(robot, now_s)

    def crossed(self, robot: str, post: str, now_s: float) -> None:
        """The robot is off the crossing of this post, wholly in its bay or home place there, or in the next corridor:
        the crossing and what it left are free. Nothing happens if the crossing was not its own."""
        its, before = self._robots[robot], self._robots[robot].start
        its.start = crossed(before, self._whole.number_of(post), now_s)
        if its.start != before:
            self._has_moved(robot, now_s)

    def docked(self, robot: str) -> None:
        """It reports that it has gone from a bay to its home place at the same post."""
        its = self._robots[robot]
        if its.start.post == its.home and its.start.lane is None and (its.start.crosses or not its.start.at_home):
            was_sent = its.start.crosses
            its.start = placed(its.start.post, at_home=True, now_s=its.start.ready_s, entered_s=its.start.entered_s)
            if not was_sent and goes_aside(self._live.planned[robot]):
                self._live.planned[robot] = without_first(self._live.planned[robot])

    def served(self, robot: str, key: str, now_s: float) -> None:
        """One of its goals is behind it, or given up: then it need not go where it was to be served."""
        its = self._robots[robot]
        left = tuple(goal for goal in its.goals if goal.key != key)
        was_first = its.goals[1:] == left and self._serves_now(robot) > 0
        its.wants(left, now_s)
        if not was_first:
            self._live.plan_some(now_s, [robot], ROUNDS)

    def stands(self, robot: str, post: str, now_s: float) -> None:
        """It says that it is at this post. Where it was thought elsewhere, all is planned anew."""
        its, number = self._robots[robot], self._whole.number_of(post)
        if its.start.post != number:
            home = None if its.home is None else self._whole.posts[its.home]
            self.joins(robot, post=post, home=home, at_home=False, now_s=now_s)

    # How it is done.

    @property
    def _robots(self) -> dict[str, Participant]:
        return self._live.robots

    def _lane(self, start: str, end: str) -> Lane:
        return self._whole.lane(self._whole.number_of(start), self._whole.number_of(end))

    def _answer(self, robot: str, lane: Lane, now_s: float) -> Answer:
        its, journey = self._robots[robot], self._live.planned.get(robot)
        # Who leaves makes room as well as who goes aside.
        journey = None if journey is None else without_aside(journey)
        coming = journey.legs[1] if journey is not None and len(journey.legs) > 1 else None
        if journey is None or coming is None or coming.lane != lane:
            its.claim = None
            return Denied(lane, None if journey is None else self._coming(journey))
        others = self._live.waits_for(robot, now_s, journey)
        if others or not self._may_leave(its):
            return Waits(lane, others)
        unserved = self._serves_now(robot) > 0
        self._live.planned[robot] = journey
        self._lets_in(robot, lane, now_s)
        if unserved:  # it goes without them, and has to come back
            self._live.plan_some(now_s, [robot])
        return Granted(lane, coming.at_home)

    def _may_leave(self, its: Participant) -> bool:
        """It stands; or it is at the end of its corridor, where it may cross without a stop."""
        start = its.start
        may_pass = self._whole.crossing_s[start.post] > 0.0 and not (start.is_on_its_way or start.crosses or its.turns)
        return start.rests or may_pass

    def _lets_in(self, robot: str, lane: Lane, now_s: float) -> None:
        its, coming = self._robots[robot], self._live.planned[robot].legs[1]
        its.claim = None
        over_s = self._whole.crossing_s[lane.start]
        its.start = further(its.start, lane, at_home=coming.at_home, now_s=now_s, over_s=over_s)
        self._live.planned[robot] = without_first(self._live.planned[robot])

    def _lets_come_in(self, robot: str, post: int, now_s: float) -> LetIn | Waits:
        its, journey = self._robots[robot], self._live.planned.get(robot)
        start, over_s = its.start, self._whole.crossing_s[post]
        makes_room = start.rests and journey is not None and goes_aside(journey)
        if start.post == post and (start.crosses or (start.rests and not makes_room)):
            its.asks_in = False  # it has been let in before
            return LetIn(post, start.at_home)
        others = self._waits_to_cross(robot, post, now_s)
        if start.post != post or start.is_on_its_way or journey is None or others or post in self.network.shut:
            return Waits(start.lane, others)
        its.asks_in = False
        if makes_room:
            its.start = aside(start, over_s, now_s)
            self._live.planned[robot] = without_first(journey)
        else:
            its.start = is_on(start, over_s, now_s)
        return LetIn(post, its.start.at_home)

    def _waits_to_cross(self, robot: str, post: int, now_s: float) -> tuple[str, ...]:
        starts = {name: other.start for name, other in self._robots.items()}
        return tuple(dict.fromkeys(waits_to_cross(self._whole, starts, self._live.planned, robot, post, now_s)))

    def _may_go_on(self, robot: str, lane: Lane, now_s: float) -> bool:
        """Where robots follow each other the order in which they go in is only known when they do."""
        start, legs = self._robots[robot].start, self._live.planned[robot].legs
        if len(legs) < 2 or legs[1].lane != lane or legs[0].goals or start.at_home or start.lane is None:
            return False
        passed = {one.post for one in start.before} | {start.post, start.lane.start}
        follows = lane.following_s is not None or start.lane.following_s is not None
        if follows or lane.end in passed or self._live.waits_for(robot, now_s):
            return False
        others = (other for name, other in self._live.planned.items() if name != robot)
        first_s = min((at_s for other in others for at_s in moves_over(self._whole, other, lane.start)), default=inf)
        return first_s > legs[1].enter_s

    def _goes_straight_on(self, robot: str, now_s: float) -> bool:
        start, journey = self._robots[robot].start, self._live.planned[robot]
        lane = journey.legs[1].lane if len(journey.legs) > 1 else None
        if lane is None or not self._may_leave(self._robots[robot]) or self._serves_now(robot) > 0:
            return False
        if start.lane is not None and start.lane.corridor == lane.corridor:
            return False
        there_s = max(now_s, start.arrives_s)
        is_soon = self._live.journeys(now_s)[robot].legs[1].enter_s <= there_s + SOON_S
        return is_soon or not self._live.waits_for(robot, now_s)

    def _moves_s(self, robot: str) -> float:
        return next_move_s(self._robots[robot].start, self._live.planned.get(robot))

    def _has_moved(self, robot: str, now_s: float) -> None:
        its = self._robots[robot]
        its.turns = its.turns and its.start.lane is not None
        if its.start.rests and its.goals and (its.goals[0].key, its.goals[0].post) == (CLAIMED, its.start.post):
            its.goals = its.goals[1:]
        self._live.try_again(now_s)

    def _serves_now(self, robot: str) -> int:
        """Count its goals that are to be served where it is: not those that no way leads to now."""
        journey = self._live.planned.get(robot)
        later = 0 if journey is None else sum(leg.goals for leg in journey.legs[1:])
        return len(self._robots[robot].planned_goals(self.network)) - later

    def _leads_through(self, robot: str, lane: Lane) -> bool:
        journey = self._live.planned.get(robot)
        return journey is not None and any(leg.lane == lane for leg in journey.legs[1:])

    def _coming(self, journey: Journey) -> Lane | None:
        return next((leg.lane for leg in journey.legs[1:] if leg.lane is not None), None)
