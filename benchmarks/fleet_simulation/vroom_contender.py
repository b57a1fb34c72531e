"""A route optimiser in the planner's place: VROOM, solved anew for all robots at every look.

It knows ways and stops, no conflicts, and minimises driving. The first order of each route goes to its robot once that
has room; the service gives it out and schedules it as it does what its own planner decides. Each robot is given no more
than its share of the waiting orders, or it would leave robots idle.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import ceil
from random import Random

import numpy as np
import vroom

from benchmarks.fleet_simulation.service import PlansInRounds
from fleet.assignment.candidates import waiting_orders
from fleet.assignment.deciding import Decision, tidied
from fleet.assignment.horizon import look_ahead
from fleet.assignment.problem import AssignmentProblem, OpenOrder, RobotAtWork
from fleet.assignment.routes import room
from fleet.assignment.timing import time_first
from fleet.schedule.planning import improve

EXPLORATION = 5
"""The most that it does by default."""
NEVER_S = 10_000_000


class VroomOfAll(PlansInRounds):
    """Its improvements are of timetables alone, in as many rounds as ours."""

    async def decided(self, problem: AssignmentProblem, rng: Random) -> Decision | None:
        tidy = tidied(problem)
        routes = {name: robot.route for name, robot in tidy.robots.items()}
        waiting = waiting_orders(tidy, routes)
        for name, order in next_orders(tidy, waiting).items():
            if room(tidy, name, routes[name]) > 0:
                routes[name] = (*routes[name], *order.stops)
        outlook = look_ahead(tidy, routes, ())
        timed = time_first(tidy, routes, rng, outlook.weights)
        if timed is None:
            return None
        return Decision(tidy, timed, outlook, outlook.cost_of(timed.schedule), tuple(one.id for one in waiting))

    async def improved(self, decision: Decision, budget_s: float) -> Decision | None:
        left, timed = iter(range(self.rounds)), decision.timed
        network = decision.problem.network
        better = improve(network, timed.tasks, timed.schedule, self.rng, lambda: next(left, None) is not None)
        cost_s = decision.outlook.cost_of(better)
        return replace(decision, timed=replace(timed, schedule=better), cost_s=cost_s)


def next_orders(problem: AssignmentProblem, waiting: Sequence[OpenOrder]) -> Mapping[str, OpenOrder]:
    """For each robot the first order of its route, if it has one."""
    able = [name for name, robot in problem.robots.items() if robot.accepts]
    if not able or not waiting:
        return {}
    question = vroom.Input()
    seconds = np.array(problem.network.shortest_s)
    question.set_durations_matrix("car", np.where(np.isfinite(seconds), seconds, NEVER_S).round().astype(np.uint32))
    share = 2 * ceil(len(waiting) / len(able))
    for number, name in enumerate(able):
        post, soonest_s = _free(problem, name, problem.robots[name])
        window = vroom.TimeWindow(int(soonest_s), NEVER_S)
        question.add_vehicle(vroom.Vehicle(number, post, capacity=[1], time_window=window, max_tasks=share))
    for number, order in enumerate(waiting):
        load, give = (
            vroom.ShipmentStep(number, goal.post, default_service=int(goal.handling_s))
            for goal in (order.load, order.give)
        )
        question.add_shipment(load, give, vroom.Amount([1]))
    routes = question.solve(exploration_level=EXPLORATION, nb_threads=1).routes
    loads = routes[routes["type"] == "pickup"].drop_duplicates("vehicle_id")
    pairs = zip(loads["vehicle_id"], loads["id"], strict=True)
    return {able[int(vehicle)]: waiting[int(number)] for vehicle, number in pairs}


def _free(problem: AssignmentProblem, name: str, robot: RobotAtWork) -> tuple[int, float]:
    """Where and how soon, in seconds from now, it has done what it has before it."""
    if not robot.route or problem.kept is None:
        return robot.start.post, max(0.0, robot.start.ready_s - problem.now_s)
    done_s = problem.kept.schedule.journeys[name].done_s
    return robot.route[-1].goal.post, max(0.0, done_s - problem.now_s)
