"""The schedule of the robots that are there, kept whole through every change: a new order, a closure, a failure."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from random import Random
from typing import Final

from fleet.schedule.course import OutOfOrderError
from fleet.schedule.execution import caught_up, in_turn, one_behind_the_other, retimed, standing_in_turn, waits_for
from fleet.schedule.journey import Goal, Journey, Task, staying
from fleet.schedule.network import Network
from fleet.schedule.participant import Participant, open_network
from fleet.schedule.planning import Insertion, Schedule, first_plan, improve, insert, plan, plan_what_can_be
from fleet.schedule.turning import turn_round
from fleet.schedule.validation import problems

ROUNDS: Final = 10
"""So often something better is looked for after each change, unless the caller does that himself."""
TRIES: Final = 3
"""So many orders are tried of those that a change concerns, before all are planned again."""


class UnsoundSchedule(RuntimeError):
    """The search has made what the independent check refuses: a mistake of ours. No robot is let in by it; a caller
    that keeps the controller builds it anew."""


class LiveSchedule:
    """`network`: as it is open now: without closed corridors, and without what robots that stand still are in.
    `planned`: as it was made or retimed last; its order is what counts."""

    def __init__(self, network: Network, rng: Random) -> None:
        self.whole = self.network = network
        self.closed: frozenset[str] = frozenset()
        self.robots: dict[str, Participant] = {}
        self.planned: dict[str, Journey] = {}
        self._rng = rng
        self._last: tuple[Network, dict[str, Task], dict[str, Journey], dict[str, Journey]] | None = None

    def tasks(self, now_s: float) -> dict[str, Task]:
        """Every robot that can be planned for, as it is now: of its goals those that can be reached."""
        return self.tasks_and_journeys(now_s)[0]

    def journeys(self, now_s: float) -> dict[str, Journey]:
        """The schedule from now on."""
        return self._retimed(self._as_known(now_s))

    def tasks_and_journeys(self, now_s: float) -> tuple[dict[str, Task], dict[str, Journey]]:
        """Both of one moment."""
        tasks = self._as_known(now_s)
        journeys = self._retimed(tasks)
        return in_turn(tasks, journeys) if self.network.has_crossings else tasks, journeys

    def waits_for(self, robot: str, now_s: float, journey: Journey | None = None) -> tuple[str, ...]:
        """Return those that go on before this one may enter the next corridor of its journey."""
        starts = {name: other.start for name, other in self.robots.items()}
        journeys = self.planned if journey is None else {**self.planned, robot: journey}
        # The frozen are among them, so that their bays must not be missing a second time.
        return tuple(dict.fromkeys(waits_for(self.whole, starts, journeys, robot, now_s)))

    def give(self, robot: str, goals: Sequence[Goal], now_s: float, rounds: int) -> bool:
        """These are its goals from now on, if there is a schedule with them; else nothing changes."""
        its, before = self.robots[robot], replace(self.robots[robot])
        its.wants(goals, now_s)
        if its.stands_still:
            return True
        its.goals_wait = False
        tasks, kept = self.tasks_and_journeys(now_s)
        # The room that the schedule leaves it to come home stays: others might shut it in.
        del kept[robot]
        found = plan(self.network, tasks, [robot], kept) or insert(self.network, tasks, kept, robot)
        found = found or first_plan(self.network, tasks, self._rng)
        if found is None or not self._takes(tasks, self._better(tasks, found, rounds)):
            self.robots[robot] = before
            return False
        return True

    def adopt(self, goals: Mapping[str, Sequence[Goal]], schedule: Schedule, now_s: float) -> bool:
        """The same for several robots with a schedule that was worked out elsewhere, if it can still be carried out."""
        before = {name: replace(robot) for name, robot in self.robots.items()}
        for name, theirs in goals.items():
            self.robots[name].wants(self.robots[name].as_told(theirs), now_s)
        tasks = self._as_known(now_s)
        journeys = caught_up(self.network, tasks, schedule.journeys)
        if journeys is not None and self._takes(tasks, replace(schedule, journeys=journeys)):
            return True
        self.robots = before
        return False

    def plan_all(self, now_s: float) -> None:
        """Plan all anew, as far as it can be: closures or robots have changed."""
        self._open(now_s)
        for robot in self.robots.values():
            robot.goals_wait = robot.stays = False
        wanted = self._as_known(now_s)
        wanted = standing_in_turn(self.network, wanted) if self.network.has_crossings else wanted
        found, planned = plan_what_can_be(self.network, wanted, self._rng)
        for name, task in planned.items():
            self.robots[name].goals_wait = len(task.goals) < len(wanted[name].goals)
            self.robots[name].stays = task.home != wanted[name].home
        if not (self._takes(planned, self._better(planned, found, ROUNDS)) or self._takes(planned, found)):
            raise UnsoundSchedule("; ".join(problems(self.network, planned, found.journeys)))

    def plan_some(self, now_s: float, robots: Collection[str] = (), rounds: int = 0) -> None:
        """These robots want something else or are elsewhere, or something was shut or opened: plan them anew, and those
        whose way that was, round all others; if that fails, all."""
        if not self._lacks_a_plan():
            wanted = {name: _wants(task) for name, task in self._as_known(now_s).items()}
            self._open(now_s)
            tasks = self._as_known(now_s)
            concerned = [
                name
                for name, task in tasks.items()
                if name in robots or wanted.get(name) != _wants(task) or not self._is_open(name)
            ]
            if self._plan_round_others(tasks, concerned, rounds):
                return
        self.plan_all(now_s)

    def try_again(self, now_s: float) -> None:
        """A robot has moved: one that could not be planned for may have a way now."""
        if any(robot.stays or robot.is_shut_in for robot in self.robots.values()):
            self.plan_all(now_s)
        for name, robot in self.robots.items():
            if robot.goals_wait and not robot.stands_still:
                self.give(name, robot.goals, now_s, rounds=0)

    def _lacks_a_plan(self) -> bool:
        """Tell if a robot waits for a change before it can be planned for as it should be."""
        return any(robot.goals_wait or robot.stays or robot.is_shut_in for robot in self.robots.values())

    def _as_known(self, now_s: float) -> dict[str, Task]:
        robots = self.robots.items()
        tasks = {name: robot.task(self.network, now_s) for name, robot in robots if not robot.stands_still}
        return one_behind_the_other(tasks)

    def _retimed(self, tasks: Mapping[str, Task]) -> dict[str, Journey]:
        """At one moment the same is asked for again and again, by each robot that waits: the last answer is kept."""
        if self._last is None or self._last[0] is not self.network or self._last[1:3] != (tasks, self.planned):
            self._last = self.network, dict(tasks), dict(self.planned), retimed(self.network, tasks, self.planned)
        return dict(self._last[3])

    def _open(self, now_s: float) -> None:
        turn_round(self.whole, self.robots, now_s)
        network = open_network(self.whole, self.closed, self.robots.values())
        if network != self.network:  # what is known of one that is the same stays known: all its ways, above all
            self.network = network

    def _leads_on(self, name: str) -> bool:
        """Tell if the robot has a journey, and is where that leads."""
        return name in self.planned and self.robots[name].start.post == self.planned[name].legs[0].post

    def _is_open(self, name: str) -> bool:
        """Tell if it has one that leads on, and every corridor of that is open."""
        if not self._leads_on(name):
            return False
        lanes = [leg.lane for leg in self.planned[name].legs[1:] if leg.lane is not None]
        return all(lane in self.network.lanes[lane.start] for lane in lanes)

    def _plan_round_others(self, tasks: Mapping[str, Task], concerned: Collection[str], rounds: int) -> bool:
        """All of them at once, or else one by one: who finds no way goes before the others then."""
        again, kept = self._timed_before(tasks, concerned)
        in_time = in_turn(tasks, kept)
        found = plan(self.network, in_time, again, kept) or self._one_by_one(in_time, again, kept)
        if found is None:
            return False
        others = [name for name in tasks if name not in again]
        found = replace(found, order=(*again, *others))
        return self._takes(in_time, self._better(in_time, found, rounds))

    def _timed_before(
        self, tasks: Mapping[str, Task], concerned: Collection[str]
    ) -> tuple[list[str], dict[str, Journey]]:
        """Return who is to be planned again, and the journeys of all as they were, timed. Who has none stays where it
        is in that time, and so does who was to come there: it is planned again, too."""
        stay = {name for name in concerned if not self._leads_on(name)}
        while True:
            again = stay.union(concerned)
            still = {name: replace(task, goals=()) if name in again else task for name, task in tasks.items()}
            journeys = {name: staying(tasks[name].start) if name in stay else self.planned[name] for name in tasks}
            try:
                return sorted(again), retimed(self.network, still, journeys)
            except OutOfOrderError as error:
                stay.add(error.robot)

    def _one_by_one(
        self, tasks: Mapping[str, Task], again: Sequence[str], kept: Mapping[str, Journey]
    ) -> Schedule | None:
        order, others = [*again], {name: journey for name, journey in kept.items() if name not in again}
        for _ in range(TRIES):
            planned = Insertion(self.network, tasks, others)
            lost = next((name for name in order if not planned.put(name, tasks[name])), None)
            if lost is None:
                return planned.schedule()
            order.remove(lost)
            order.insert(0, lost)
        return None

    def _better(self, tasks: Mapping[str, Task], found: Schedule, rounds: int) -> Schedule:
        left = iter(range(rounds))
        return improve(self.network, tasks, found, self._rng, lambda: next(left, None) is not None)

    def _takes(self, tasks: Mapping[str, Task], schedule: Schedule) -> bool:
        if problems(self.network, tasks, schedule.journeys):
            return False
        self.planned = dict(schedule.journeys)
        return True


def _wants(task: Task) -> tuple[Iterable[tuple[str, int]], int | None]:
    return [(goal.key, goal.post) for goal in task.goals], task.home
