"""The traffic of a campus as it is now: who stands where, what each is to do, and who may enter which corridor.

    controller.joins("r1", post="mailroom", home="mailroom", at_home=True, now_s=0.0)
    controller.give("r1", [Goal(network.number_of("library"), 60.0)], now_s=0.0)   whether there is a schedule with it
    controller.claims("r1", "mailroom", "loeb", now_s=1.0)                         Granted, Waits or Denied
    controller.grants(now_s=9.0)                                                   who waited, and waits no longer
    controller.cleared("r1", "mailroom", "loeb", now_s=301.0)

In memory and pure: what it knows can be built again from the grants, the places and the goals of all robots. Nothing
here takes a corridor from a robot because time has passed.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf
from random import Random
from typing import Final

from fleet.schedule.execution import caught_up, one_behind_the_other, retimed, waits_for
from fleet.schedule.journey import Goal, Journey, Start, Task, without_first
from fleet.schedule.network import Lane, Network
from fleet.schedule.participant import Participant, is_full, open_network
from fleet.schedule.planning import Schedule, first_plan, improve, insert, plan, plan_what_can_be
from fleet.schedule.under_way import further, through
from fleet.schedule.validation import problems

ROUNDS: Final = 10
"""So often something better is looked for after each change, unless the caller does that himself."""
CLAIMED: Final = "claimed"
"""The key of a goal that no order gave: a robot goes somewhere for reasons of its own, to a dock for instance."""


@dataclass(frozen=True)
class Granted:
    """The corridor may be entered, and a bay at its end is kept."""

    lane: Lane


@dataclass(frozen=True)
class Waits:
    """Not yet. `robots` have to go on before; `until_s`: about when, by the schedule."""

    lane: Lane
    robots: tuple[str, ...]
    until_s: float


@dataclass(frozen=True)
class Denied:
    """Not this way: the schedule leads over `instead` (None: nowhere, no way is open)."""

    lane: Lane
    instead: Lane | None


Answer = Granted | Waits | Denied


class UnsoundSchedule(RuntimeError):
    """The search has made what the independent check refuses: a mistake of ours. No robot is let in by it; a caller
    that keeps the controller builds it anew."""


class TrafficController:
    """One for a campus. Every method takes the time, in seconds of one clock that never goes back."""

    def __init__(self, network: Network, rng: Random | None = None) -> None:
        self._whole = network
        self._closed: frozenset[str] = frozenset()
        self._rng = rng or Random(0)
        self._robots: dict[str, Participant] = {}
        self._journeys: dict[str, Journey] = {}
        self._network = network

    # What there is.

    @property
    def network(self) -> Network:
        """As it is open now: without closed corridors, and without what frozen robots stand in."""
        return self._network

    def tasks(self, now_s: float) -> dict[str, Task]:
        """Every robot that can be planned for, as it is now: of its goals those that can be reached."""
        tasks = {name: robot.task(self._network, now_s) for name, robot in self._robots.items() if not robot.frozen}
        return one_behind_the_other(tasks)

    def journeys(self, now_s: float) -> dict[str, Journey]:
        """The schedule from now on."""
        return retimed(self._network, self.tasks(now_s), self._journeys)

    def goals(self, robot: str) -> tuple[Goal, ...]:
        return self._robots[robot].goals

    def out_of_reach(self) -> frozenset[str]:
        """Robots of which some goal, or home, cannot be reached as long as the ways are closed that are closed."""
        return frozenset(
            name for name, robot in self._robots.items() if not robot.frozen and robot.lacks(self._network)
        )

    # What people and dispatch do.

    def joins(
        self, robot: str, *, post: str, home: str | None, at_home: bool, now_s: float, towards: Sequence[str] = ()
    ) -> None:
        """A robot is there that was not: switched on, or carried there. Where every bay is taken it stands beside them,
        as the person who carried it there must have put it. `towards`: it may be on its way from its post over
        these."""
        before = self._robots.pop(robot, None)
        stops = [self._whole.number_of(one) for one in (post, *towards)]
        lanes = [self._whole.lane(*leg) for leg in pairwise(stops)]
        start = Start(stops[0], (at_home and not lanes) or self._is_full(stops[0]), now_s, now_s)
        for lane in lanes:
            start = further(start, lane, at_home=self._is_full(lane.end), now_s=now_s)
        home_number = None if home is None else self._whole.number_of(home)
        self._robots[robot] = Participant(home_number, start, before.goals if before else ())
        self._plan_all(now_s)

    def leaves(self, robot: str, now_s: float) -> None:
        """A robot is taken away: what it had is free."""
        self._robots.pop(robot, None)
        self._plan_all(now_s)

    def give(self, robot: str, goals: Sequence[Goal], now_s: float, rounds: int = ROUNDS) -> bool:
        """These are its goals from now on, all of them, if there is a schedule with them; else nothing changes. Those
        of a frozen robot are planned for when it goes on."""
        its, before = self._robots[robot], replace(self._robots[robot])
        its.wants(goals, now_s)
        if its.frozen:
            return True
        its.goals_wait = False
        tasks, kept = self.tasks(now_s), self.journeys_of_others(robot, now_s)
        found = plan(self._network, tasks, [robot], kept) or insert(self._network, tasks, kept, robot)
        found = found or first_plan(self._network, tasks, self._rng)
        if found is None or not self._takes(tasks, self._better(tasks, found, rounds)):
            self._robots[robot] = before
            return False
        return True

    def adopt(self, goals: Mapping[str, Sequence[Goal]], schedule: Schedule, now_s: float) -> bool:
        """The same for several robots with a schedule that was worked out elsewhere, if it can still be carried out:
        since then robots may have entered corridors, but no others than it says."""
        before = {name: replace(robot) for name, robot in self._robots.items()}
        for name, theirs in goals.items():
            self._robots[name].wants(self._robots[name].as_told(theirs), now_s)
        tasks = self.tasks(now_s)
        journeys = caught_up(self._network, tasks, schedule.journeys)
        if journeys is not None and self._takes(tasks, replace(schedule, journeys=journeys)):
            return True
        self._robots = before
        return False

    def close(self, corridor: str, now_s: float) -> None:
        """Let no robot into it any more; one that is in it drives on."""
        self._closed |= {corridor}
        self._plan_all(now_s)

    def open(self, corridor: str, now_s: float) -> None:
        self._closed -= {corridor}
        self._plan_all(now_s)

    def freeze(self, robot: str, now_s: float) -> None:
        """It stays where it is, dead or paused: its corridor and its bay stay taken, and all others go round it."""
        self._robots[robot].frozen = True
        self._robots[robot].claim = None
        self._plan_all(now_s)

    def unfreeze(self, robot: str, now_s: float) -> None:
        """It goes on from where it was."""
        self._robots[robot].frozen = False
        self._robots[robot].begins(now_s)
        self._plan_all(now_s)

    # What robots say.

    def claims(self, robot: str, start: str, end: str, now_s: float) -> Answer:
        """May this robot enter the corridor between these posts? What waits is answered again by `grants`; what is
        denied is asked no more. Raises LookupError if there is no such corridor."""
        lane = self._whole.lane(self._whole.number_of(start), self._whole.number_of(end))
        self._robots[robot].claim = lane
        if not self._leads_through(robot, lane) and all(goal.key == CLAIMED for goal in self._robots[robot].goals):
            self.give(robot, (Goal(lane.end, 0.0, key=CLAIMED),), now_s, rounds=0)  # it goes for reasons of its own
        return self._answer(robot, now_s)

    def goes_on(self, robot: str, way: Sequence[tuple[str, str]], now_s: float) -> list[Lane]:
        """It was let into a corridor, and means to take this way from there without a stop: as much of it is granted,
        too, as no robot enters before it. All of that is its own until it is cleared, one after the other."""
        granted = []
        for start, end in way:
            lane = self._whole.lane(self._whole.number_of(start), self._whole.number_of(end))
            if not self._may_go_on(robot, lane, now_s):
                break
            self._lets_in(robot, lane, now_s)
            granted.append(lane)
        return granted

    def gives_up_claim(self, robot: str) -> None:
        self._robots[robot].claim = None

    def grants(self, now_s: float) -> list[tuple[str, Granted | Denied]]:
        """Those who waited and may enter now, or are led another way now. Asked after every change, and when a time
        that was named has come."""
        waiting = [name for name, robot in self._robots.items() if robot.claim is not None]
        answers = [(name, self._answer(name, now_s)) for name in waiting]
        return [(name, answer) for name, answer in answers if not isinstance(answer, Waits)]

    def cleared(self, robot: str, start: str, end: str, now_s: float) -> None:
        """The robot has left this corridor and stands at its end. Nothing happens if it was not in it."""
        lane = self._whole.lane(self._whole.number_of(start), self._whole.number_of(end))
        its = self._robots[robot]
        if any(lane == through.lane for through in its.start.before):
            its.start = through(its.start, lane, now_s)
        elif its.start.lane == lane:
            its.start = replace(its.start, lane=None, arrives_s=-inf, ready_s=now_s, before=())
            if its.goals and (its.goals[0].key, its.goals[0].post) == (CLAIMED, lane.end):
                its.goals = its.goals[1:]
            self._try_again(now_s)

    def docked(self, robot: str) -> None:
        """It has gone from a bay to its home place at the same post."""
        its = self._robots[robot]
        if its.start.post == its.home and not its.start.at_home and its.start.lane is None:
            its.start = replace(its.start, at_home=True)
            if self._docks_next(robot):
                self._journeys[robot] = without_first(self._journeys[robot])

    def served(self, robot: str, key: str, now_s: float) -> None:
        """One of its goals is behind it, or given up: then it need not go where it was to be served."""
        its = self._robots[robot]
        left = tuple(goal for goal in its.goals if goal.key != key)
        was_first = its.goals[1:] == left and self._serves_now(robot) > 0
        its.wants(left, now_s)
        if not was_first:
            self._plan_all(now_s)

    def stands(self, robot: str, post: str, now_s: float) -> None:
        """It says that it is at this post. Where it was thought elsewhere, all is planned anew."""
        its, number = self._robots[robot], self._whole.number_of(post)
        if its.start.post != number:
            home = None if its.home is None else self._whole.posts[its.home]
            self.joins(robot, post=post, home=home, at_home=False, now_s=now_s)

    def leads(self, robot: str) -> Lane | None:
        """The corridor that the schedule has this robot enter next: home, when there is nothing else to do, or aside.
        None: it stays."""
        journey = self._journeys.get(robot)
        return next((leg.lane for leg in journey.legs[1:] if leg.lane is not None), None) if journey else None

    # How it is done.

    def journeys_of_others(self, robot: str, now_s: float) -> dict[str, Journey]:
        """The schedule from now on without this robot, but with the room that it leaves it to come home. Timed as if
        it were not there others might shut it in, and then nothing more could be put in."""
        return {name: journey for name, journey in self.journeys(now_s).items() if name != robot}

    def _answer(self, robot: str, now_s: float) -> Answer:
        its, journey = self._robots[robot], self._journeys.get(robot)
        lane = its.claim
        if lane is None:
            raise LookupError(f"{robot} has claimed nothing")
        if self._docks_next(robot):
            self.docked(robot)
            journey = self._journeys[robot]
        coming = journey.legs[1] if journey is not None and len(journey.legs) > 1 else None
        if coming is None or coming.lane != lane:
            its.claim = None
            return Denied(lane, None if coming is None else coming.lane)
        others = self._waits_for(robot, now_s)
        if others or its.start.lane is not None:
            return Waits(lane, others, self.journeys(now_s)[robot].legs[1].enter_s)
        unserved = self._serves_now(robot) > 0
        self._lets_in(robot, lane, now_s)
        if unserved:  # it goes without them, and has to come back
            self._plan_all(now_s)
        return Granted(lane)

    def _waits_for(self, robot: str, now_s: float) -> tuple[str, ...]:
        starts = {name: other.start for name, other in self._robots.items()}
        # The frozen are among them, so that their bays must not be missing a second time.
        return tuple(dict.fromkeys(waits_for(self._whole, starts, self._journeys, robot, now_s)))

    def _lets_in(self, robot: str, lane: Lane, now_s: float) -> None:
        its, coming = self._robots[robot], self._journeys[robot].legs[1]
        its.claim = None
        its.start = further(its.start, lane, at_home=coming.at_home, now_s=now_s)
        self._journeys[robot] = without_first(self._journeys[robot])

    def _may_go_on(self, robot: str, lane: Lane, now_s: float) -> bool:
        """Where robots follow each other the order in which they go in is only known when they do."""
        start, legs = self._robots[robot].start, self._journeys[robot].legs
        if len(legs) < 2 or legs[1].lane != lane or legs[0].goals or start.at_home or start.lane is None:
            return False
        passed = {one.post for one in start.before} | {start.post, start.lane.start}
        follows = lane.following_s is not None or start.lane.following_s is not None
        return not follows and lane.end not in passed and not self._waits_for(robot, now_s)

    def _is_full(self, post: int) -> bool:
        return is_full(self._whole, post, self._robots.values())

    def _docks_next(self, robot: str) -> bool:
        journey = self._journeys.get(robot)
        return journey is not None and len(journey.legs) > 1 and journey.legs[1].lane is None

    def _serves_now(self, robot: str) -> int:
        """Count its goals that are to be served where it is."""
        journey = self._journeys.get(robot)
        later = 0 if journey is None else sum(leg.goals for leg in journey.legs[1:])
        return len(self._robots[robot].goals) - later

    def _leads_through(self, robot: str, lane: Lane) -> bool:
        journey = self._journeys.get(robot)
        return journey is not None and any(leg.lane == lane for leg in journey.legs[1:])

    def _plan_all(self, now_s: float) -> None:
        """Plan all anew, as far as it can be: closures or robots have changed."""
        self._network = open_network(self._whole, self._closed, self._robots.values())
        for robot in self._robots.values():
            robot.goals_wait = robot.stays = False
        wanted = self.tasks(now_s)
        found, planned = plan_what_can_be(self._network, wanted, self._rng)
        for name, task in planned.items():
            self._robots[name].goals_wait = len(task.goals) < len(wanted[name].goals)
            self._robots[name].stays = task.home != wanted[name].home
        if not (self._takes(planned, self._better(planned, found, ROUNDS)) or self._takes(planned, found)):
            raise UnsoundSchedule("; ".join(problems(self._network, planned, found.journeys)))

    def _try_again(self, now_s: float) -> None:
        """A robot has moved: one that could not be planned for may have a way now."""
        if any(robot.stays for robot in self._robots.values()):
            self._plan_all(now_s)
        for name, robot in self._robots.items():
            if robot.goals_wait and not robot.frozen:
                self.give(name, robot.goals, now_s, rounds=0)

    def _better(self, tasks: Mapping[str, Task], found: Schedule, rounds: int) -> Schedule:
        left = iter(range(rounds))
        return improve(self._network, tasks, found, self._rng, lambda: next(left, None) is not None)

    def _takes(self, tasks: Mapping[str, Task], schedule: Schedule) -> bool:
        if problems(self._network, tasks, schedule.journeys):
            return False
        self._journeys = dict(schedule.journeys)
        return True
