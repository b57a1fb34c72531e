"""When orders that have no robot yet are likely to be given, one after the other, and when robots are free after that:
for estimates alone.

Each order of the queue, in its order there, goes to the robot that could give it first once it has done what it has.
No robot is told to do any of it.
"""

from collections.abc import Iterable, Mapping
from math import inf
from typing import NamedTuple

from fleet.assignment.candidates import waiting_orders
from fleet.assignment.deciding import Decision
from fleet.assignment.timing import served_s


class Likely(NamedTuple):
    """`comes_in_s`: until a robot comes to the recipient's, by order. `free`: in how many seconds each robot has
    nothing more to do, and at which post, by name."""

    comes_in_s: Mapping[str, float]
    free: Mapping[str, tuple[float, str]]


def foresee(decision: Decision, robots: Iterable[str]) -> Likely:
    """Look ahead for the orders that wait; `robots`: those that may come."""
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
    now_s, posts = problem.now_s, problem.network.posts
    return Likely(
        {order: at_s - now_s for order, at_s in given.items()},
        {name: (at_s - now_s, posts[post]) for name, (at_s, post) in free.items()},
    )


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
