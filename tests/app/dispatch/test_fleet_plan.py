"""Decisions for the whole fleet: which robot gets which order, what stays as it is, and that no order is forgotten."""

from dataclasses import replace
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fleet.assignment.deciding import Decision, decide
from fleet.assignment.improving import improved, within
from fleet.assignment.problem import AssignmentProblem, Kept, OpenOrder, RobotAtWork, Rules, Stop
from fleet.schedule.journey import Goal, Start
from fleet.schedule.network import Lane, Network
from fleet.schedule.planning import first_plan
from fleet.schedule.validation import problems
from tests.app.dispatch.fleet_life import Life, order, rounds
from tests.fleet.schedule.test_schedules import random_network


def street(posts: int, travel_s: float = 100.0, bays: int = 2) -> Network:
    """Posts 0, 1, 2 … in a row."""
    lanes: list[list[Lane]] = [[] for _ in range(posts)]
    for number in range(posts - 1):
        lanes[number].append(Lane(number, 0, number, number + 1, travel_s))
        lanes[number + 1].append(Lane(number, 1, number + 1, number, travel_s))
    names = tuple(f"p{post}" for post in range(posts))
    return Network(names, (bays,) * posts, names[1:], tuple(tuple(out) for out in lanes))


def robot(post: int, **more: object) -> RobotAtWork:
    return replace(RobotAtWork(Start(post, True, 0.0, 0.0), post), **more)  # type: ignore[arg-type]


def problem_of(
    network: Network,
    robots: dict[str, RobotAtWork],
    orders: list[OpenOrder],
    now_s: float = 0.0,
    rules: Rules | None = None,
) -> AssignmentProblem:
    """With the schedule of what the robots have so far."""
    tasks = {name: one.task(one.route) for name, one in robots.items()}
    schedule = first_plan(network, tasks, Random(0))
    assert schedule is not None
    kept = Kept({name: task.goals for name, task in tasks.items()}, schedule)
    return AssignmentProblem(now_s, network, robots, {one.id: one for one in orders}, kept, rules or Rules())


def decided(problem: AssignmentProblem) -> Decision:
    found = decide(problem)
    assert found is not None
    return found


@settings(max_examples=60)
@given(st.randoms(use_true_random=False), st.integers(1, 5), st.integers(1, 3), st.integers(0, 1))
@pytest.mark.slow
def test_every_order_is_fetched_and_given_by_one_robot_that_never_has_too_much(
    rng: Random, robots: int, capacity: int, ahead: int
) -> None:
    network = random_network(rng)
    posts = range(len(network.posts))
    life = Life(network, [rng.choice(posts) for _ in range(robots)], capacity, rng, Rules(ahead=ahead))
    coming = [order(number, *rng.sample(posts, 2)) for number in range(rng.randint(1, 15))]
    coming[0] = replace(coming[0], wanted=frozenset({f"r{rng.randrange(robots)}"}))
    orders, steps = len(coming), 0
    while coming or life.waiting:
        if coming and (not life.waiting or rng.random() < 0.3):
            life.arrives(replace(coming.pop(), since_s=life.world.now_s))
            life.decide()
        elif life.step():
            life.decide()
        steps += 1
        assert steps < 5000, "orders are waited for, and nothing happens"
    assert len(life.given_s) == orders


@settings(max_examples=60)
@given(st.randoms(use_true_random=False), st.integers(1, 4), st.integers(1, 3))
@pytest.mark.slow
def test_no_stop_that_has_begun_is_moved_and_no_mail_changes_robots_in_a_corridor(
    rng: Random, robots: int, capacity: int
) -> None:
    network = random_network(rng)
    posts = range(len(network.posts))
    first = [order(number, *rng.sample(posts, 2)) for number in range(10)]
    problem = problem_of(network, {f"r{n}": robot(rng.choice(posts), capacity=capacity) for n in range(robots)}, first)
    before = decided(problem)
    begun = {
        name: replace(one, route=before.routes[name], begun=rng.randint(0, len(before.routes[name])))
        for name, one in problem.robots.items()
    }
    kept = Kept({name: task.goals for name, task in before.timed.tasks.items()}, before.timed.schedule)
    more = [order(number, *rng.sample(posts, 2), since_s=-9 * 3600.0 * rng.random()) for number in range(10, 15)]
    again = replace(problem, robots=begun, kept=kept, orders={one.id: one for one in (*first, *more)})
    after = improved(decided(again), rng, rounds(20))
    for name, one in begun.items():
        assert after.routes[name][: one.begun] == one.route[: one.begun]
        fetched = {stop.order for stop in one.route[: one.begun] if stop.change > 0}
        assert fetched <= {stop.order for stop in after.routes[name]}


def test_an_order_that_has_waited_too_long_is_served_next_however_many_come_after_it() -> None:
    rules = Rules(age_limit_s=2000.0, late=0.0)
    life = Life(street(8), [0], 1, Random(1), rules)
    life.arrives(order(0, 7, 6))
    number = 0
    while "o000" not in life.given_s:
        if sum(1 for one in life.waiting.values() if not one.loaded) < 2:
            number += 1
            life.arrives(order(number, 0, 1, since_s=life.world.now_s))
            life.decide()
        elif life.step():
            life.decide()
        assert life.world.now_s < 20_000.0
    one_round_s = 1.5 * 8 * 100.0 * 3
    assert number > 3, "others came first"
    assert rules.age_limit_s < life.given_s["o000"] < rules.age_limit_s + one_round_s


def test_what_is_overdue_takes_the_place_of_what_has_not_begun() -> None:
    late, young = order(0, 2, 3, since_s=-7 * 3600.0), order(1, 0, 1)
    problem = problem_of(street(4), {"r0": robot(0, route=young.stops)}, [late, young])
    first = decided(problem)
    after = improved(first, Random(1), rounds(30))
    for routes in (first.routes, after.routes):
        assert [stop.order for stop in routes["r0"]] == [late.id, late.id]


def test_nothing_is_put_before_what_is_overdue_however_near_it_is() -> None:
    late, near = order(0, 3, 4, since_s=-7 * 3600.0), order(1, 0, 1)
    problem = problem_of(street(5), {"r0": robot(0, capacity=2, route=late.stops)}, [late, near])
    after = improved(decided(problem), Random(1), rounds(30))
    assert [stop.order for stop in after.routes["r0"]] == [late.id, late.id, near.id, near.id]


def test_an_overdue_order_is_never_given_later_than_it_was_to_be() -> None:
    rng = Random(5)
    for _ in range(20):
        network = random_network(rng)
        posts = range(len(network.posts))
        orders = [order(n, *rng.sample(posts, 2), since_s=-7 * 3600.0 if n < 2 else 0.0) for n in range(8)]
        first = decided(problem_of(network, {f"r{n}": robot(rng.choice(posts)) for n in range(4)}, orders))
        after = improved(first, rng, rounds(15))
        for late in orders[:2]:
            name = first.robot_of()[late.id]
            done_s = first.timed.schedule.journeys[name].done_s
            assert after.timed.schedule.journeys[after.robot_of()[late.id]].done_s <= done_s + 0.01


def test_robots_that_people_want_are_waited_for_and_avoided_ones_do_not_come() -> None:
    robots = {"far": robot(5), "near": robot(0)}
    wanted = replace(order(0, 0, 1), wanted=frozenset({"far"}))
    avoided = replace(order(1, 0, 1), avoided=frozenset({"near"}))
    assert decided(problem_of(street(6), robots, [wanted])).robot_of() == {wanted.id: "far"}
    assert decided(problem_of(street(6), robots, [avoided])).robot_of() == {avoided.id: "far"}
    assert decided(problem_of(street(6), robots, [wanted, avoided])).robot_of() == {wanted.id: "far"}


def test_a_paused_robot_brings_what_it_has_and_loses_what_it_was_to_fetch() -> None:
    aboard, unloaded = replace(order(0, 0, 3), loaded=True), order(1, 1, 2)
    route = (aboard.stops[1], *unloaded.stops)
    robots = {"r0": robot(0, route=route, accepts=False), "r1": robot(4)}
    after = decided(problem_of(street(5), robots, [aboard, unloaded]))
    assert after.routes["r0"] == (aboard.stops[1],)
    assert after.robot_of()[unloaded.id] == "r1"


def test_a_cancelled_order_is_forgotten_and_a_charge_stays() -> None:
    gone, charge = order(0, 1, 2), Stop("", Goal(0, 600.0, key="charge"), 0)
    after = decided(problem_of(street(4), {"r0": robot(0, route=(*gone.stops, charge))}, []))
    assert after.routes["r0"] == (charge,)


def test_an_order_for_later_is_left_until_its_time_and_then_not_fetched_too_early() -> None:
    later = order(0, 1, 2)
    later = replace(later, load=later.load._replace(not_before_s=5000.0))
    robots = {"r0": robot(0)}
    assert decided(problem_of(street(3), robots, [later])).robot_of() == {}
    soon = decided(problem_of(street(3), robots, [later], now_s=4500.0))
    assert soon.robot_of() == {later.id: "r0"}
    assert soon.timed.schedule.journeys["r0"].done_s >= 5000.0 + 10.0 + 100.0 + 10.0


def test_a_robot_gets_only_what_its_charge_lasts_for() -> None:
    far = order(0, 3, 5)
    assert decided(problem_of(street(6), {"r0": robot(0, drives_s=999.0)}, [far])).robot_of() == {}
    assert decided(problem_of(street(6), {"r0": robot(0, drives_s=1000.0)}, [far])).robot_of() == {far.id: "r0"}
    both = {"r0": robot(0, drives_s=999.0), "r1": robot(5)}
    assert decided(problem_of(street(6), both, [far])).robot_of() == {far.id: "r1"}


def test_what_is_more_than_one_charge_goes_alone_with_a_robot_that_is_as_full_as_it_gets() -> None:
    far, near = order(0, 3, 5), order(1, 3, 4)
    full = robot(0, capacity=2, drives_s=999.0, goes_beyond=True)
    assert decided(problem_of(street(6), {"r0": full}, [far])).robot_of() == {far.id: "r0"}
    assert len(decided(problem_of(street(6), {"r0": full}, [far, near])).robot_of()) == 1
    lasts = replace(full, drives_s=1000.0)
    assert len(decided(problem_of(street(6), {"r0": lasts}, [far, near])).robot_of()) == 2


def test_an_important_order_comes_before_others_that_have_waited_as_long() -> None:
    plain, important = order(0, 1, 2, since_s=-3000.0), replace(order(1, 1, 2, since_s=-3000.0), weight=2.0)
    assert decided(problem_of(street(3), {"r0": robot(0)}, [plain, important])).robot_of() == {important.id: "r0"}


def test_mail_goes_along_where_there_is_room_for_two() -> None:
    one, other = order(0, 0, 3), order(1, 1, 2)
    after = decided(problem_of(street(4), {"r0": robot(0, capacity=2)}, [one, other]))
    assert [stop.goal.post for stop in after.routes["r0"]] == [0, 1, 2, 3]


def test_orders_change_robots_where_that_is_better_for_all() -> None:
    left, right = order(0, 0, 1), order(1, 5, 4)
    crossed = {"r0": robot(0, route=right.stops), "r1": robot(5, route=left.stops)}
    first = decided(problem_of(street(6), crossed, [left, right]))
    after = improved(first, Random(1), rounds(30))
    assert after.robot_of() == {left.id: "r0", right.id: "r1"}
    assert after.cost_s < first.cost_s - 1000.0


def test_where_no_way_leads_no_robot_is_sent_and_everything_else_goes_on() -> None:
    network = street(4).without({"p3"})
    aboard, unreached, plain = replace(order(0, 0, 3), loaded=True), order(1, 0, 3), order(2, 0, 1)
    robots = {"r0": robot(0, capacity=2, route=(aboard.stops[1], *unreached.stops))}
    tasks = {"r0": robots["r0"].task(())}
    schedule = first_plan(network, tasks, Random(0))
    assert schedule is not None
    orders = {one.id: one for one in (aboard, unreached, plain)}
    after = decided(AssignmentProblem(0.0, network, robots, orders, Kept({"r0": ()}, schedule)))
    assert after.robot_of() == {plain.id: "r0"}
    assert [stop.order for stop in after.cut_off["r0"]] == [aboard.id]


def test_with_nothing_kept_a_schedule_is_made_anew() -> None:
    problem = replace(problem_of(street(3), {"r0": robot(0), "r1": robot(2)}, [order(0, 0, 2)]), kept=None)
    assert decided(problem).robot_of() == {"o000": "r0"}


def test_improving_ends_before_its_time_is_over_and_what_was_found_until_then_holds() -> None:
    rng = Random(7)
    network = random_network(rng)
    posts = range(len(network.posts))
    orders = [order(number, *rng.sample(posts, 2)) for number in range(12)]
    robots = {f"r{n}": robot(rng.choice(posts), capacity=2) for n in range(6)}
    first = decided(problem_of(network, robots, orders))
    ticks_s = iter(0.001 * tick for tick in range(10_000))
    in_time = within(0.1, lambda: next(ticks_s))
    after = improved(first, rng, lambda: True, in_time)
    assert 0.09 < next(ticks_s) <= 0.1, "asked again and again, until the first no"
    assert problems(network, after.timed.tasks, after.timed.schedule.journeys) == []
    assert after.cost_s <= first.cost_s
