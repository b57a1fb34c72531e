"""Promises are kept: a schedule that does not hold is never carried out, and small gains change nothing."""

from dataclasses import replace
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fleet.assignment.improving import improved
from fleet.assignment.problem import AssignmentProblem, Kept, Rules
from fleet.assignment.timing import overdue_s
from fleet.schedule.network import Lane, Network
from fleet.schedule.validation import problems
from tests.app.dispatch.fleet_life import order, rounds
from tests.app.dispatch.test_fleet_plan import decided, problem_of, robot, street
from tests.fleet.schedule.test_schedules import random_network


def ring(posts: int) -> Network:
    lanes = tuple(
        (Lane(post, 0, post, (post + 1) % posts, 100.0), Lane((post - 1) % posts, 1, post, (post - 1) % posts, 100.0))
        for post in range(posts)
    )
    names = tuple(f"p{post}" for post in range(posts))
    return Network(names, (2,) * posts, names, lanes)


def test_a_kept_schedule_through_a_closed_corridor_is_not_carried_out() -> None:
    """The planner is not notified that it is void; it checks."""
    had, new = order(0, 1, 2), order(1, 4, 5)
    robots = {"r0": robot(0, route=had.stops), "r1": robot(4)}
    for orders in ([had], [had, new]):
        problem = problem_of(ring(7), robots, orders)
        closed = replace(problem, network=problem.network.without({"p1"}))
        kept = problem.kept
        assert kept is not None
        assert problems(closed.network, {"r0": robots["r0"].task(had.stops)}, {"r0": kept.schedule.journeys["r0"]})
        for after in (decided(closed), improved(decided(closed), Random(1), rounds(5))):
            assert problems(closed.network, after.timed.tasks, after.timed.schedule.journeys) == []
            assert after.robot_of().keys() == {one.id for one in orders}


@settings(max_examples=60)
@given(st.randoms(use_true_random=False), st.integers(2, 6), st.integers(1, 3))
@pytest.mark.slow
def test_what_is_overdue_is_given_no_later_because_of_what_is_new(rng: Random, robots: int, capacity: int) -> None:
    network = random_network(rng)
    network = replace(network, bays=(1,) * len(network.posts))
    posts = range(len(network.posts))
    first = [order(n, *rng.sample(posts, 2), since_s=-7 * 3600.0 if n % 2 else 0.0) for n in range(robots)]
    problem = problem_of(network, {f"r{n}": robot(rng.choice(posts), capacity=capacity) for n in range(robots)}, first)
    before = decided(problem)
    promised_s = overdue_s(problem, before.timed.tasks, before.timed.schedule)
    kept = Kept({name: task.goals for name, task in before.timed.tasks.items()}, before.timed.schedule)
    there = {name: replace(one, route=before.routes[name]) for name, one in problem.robots.items()}
    more = [*first, *(order(number, *rng.sample(posts, 2)) for number in range(10, 10 + robots * capacity))]
    again = AssignmentProblem(0.0, network, there, {one.id: one for one in more}, kept)
    after = decided(again)
    now_s = overdue_s(again, after.timed.tasks, after.timed.schedule)
    assert promised_s.keys() <= now_s.keys()
    assert all(now_s[name] <= at_s + 0.01 for name, at_s in promised_s.items())


def test_an_order_stays_with_its_robot_unless_another_is_worth_the_change() -> None:
    has = order(0, 2, 4)
    late = robot(1, route=has.stops)
    robots = {"r0": replace(late, start=replace(late.start, ready_s=3.0)), "r1": robot(3)}
    stays = problem_of(street(5), robots, [has])
    moves = replace(stays, rules=Rules(worth_s=0.0))
    assert improved(decided(stays), Random(1), rounds(200)).robot_of() == {has.id: "r0"}
    assert improved(decided(moves), Random(1), rounds(200)).robot_of() == {has.id: "r1"}


def test_an_order_that_its_robot_may_not_have_any_more_goes_to_another() -> None:
    has = replace(order(0, 1, 2), avoided=frozenset({"r0"}))
    after = decided(problem_of(street(4), {"r0": robot(0, route=has.stops), "r1": robot(3)}, [has]))
    assert after.robot_of() == {has.id: "r1"}


def test_of_what_has_begun_only_that_counts_which_is_still_to_be_done() -> None:
    """It was on its way to give mail of an order that has been cancelled; the stop after it is not begun for that."""
    ended, has = order(0, 0, 2), order(1, 3, 4)
    its = robot(0, route=(ended.stops[1], *has.stops), begun=1, capacity=2)
    after = decided(problem_of(street(5), {"r0": its, "r1": robot(3)}, [has]))
    assert after.problem.robots["r0"].begun == 0
    assert improved(after, Random(1), rounds(200)).robot_of() == {has.id: "r1"}


def test_an_idle_robot_takes_over_one_of_two_orders_whatever_time_it_is() -> None:
    one, other, now_s = order(0, 0, 1, since_s=1e5), order(1, 6, 5, since_s=1e5), 1e5
    both = robot(0, capacity=2, route=(*one.stops, *other.stops))
    robots = {
        name: replace(its, start=replace(its.start, ready_s=now_s)) for name, its in (("r0", both), ("r1", robot(6)))
    }
    first = decided(problem_of(street(7), robots, [one, other], now_s=now_s))
    assert first.robot_of() == {one.id: "r0", other.id: "r0"}
    assert improved(first, Random(1), rounds(200)).robot_of() == {one.id: "r0", other.id: "r1"}
