"""First assignment: the near robot does not take an order when another order can spare it less."""

from dataclasses import replace
from itertools import combinations_with_replacement
from math import inf
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fleet.assignment.problem import AssignmentProblem, OpenOrder, Route, Stop
from fleet.assignment.routes import NO_FIT, Fit, leaves_s, line, orders_of, with_order
from tests.app.dispatch.fleet_life import order
from tests.app.dispatch.test_fleet_plan import decided, problem_of, robot, street
from tests.fleet.schedule.test_schedules import random_network


def test_the_order_that_would_lose_most_is_given_first() -> None:
    """The one nearest to a robot would be that one's, if the other did not have to wait for one from far away."""
    near, would_lose = order(0, 5, 6), order(1, 2, 1)
    problem = problem_of(street(10), {"r0": robot(4), "r1": robot(9)}, [near, would_lose])
    after = decided(problem)
    assert after.robot_of() == {near.id: "r1", would_lose.id: "r0"}


def test_an_order_that_only_one_robot_may_have_does_not_come_before_everything_else() -> None:
    near, wanted = order(0, 1, 2), replace(order(1, 12, 13), wanted=frozenset({"r0"}))
    problem = problem_of(street(30), {"r0": robot(0), "r1": robot(29)}, [near, wanted])
    assert decided(problem).robot_of()[near.id] == "r0"


def some_route(rng: Random, posts: range, capacity: int) -> tuple[Route, list[OpenOrder]]:
    """Orders whose stops lie as they like between each other, some of them aboard already."""
    route: list[Stop] = []
    orders = [order(number, *rng.sample(posts, 2)) for number in range(rng.randint(0, 4))]
    orders = [replace(one, loaded=rng.random() < 0.3, weight=rng.choice((1.0, 3.0))) for one in orders]
    ahead = [one for one in orders if not one.loaded]
    held = [one for one in orders if one.loaded][:capacity]
    orders = [*ahead, *held]
    while ahead or held:
        if ahead and len(held) < capacity and (not held or rng.random() < 0.5):
            held.append(ahead.pop())
            route.append(held[-1].stops[0])
        else:
            route.append(held.pop(rng.randrange(len(held))).stops[1])
    return tuple(route), orders


def holds(problem: AssignmentProblem, name: str, route: Route) -> bool:
    """Never more aboard than the robot can carry, and home again with its charge."""
    its = problem.robots[name]
    aboard = len(orders_of(route)) - sum(1 for stop in route if stop.change > 0)
    for stop in route:
        aboard += stop.change
        if aboard > its.capacity:
            return False
    last = route[-1].goal.post
    return problem.drive_s(its.start.post, route) + problem.network.shortest_s[last][its.home or 0] <= its.drives_s


def whole_cost_s(problem: AssignmentProblem, name: str, route: Route) -> float:
    """Until all is done, until each order is given, and driving."""
    leaves = leaves_s(problem, name, route)
    given = [(stop.order, at_s) for stop, at_s in zip(route, leaves[1:], strict=True) if stop.change < 0]
    weights = {one.id: one.weight for one in problem.orders.values()}
    waits_s = sum(weights[one] * at_s for one, at_s in given)
    return leaves[-1] + waits_s + problem.rules.driving * problem.drive_s(problem.robots[name].start.post, route)


def every_fit(problem: AssignmentProblem, name: str, route: Route, new: OpenOrder, first: int) -> list[Fit]:
    """Each pair of places, and what the whole route costs more for it."""
    before_s = whole_cost_s(problem, name, route)
    fits = []
    for load_at, give_at in combinations_with_replacement(range(first, len(route) + 1), 2):
        after = with_order(route, new, Fit(0.0, load_at, give_at))
        if holds(problem, name, after):
            fits.append(Fit(whole_cost_s(problem, name, after) - before_s, load_at, give_at))
    return fits


@settings(max_examples=150)
@given(st.randoms(use_true_random=False), st.integers(1, 4))
@pytest.mark.slow
def test_one_more_order_is_put_where_the_whole_route_costs_least(rng: Random, capacity: int) -> None:
    network = random_network(rng)
    posts = range(len(network.posts))
    route, orders = some_route(rng, posts, capacity)
    new = replace(order(9, *rng.sample(posts, 2)), weight=rng.choice((0.5, 2.0)))
    new = replace(new, load=new.load._replace(not_before_s=rng.choice((-inf, 100.0, 400.0))))
    begun = rng.randint(0, len(route))
    its = robot(rng.choice(posts), capacity=capacity, begun=begun, drives_s=rng.choice((inf, rng.uniform(0.0, 1000.0))))
    known = {one.id: one for one in (*orders, new)}
    problem = AssignmentProblem(0.0, network, {"r0": replace(its, route=route)}, known)
    fits = every_fit(problem, "r0", route, new, begun)
    found = line(problem, "r0", route).best_fit(new)
    if not fits:
        assert found is NO_FIT
        return
    least_s = min(fit.cost_s for fit in fits)
    assert found.cost_s == pytest.approx(least_s)
    assert found[1:] in [fit[1:] for fit in fits if fit.cost_s == pytest.approx(least_s)]
