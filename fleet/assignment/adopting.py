"""Between planner and traffic: the traffic as an assignment problem, and a decision as what the traffic does."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import inf

from fleet.assignment.deciding import Decision
from fleet.assignment.problem import AssignmentProblem, Kept, OpenOrder, RobotAtWork, Route, Rules, Stop
from fleet.schedule.controller import TrafficController
from fleet.schedule.journey import Goal
from fleet.schedule.planning import Schedule, cost_s


@dataclass(frozen=True, slots=True)
class Able:
    """The work that a robot can take on, as in `RobotAtWork`; the schedule knows all else."""

    capacity: int = 1
    begun: int = 0
    accepts: bool = True
    drives_s: float = inf
    goes_beyond: bool = False


def problem_of(
    traffic: TrafficController,
    robots: Mapping[str, Able],
    orders: Mapping[str, OpenOrder],
    now_s: float,
    rules: Rules | None = None,
) -> AssignmentProblem:
    """Every robot that can be planned for; those that `robots` does not name get nothing new. The goals of the traffic
    are stops of orders by their keys; any other is what the robot does for reasons of its own."""
    tasks, journeys = traffic.tasks_and_journeys(now_s)
    stops = {stop.goal.key: stop for order in orders.values() for stop in order.stops}
    at_work = {}
    for name, task in tasks.items():
        able = robots.get(name) or Able(accepts=False)
        left = {goal.key: goal for goal in task.goals}  # of what it has begun the rest
        route = _route((left.get(goal.key, goal) for goal in traffic.goals(name)), stops)
        at_work[name] = RobotAtWork(
            task.start, task.home, able.capacity, route, able.begun, able.accepts, able.drives_s, able.goes_beyond
        )
    first_done = tuple(sorted(tasks, key=lambda name: journeys[name].done_s))
    kept = Kept(
        {name: task.goals for name, task in tasks.items()}, Schedule(journeys, cost_s(tasks, journeys), first_done)
    )
    return AssignmentProblem(now_s, traffic.network, at_work, orders, kept, rules or Rules())


def adopt(traffic: TrafficController, decision: Decision, robots: Iterable[str], now_s: float) -> bool:
    """Has the traffic do what was decided, if that can still be done; else nothing changes. What no way leads to stays
    with its robot; of `robots` that could not be planned for, what another has been given is taken."""
    timed = decision.timed
    given = {goal.key for task in timed.tasks.values() for goal in task.goals}
    if given & _served_since(traffic, decision):
        return False
    stays = {stop.goal.key for route in decision.cut_off.values() for stop in route}
    # What it is to do and cannot be planned for at the moment: it keeps it, the other half of an order too.
    stays |= {stop.goal.key for route in decision.routes.values() for stop in route} - given
    # What is aboard and has no place in the schedule now is not lost either.
    stays |= {order.give.key for order in decision.problem.orders.values() if order.loaded} - given
    goals = {
        name: (*task.goals, *(goal for goal in traffic.goals(name) if goal.key in stays))
        for name, task in timed.tasks.items()
    }
    for name in set(robots) - goals.keys():
        goals[name] = tuple(goal for goal in traffic.goals(name) if goal.key not in given)
    return traffic.adopt(goals, timed.schedule, now_s)


def _served_since(traffic: TrafficController, decision: Decision) -> set[str]:
    """Goals that robots had when the decision was begun and have no more: they are behind them, or were given up."""
    had = {stop.goal.key for robot in decision.problem.robots.values() for stop in robot.route}
    return had - {goal.key for name in decision.problem.robots for goal in traffic.goals(name)}


def _route(goals: Iterable[Goal], stops: Mapping[str, Stop]) -> Route:
    return tuple(stops.get(goal.key, Stop("", goal, 0))._replace(goal=goal) for goal in goals)
