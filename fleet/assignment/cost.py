"""Cost of a plan, in seconds of one robot: the time that the schedule takes, driving, and mail on its way; less
what it is worth to have these orders under way rather than waiting."""

from fleet.assignment.problem import AssignmentProblem, OpenOrder, Route, Routes
from fleet.assignment.routes import leaves_s, weight_of
from fleet.schedule.planning import Schedule, Tasks


def plan_cost_s(problem: AssignmentProblem, routes: Routes, tasks: Tasks, schedule: Schedule) -> float:
    return busy_s(problem, tasks, schedule) + beside_s(problem, routes)


def busy_s(problem: AssignmentProblem, tasks: Tasks, schedule: Schedule) -> float:
    """Return the time that the robots work from now on, added up: waiting for each other included."""
    return schedule.cost_s - problem.now_s * at_work(tasks)


def at_work(tasks: Tasks) -> int:
    return sum(1 for task in tasks.values() if task.goals)


def beside_s(problem: AssignmentProblem, routes: Routes) -> float:
    """Everything in the cost of a plan that does not depend on the schedule."""
    return sum(route_s(problem, name, route) for name, route in routes.items() if route)


def route_s(problem: AssignmentProblem, name: str, route: Route) -> float:
    rules = problem.rules
    driving_s = problem.drive_s(problem.robots[name].start.post, route)
    flow_s, worth_s = 0.0, 0.0
    for stop, at_s in zip(route, leaves_s(problem, name, route)[1:], strict=True):
        if stop.change < 0:
            flow_s += weight_of(problem, stop.order) * at_s
            order = problem.orders.get(stop.order)
            worth_s += 0.0 if order is None else order_worth_s(problem, order)
    return rules.driving * driving_s + rules.flow * flow_s - worth_s


def order_worth_s(problem: AssignmentProblem, order: OpenOrder) -> float:
    """Return the least cost of an order, wherever a robot comes from, so that long ones are no worse than short ones;
    and what it has waited, so that none waits for ever."""
    rules = problem.rules
    carrying_s = problem.network.shortest_s[order.load.post][order.give.post]
    least_s = carrying_s + order.load.handling_s + order.give.handling_s
    waited_s = max(0.0, problem.now_s - order.since_s)
    return least_s + rules.driving * carrying_s + order.weight * (rules.flow * least_s + rules.waiting * waited_s)
