"""When orders that have no robot yet are likely to be given, one after the other: for estimates alone.

Each order of the queue, in its order there, goes to the robot that could give it first once it has done what it has.
No robot is told to do any of it.
"""

from collections.abc import Iterable
from math import inf

from fleet.assignment.candidates import waiting_orders
from fleet.assignment.deciding import Decision
from fleet.assignment.timing import served_s


def given_at_s(decision: Decision, robots: Iterable[str]) -> dict[str, float]:
    """The time of the problem at which the robot comes to the recipient's, by order; `robots`: those that may come."""
    problem, free = decision.problem, _free_from(decision, robots)
    shortest_s, given = problem.network.shortest_s, dict[str, float]()
    for order in waiting_orders(problem, decision.routes):
        comes = {
            name: max(at_s + shortest_s[post][order.load.post], order.load.not_before_s)
            for name, (at_s, post) in free.items()
            if order.may_go_with(name)
        }
        name = min(comes, key=lambda one: (comes[one], one), default=None)
        if name is None or comes[name] == inf:
            continue
        there_s = comes[name] + order.load.handling_s + shortest_s[order.load.post][order.give.post]
        if there_s < inf:
            given[order.id] = there_s
            free[name] = there_s + order.give.handling_s, order.give.post
    return given


def _free_from(decision: Decision, robots: Iterable[str]) -> dict[str, tuple[float, int]]:
    """When each robot has done what it has, and where."""
    problem, timed = decision.problem, decision.timed
    served = served_s(timed.tasks, timed.schedule)
    free = {}
    for name in robots:
        if name in problem.robots:
            goals, start = timed.tasks[name].goals, timed.tasks[name].start
            ready_s = max([start.ready_s, problem.now_s, *(served[goal.key] for goal in goals)])
            free[name] = ready_s, goals[-1].post if goals else start.post
    return free
