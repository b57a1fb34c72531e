"""Of many waiting orders some are candidates: none is passed over for long, and no near one is overlooked."""

from dataclasses import replace

from fleet.assignment.candidates import LONGEST, candidates, waiting_orders
from fleet.assignment.problem import OpenOrder, RobotAtWork
from tests.app.dispatch.fleet_life import order
from tests.app.dispatch.test_fleet_plan import decided, problem_of, robot, street

FAR = [order(number, 20, 21, since_s=-1000.0 - number) for number in range(50)]
NEAR = order(100, 1, 2)


def looked_at(robots: dict[str, RobotAtWork], orders: list[OpenOrder]) -> list[str]:
    problem = problem_of(street(22), robots, orders)
    routes = {name: one.route for name, one in robots.items()}
    return [one.id for one in candidates(problem, routes, waiting_orders(problem, routes))]


def test_those_that_have_waited_longest_are_looked_at_and_those_near_a_robot_with_room() -> None:
    looked = looked_at({"r0": robot(0)}, [*FAR, NEAR])
    assert looked[:LONGEST] == [one.id for one in reversed(FAR)][:LONGEST]
    assert looked[-1] == NEAR.id
    assert len(looked) < len(FAR)


def test_what_is_heavier_has_waited_longer() -> None:
    heavy = replace(NEAR, weight=3.0, since_s=-400.0)
    assert looked_at({"r0": robot(0)}, [*FAR, heavy])[0] == heavy.id


def test_near_where_a_robot_ends_counts_and_near_one_without_room_does_not() -> None:
    ahead = order(200, 0, 10)
    beside_its_end = order(101, 10, 9)
    going = robot(0, route=ahead.stops, capacity=2)
    assert looked_at({"r0": going}, [*FAR, ahead, beside_its_end])[-1] == beside_its_end.id
    assert looked_at({"r0": replace(going, capacity=1)}, [*FAR, ahead, beside_its_end])[-1] != beside_its_end.id


def test_orders_that_a_robot_may_not_have_do_not_hide_the_one_it_may() -> None:
    others = [replace(order(300 + number, 1, 2), avoided=frozenset({"r0"})) for number in range(9)]
    allowed = order(400, 3, 4)
    assert allowed.id in looked_at({"r0": robot(0)}, [*FAR, *others, allowed])


def test_what_does_not_fit_any_more_once_a_robot_has_something_else_is_left() -> None:
    """One to the left and one to the right: there is charge for either, not for both."""
    left, right = order(0, 3, 1), order(1, 3, 6)
    for drives_s, orders in ((500.0, 1), (900.0, 1), (1000.0, 2)):
        problem = problem_of(street(8), {"r0": robot(3, capacity=2, drives_s=drives_s)}, [left, right])
        assert len(decided(problem).robot_of()) == orders
