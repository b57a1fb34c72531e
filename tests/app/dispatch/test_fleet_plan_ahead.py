"""The planner looks ahead: an order may wait for a robot that comes by soon, and what is only likely is not told."""

from dataclasses import replace
from random import Random

import pytest

from fleet.assignment.deciding import Decision
from fleet.assignment.improving import improved
from fleet.assignment.problem import AssignmentProblem, OpenOrder, RobotAtWork, Rules
from fleet.assignment.why import why_orders_wait
from tests.app.dispatch.fleet_life import order, rounds
from tests.app.dispatch.test_fleet_plan import decided, problem_of, robot, street

BRINGS = replace(order(0, 0, 10), loaded=True)
"""It is given at post 10 soon."""
THERE, HERE = order(1, 10, 11), order(2, 1, 0)


def soon_there(**more: object) -> RobotAtWork:
    return robot(9, route=BRINGS.stops[1:], begun=1, **more)


def both(problem: AssignmentProblem) -> list[Decision]:
    first = decided(problem)
    return [first, improved(first, Random(1), rounds(30))]


def test_an_order_waits_for_the_robot_that_is_there_soon_and_the_free_one_takes_the_other() -> None:
    """The other one is younger: by age, or by what one robot saves, the free one would go the long way."""
    old = replace(THERE, since_s=-1500.0)
    for after in both(problem_of(street(20), {"busy": soon_there(), "free": robot(4)}, [BRINGS, old, HERE])):
        assert after.robot_of() == {BRINGS.id: "busy", HERE.id: "free"}
        assert after.outlook.comes == {old.id: "busy"}


def test_a_free_robot_stays_where_it_is_if_one_that_works_is_there_sooner() -> None:
    for after in both(problem_of(street(20), {"busy": soon_there(), "free": robot(1)}, [BRINGS, THERE])):
        assert after.robot_of() == {BRINGS.id: "busy"}


def test_nothing_that_only_comes_in_turn_is_in_a_route_or_in_the_schedule() -> None:
    orders = [BRINGS, THERE, HERE, *(order(number, 12, 13) for number in range(3, 9))]
    for after in both(problem_of(street(20), {"busy": soon_there(), "free": robot(0)}, orders)):
        assert after.routes["busy"] == BRINGS.stops[1:]
        assert len(after.routes["free"]) == 2, "as much as it has room for"
        for name, task in after.timed.tasks.items():
            assert task.goals == tuple(stop.goal for stop in after.routes[name])
            legs = after.timed.schedule.journeys[name].legs
            assert sum(leg.goals for leg in legs) == len(task.goals)
        assert after.outlook.comes.keys().isdisjoint(after.robot_of())


def test_why_it_waits_is_told_with_the_robot_that_it_waits_for() -> None:
    after = decided(problem_of(street(20), {"busy": soon_there(), "free": robot(1)}, [BRINGS, THERE]))
    why = why_orders_wait(after)[THERE.id]
    assert (why.code, why.robots) == ("sooner", ("busy",))


@pytest.mark.parametrize(
    ("busy", "wanted"),
    [
        (soon_there(drives_s=100.0), THERE),
        (soon_there(accepts=False), THERE),
        (soon_there(), replace(THERE, avoided=frozenset({"busy"}))),
        (soon_there(), replace(THERE, since_s=-7 * 3600.0)),
    ],
    ids=["no charge for it", "takes nothing", "avoided", "overdue"],
)
def test_an_order_does_not_wait_for_a_robot_that_does_not_come_or_when_it_has_waited_too_long(
    busy: RobotAtWork, wanted: OpenOrder
) -> None:
    for after in both(problem_of(street(20), {"busy": busy, "free": robot(1)}, [BRINGS, wanted])):
        assert after.robot_of()[wanted.id] == "free"


def test_a_robot_that_the_schedule_keeps_waiting_is_not_waited_for() -> None:
    problem = problem_of(street(20), {"busy": soon_there(), "free": robot(1)}, [BRINGS, THERE])
    kept = problem.kept
    assert kept is not None
    journey = kept.schedule.journeys["busy"]
    late = replace(journey, done_s=journey.done_s + 3000.0)
    schedule = replace(kept.schedule, journeys={**kept.schedule.journeys, "busy": late})
    after = decided(replace(problem, kept=replace(kept, schedule=schedule)))
    assert after.robot_of()[THERE.id] == "free"


def test_a_short_way_comes_before_a_long_one_until_that_has_waited_long() -> None:
    long, short = order(0, 1, 8), order(1, 2, 3)
    assert decided(problem_of(street(10), {"r0": robot(0)}, [long, short])).robot_of() == {short.id: "r0"}
    rules, old = Rules(late=20.0), replace(long, since_s=-3600.0)
    assert decided(problem_of(street(10), {"r0": robot(0)}, [old, short], rules=rules)).robot_of() == {old.id: "r0"}


def test_an_order_that_a_robot_had_is_never_left_without_one() -> None:
    """Something nearer comes first; what the robot was to fetch stays behind it, or goes to another."""
    had = order(0, 15, 16)
    robots = {"r0": robot(0, route=had.stops), "r1": robot(19, route=BRINGS.stops[1:], begun=1)}
    near = [order(number, 0, 1, since_s=-3000.0) for number in range(5, 8)]
    for seed in range(5):
        first = decided(problem_of(street(20), robots, [BRINGS, had, *near]))
        after = improved(first, Random(seed), rounds(60))
        assert had.id in after.robot_of()


def test_what_the_charge_does_not_last_for_comes_after_a_charge_or_with_a_robot_that_needs_none() -> None:
    near, far = order(3, 1, 2), order(4, 8, 9)
    after = decided(problem_of(street(20), {"r0": robot(0, drives_s=500.0)}, [near, far]))
    assert (after.robot_of(), after.outlook.comes) == ({near.id: "r0"}, {far.id: "r0"})
    robots = {"r0": robot(0, drives_s=500.0), "busy": robot(19, route=BRINGS.stops[1:], begun=1)}
    after = decided(problem_of(street(20), robots, [BRINGS, near, far]))
    assert after.outlook.comes == {far.id: "busy"}, "though the way is longer"


@pytest.mark.parametrize("awaited", ["east", "west"])
def test_of_two_that_meet_the_one_that_more_orders_wait_for_goes_first(awaited: str) -> None:
    """What waits at the end of its way is for the robot that comes there."""
    to_east, to_west = (replace(one, loaded=True) for one in (order(0, 0, 6), order(1, 6, 0)))
    end = {"east": 6, "west": 0}[awaited]
    robots = {
        "east": robot(0, route=to_east.stops[1:], begun=1),
        "west": robot(6, route=to_west.stops[1:], begun=1),
    }
    orders = [to_east, to_west, *(order(number, end, end) for number in range(2, 6))]
    after = improved(decided(problem_of(street(7), robots, orders)), Random(1), rounds(60))
    assert set(after.outlook.comes.values()) == {awaited}
    done_s = {name: journey.done_s for name, journey in after.timed.schedule.journeys.items()}
    assert min(done_s, key=lambda name: done_s[name]) == awaited
    assert after.outlook.weights == {"east": 1.0, "west": 1.0, awaited: 5.0}
