"""Schedules for all robots: one after the other, each round those before it; and better ones, by doing some again.

A schedule is whole: every journey ends at home. A caller that keeps the one it has until there is a better one always
has one that can be carried out. First everybody's work is planned, with robots left standing where their work ends, and
then everybody's way home: it is needed only to be sure that there is one, and must not be in the way of work.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import inf
from random import Random
from typing import Final

from fleet.schedule.evacuation import evacuate
from fleet.schedule.journey import Journey, Task, staying
from fleet.schedule.neighbourhood import neighbourhood
from fleet.schedule.network import Network
from fleet.schedule.occupied import Occupied
from fleet.schedule.search import find_work
from fleet.schedule.ways_home import WaysHome

Tasks = Mapping[str, Task]
Journeys = Mapping[str, Journey]
WORTH_S: Final = 1e-3
"""What is better by less is not better: sums of times are not exact."""

Pause = Callable[[], None]
"""Called between one robot and the next; what it raises ends the planning."""


def no_pause() -> None:
    pass


@dataclass(frozen=True)
class Schedule:
    """A journey for every robot. `cost_s`: as `cost_s` has it. `order`: in which order they were planned, most favoured
    first; what is better is looked for near it."""

    journeys: Journeys
    cost_s: float
    order: tuple[str, ...] = ()


def cost_s(tasks: Tasks, journeys: Journeys) -> float:
    """The times at which robots with goals have done them, added up, each as often as its task weighs."""
    return sum(task.weight * journeys[name].done_s for name, task in tasks.items() if task.goals and name in journeys)


@dataclass
class _Attempt:
    network: Network
    tasks: Tasks
    taken: Occupied
    work: dict[str, Journey] = field(default_factory=dict)
    cost_s: float = 0.0

    def keep(self, robot: str, journey: Journey) -> None:
        self.taken.put(robot, journey.work)
        self._add(robot, Journey(journey.work, (), journey.done_s))

    def plan_work(self, robot: str, within_s: float) -> bool:
        """Its work round all that is taken, if that costs less than this."""
        task = self.tasks[robot]
        self.taken.remove(robot)
        by_s = (within_s - self.cost_s) / task.weight if task.goals else inf
        found = find_work(self.network, self.taken, task.start, task.goals, task.home, by_s)
        if found is None:
            return False
        self.taken.put(robot, found.legs)
        self._add(robot, Journey(found.legs, (), found.done_s))
        return True

    def _add(self, robot: str, journey: Journey) -> None:
        self.work[robot] = journey
        if self.tasks[robot].goals:
            self.cost_s += self.tasks[robot].weight * journey.done_s


def plan(
    network: Network,
    tasks: Tasks,
    order: Sequence[str],
    kept: Journeys | None = None,
    within_s: float = inf,
    pause: Pause = no_pause,
) -> Schedule | None:
    """The first robot of `order` goes where it likes, each further one round those before it; those that are not in it
    work as they do in `kept`. None if one finds no way, or if it costs `within_s` or more.
    """
    attempt = _Attempt(network, tasks, _taken_on_the_way(network, tasks))
    for robot in sorted(tasks.keys() - set(order)):  # a set has no order that is the same in every process
        attempt.keep(robot, (kept or {})[robot])
    for robot in order:
        attempt.taken.hold(robot, tasks[robot].start, tasks[robot].start.ready_s)
    for robot in order:
        pause()
        if not attempt.plan_work(robot, within_s):
            return None
    if attempt.cost_s >= within_s:
        return None
    as_before = {robot: kept[robot] for robot in tasks.keys() - set(order)} if kept else {}
    journeys = WaysHome(network, tasks, attempt.taken, attempt.work, pause).plan(as_before)
    return None if journeys is None else Schedule(journeys, attempt.cost_s, tuple(order))


def insert(network: Network, tasks: Tasks, kept: Journeys, robot: str) -> Schedule | None:
    """One robot's task planned anew round all that the others do, their ways home included.

    Found whenever `kept` is whole and a way leads to each goal: when all others are at home nothing is in the way, so
    any order can be taken on at any time, if only late.
    """
    others = Insertion(network, tasks, {other: kept[other] for other in sorted(tasks.keys() - {robot})})
    return others.schedule() if others.put(robot, tasks[robot]) else None


class Insertion:
    """One robot after the other gets another task, and is planned anew as `insert` does it. `tasks`: of all robots;
    `journeys`: of those that are planned."""

    def __init__(self, network: Network, tasks: Tasks, journeys: Journeys) -> None:
        self._network = network
        self.tasks, self.journeys = dict(tasks), dict(journeys)
        self._taken = _taken_on_the_way(network, tasks)
        for robot in tasks:
            self._take(robot)

    def put(self, robot: str, task: Task) -> bool:
        """False if no way is found: all stays as it was."""
        self._taken.remove(robot)
        found = self._planned(robot, task)
        if found is None:
            self.put_back(robot, self.tasks[robot], self.journeys.get(robot))
            return False
        self.tasks[robot], self.journeys[robot] = task, found
        return True

    def put_back(self, robot: str, task: Task, journey: Journey | None) -> None:
        """This again, which it had before."""
        self._taken.remove(robot)
        self.tasks[robot] = task
        if journey is not None:
            self.journeys[robot] = journey
        self._take(robot)

    def schedule(self) -> Schedule:
        return Schedule(dict(self.journeys), cost_s(self.tasks, self.journeys), tuple(sorted(self.tasks)))

    def _take(self, robot: str) -> None:
        """Its journey; of one that has none what it has now, for as long as it needs to begin one."""
        if robot in self.journeys:
            self._taken.put(robot, self.journeys[robot].legs)
        else:
            self._taken.hold(robot, self.tasks[robot].start, self.tasks[robot].start.ready_s)

    def _planned(self, robot: str, task: Task) -> Journey | None:
        work = find_work(self._network, self._taken, task.start, task.goals, task.home)
        if work is None:
            return None
        self._taken.put(robot, work.legs)
        journey = Journey(work.legs, (), work.done_s)
        ways_home = WaysHome(self._network, {robot: task}, self._taken, {robot: journey}, no_pause)
        return ways_home.way_home(robot) if ways_home.must_go_home(robot) else journey


def first_plan(network: Network, tasks: Tasks, rng: Random, tries: int = 20) -> Schedule | None:
    """Some schedule, with nothing to go by; None if not everybody can come home, or some goal cannot be reached."""
    order = sorted(tasks)
    for _ in range(tries):
        found = plan(network, tasks, order)
        if found is not None:
            return found
        rng.shuffle(order)
    return _one_after_the_other(network, tasks)


def plan_what_can_be(network: Network, tasks: Tasks, rng: Random) -> tuple[Schedule, dict[str, Task]]:
    """A schedule in any case, and the tasks that it is of: where not all can be done some robots are without goals for
    now, and if not everybody comes home some stay where they are."""
    found = first_plan(network, tasks, rng)
    if found is not None:
        return found, dict(tasks)
    schedule, planned = _home_who_can(network, tasks, rng)
    for robot in sorted(tasks):
        more = {**planned, robot: replace(planned[robot], goals=tasks[robot].goals)}
        with_it = insert(network, more, schedule.journeys, robot) if tasks[robot].goals else None
        if with_it is not None:
            schedule, planned = with_it, more
    return schedule, planned


def _home_who_can(network: Network, tasks: Tasks, rng: Random) -> tuple[Schedule, dict[str, Task]]:
    """As many robots home as can be, without goals; the others stay where they stand. First each goes round those that
    stay; then others also make way for it, if all that were to come home still do."""
    planned = {robot: Task(task.start, (), None) for robot, task in tasks.items()}
    stays = {robot: staying(task.start) for robot, task in tasks.items()}
    schedule = Schedule(stays, 0.0, tuple(sorted(tasks)))

    def goes_round(more: Tasks, robot: str) -> Schedule | None:
        return insert(network, more, schedule.journeys, robot)

    def has_others_make_way(more: Tasks, _robot: str) -> Schedule | None:
        return first_plan(network, more, rng, tries=1)

    away = _nearest_home_first(network, tasks)
    for look in (goes_round, has_others_make_way):
        went = True
        while went:  # one that has gone is in the way no more
            went = False
            for robot in tuple(away):
                more = {**planned, robot: replace(planned[robot], home=tasks[robot].home)}
                found = look(more, robot)
                if found is not None:
                    schedule, planned, went = found, more, True
                    away.remove(robot)
    return schedule, planned


def _nearest_home_first(network: Network, tasks: Tasks) -> list[str]:
    ways_s = {
        robot: network.shortest_s[task.start.post][task.home] for robot, task in tasks.items() if task.home is not None
    }
    return sorted(ways_s, key=lambda robot: (ways_s[robot], robot))


def _one_after_the_other(network: Network, tasks: Tasks) -> Schedule | None:
    """First everybody home; then each robot's work is put in."""
    ways_home = evacuate(network, tasks)
    if ways_home is None:
        return None
    so_far = {robot: Task(task.start, (), task.home) for robot, task in tasks.items()}
    schedule = Schedule(ways_home, 0.0, tuple(sorted(tasks)))
    for robot in sorted(tasks):
        if tasks[robot].goals:
            so_far[robot] = tasks[robot]
            found = insert(network, so_far, schedule.journeys, robot)
            if found is None:
                return None
            schedule = found
    return schedule


def improve(
    network: Network,
    tasks: Tasks,
    best: Schedule,
    rng: Random,
    go_on: Callable[[], bool],
    worth_s: float = WORTH_S,
    pause: Pause = no_pause,
) -> Schedule:
    """The best schedule found while it goes on: some robots or all are planned again in another order."""
    while best.order and go_on():
        order = neighbourhood(network, tasks, best.journeys, best.order, rng)
        found = plan(network, tasks, order, best.journeys, best.cost_s - worth_s, pause)
        if found is not None:
            left = [robot for robot in best.order if robot not in found.order]
            best = Schedule(found.journeys, found.cost_s, (*left, *found.order))
    return best


def _taken_on_the_way(network: Network, tasks: Tasks) -> Occupied:
    """Return what robots hold of the ways to where their journeys begin; it is not planned, and no plan may take it
    out again."""
    taken = Occupied(network)
    for robot, task in tasks.items():
        for start in task.start.on_the_way():
            taken.hold(f"{robot} on its way", start, start.ready_s)
        for post, until_s in task.start.crossings():
            taken.cross(f"{robot} on its way", post, task.start.entered_s, until_s)
    return taken
