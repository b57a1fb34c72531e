"""From the stops of all robots to a schedule that serves them, looked at independently before it counts."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from random import Random

from fleet.assignment.cost import SLACK_S
from fleet.assignment.problem import AssignmentProblem, Kept, Routes
from fleet.schedule.journey import Journey, Task
from fleet.schedule.planning import Insertion, Schedule, Tasks, cost_s, first_plan, plan
from fleet.schedule.validation import problems

Weights = Mapping[str, float]
"""By robot, what its task weighs; 1.0 where nothing is said."""


@dataclass(frozen=True, slots=True)
class Timed:
    """Routes with the schedule that serves them. `refused`: robots whose new stops found no place in it, so that it
    has them do what they did before."""

    routes: Routes
    tasks: Tasks
    schedule: Schedule
    refused: frozenset[str] = frozenset()


def tasks_of(problem: AssignmentProblem, routes: Routes, weights: Weights) -> dict[str, Task]:
    return {name: robot.task(routes[name], weights.get(name, 1.0)) for name, robot in problem.robots.items()}


def changed(tasks: Tasks, kept: Kept) -> list[str]:
    """Robots whose goals are not those that the kept schedule serves."""
    there = kept.schedule.journeys.keys()
    return sorted(name for name, task in tasks.items() if name not in there or kept.goals.get(name) != task.goals)


def time_first(problem: AssignmentProblem, routes: Routes, rng: Random, weights: Weights) -> Timed | None:
    """The first schedule for these routes that is found: what is kept stays, and new work is planned round it.

    None only if nothing is kept, or if that is void, and not everybody can come home either.
    """
    tasks = tasks_of(problem, routes, weights)
    if problem.kept is not None:
        schedule = _round_what_is_kept(problem, tasks, problem.kept)
        if schedule is not None:
            return Timed(routes, tasks, schedule)
        timed = _one_by_one(problem, tasks, routes, problem.kept)
        if timed is not None:
            return timed
    anew = sound(problem, tasks, first_plan(problem.network, tasks, rng))
    return None if anew is None else Timed(routes, tasks, anew)


def _round_what_is_kept(problem: AssignmentProblem, tasks: Tasks, kept: Kept) -> Schedule | None:
    new = changed(tasks, kept)
    if not new:
        return sound(problem, tasks, of_robots(kept.schedule, tasks))
    # Where there is no room beside what is kept, planning all of it anew hardly ever finds any: in 2 of 674 decisions.
    found = plan(problem.network, tasks, new, kept.schedule.journeys)
    if found is None or not keeps_promises(_promised_s(problem, tasks, kept), overdue_s(problem, tasks, found)):
        return None
    order = in_order(kept.schedule.order, tasks, last=new)
    return sound(problem, tasks, Schedule(found.journeys, found.cost_s, order))


def _promised_s(problem: AssignmentProblem, tasks: Tasks, kept: Kept) -> Mapping[str, float]:
    """Return the times that the kept schedule promises to overdue orders."""
    there = tasks.keys() & kept.schedule.journeys.keys()
    served = {name: replace(tasks[name], goals=kept.goals.get(name, ())) for name in there}
    return overdue_s(problem, served, kept.schedule)


def keeps_promises(promised_s: Mapping[str, float], now_s: Mapping[str, float]) -> bool:
    """Tell if no overdue order that is still to be delivered is delivered later than before."""
    return all(now_s[order] <= at_s + SLACK_S for order, at_s in promised_s.items() if order in now_s)


def _one_by_one(problem: AssignmentProblem, new: Tasks, routes: Routes, kept: Kept) -> Timed | None:
    """Each robot's new work behind everything else, where it can always be put, unless what it has before it is overdue
    and would come later by that."""
    tasks = {name: replace(task, goals=kept.goals.get(name, ())) for name, task in new.items()}
    schedule = sound(problem, tasks, of_robots(kept.schedule, tasks))
    if schedule is None:
        return None
    refused, promised_s = set(), _promised_s(problem, tasks, kept)
    with_new = Insertion(problem.network, tasks, schedule.journeys)
    for name in changed(new, kept):
        before = with_new.journeys[name]
        if not with_new.put(name, new[name]):
            refused.add(name)
        elif not keeps_promises(promised_s, overdue_s(problem, with_new.tasks, with_new.schedule())):
            with_new.put_back(name, tasks[name], before)
            refused.add(name)
    found = sound(problem, with_new.tasks, with_new.schedule())
    return None if found is None else Timed(routes, with_new.tasks, found, frozenset(refused))


def sound(problem: AssignmentProblem, tasks: Tasks, schedule: Schedule | None) -> Schedule | None:
    """The schedule, if there is nothing wrong with it."""
    if schedule is None or problems(problem.network, tasks, schedule.journeys):
        return None
    return schedule


def of_robots(schedule: Schedule, tasks: Tasks) -> Schedule | None:
    """Without robots that have left; None if one that is there has no journey."""
    if tasks.keys() - schedule.journeys.keys():
        return None
    journeys = {name: schedule.journeys[name] for name in tasks}
    return Schedule(journeys, cost_s(tasks, journeys), in_order(schedule.order, tasks))


def in_order(order: Sequence[str], tasks: Iterable[str], last: Sequence[str] = ()) -> tuple[str, ...]:
    """The robots there are, in this order; behind them those that it does not name, and then the `last`."""
    names = set(tasks)
    known = [name for name in order if name in names and name not in last]
    return (*known, *sorted(names - set(known) - set(last)), *last)


def served_s(tasks: Tasks, schedule: Schedule) -> dict[str, float]:
    """When each goal is served, by its key."""
    return {key: at_s for name, task in tasks.items() for key, at_s in _served(task, schedule.journeys[name])}


def _served(task: Task, journey: Journey) -> Iterable[tuple[str, float]]:
    goals = iter(task.goals)
    for number, leg in enumerate(journey.legs):
        now_s = task.start.ready_s if number == 0 else leg.stands_s
        for goal in islice(goals, leg.goals):
            now_s = max(now_s, goal.not_before_s) + goal.handling_s
            yield goal.key, now_s


def overdue_s(problem: AssignmentProblem, tasks: Tasks, schedule: Schedule) -> Mapping[str, float]:
    """When the mail of each order that has waited too long is given, by order."""
    late = {order.give.key: order.id for order in problem.orders.values() if problem.is_overdue(order.id)}
    if not late:
        return {}
    return {late[key]: at_s for key, at_s in served_s(tasks, schedule).items() if key in late}
