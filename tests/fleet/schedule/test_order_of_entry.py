"""The order of a schedule is kept whatever the clock says, and what is near enough to a mistake is seen as one."""

from dataclasses import replace
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fleet.schedule.execution import may_enter, retimed
from fleet.schedule.journey import Goal, Journey, Leg, Start, Task, standing
from fleet.schedule.network import Network
from fleet.schedule.planning import Schedule, improve, plan
from fleet.schedule.validation import problems
from tests.app.dispatch.test_fleet_plan import street
from tests.fleet.schedule.test_schedules import planned, random_network, random_tasks, two_posts


def two_that_swap(network: Network) -> tuple[dict[str, Task], Schedule]:
    tasks = {
        "r1": Task(Start(0, True, 50.0, 0.0), (Goal(1, 10.0),), 0),
        "r2": Task(Start(1, True, 0.0, 0.0), (Goal(0, 10.0, 300.0),), 1),
    }
    found = plan(network, tasks, ["r1", "r2"])
    assert found is not None
    return tasks, found


def test_a_robot_that_is_ready_early_waits_for_the_one_the_schedule_lets_go_first() -> None:
    network = two_posts(bays=2)
    tasks, found = two_that_swap(network)
    entries_s = {robot: journey.legs[1].enter_s for robot, journey in found.journeys.items()}
    first, second = sorted(entries_s, key=lambda robot: entries_s[robot])
    starts = {robot: replace(task.start, ready_s=0.0) for robot, task in tasks.items()}
    assert may_enter(network, starts, found.journeys, first, 0.0)
    assert not may_enter(network, starts, found.journeys, second, 0.0)


@settings(max_examples=60)
@given(st.randoms(use_true_random=False), st.integers(1, 6), st.booleans(), st.booleans())
def test_when_no_robot_is_late_nothing_comes_later_than_planned(
    rng: Random, robots: int, following: bool, crossing: bool
) -> None:
    network = random_network(rng, following=following, crossing=crossing)
    tasks = random_tasks(rng, network, robots)
    found = planned(rng, network, tasks)
    # A robot that turns round keeps the clearance to itself.
    slack_s = network.clearance_s * sum(len(journey.legs) for journey in found.journeys.values())
    again_from_now = retimed(network, tasks, found.journeys)
    assert problems(network, tasks, again_from_now) == []
    for robot, journey in again_from_now.items():
        for again, leg in zip(journey.legs, found.journeys[robot].legs, strict=True):
            assert again.enter_s <= leg.enter_s + slack_s
            assert again.ready_s <= leg.ready_s + slack_s


@settings(max_examples=25)
@given(st.randoms(use_true_random=False), st.integers(5, 8))
def test_whatever_gets_better_everybody_stays_in_the_order_in_which_more_is_looked_for(
    rng: Random, robots: int
) -> None:
    network = random_network(rng)
    tasks = random_tasks(rng, network, robots)
    rounds = iter(range(6))
    better = improve(network, tasks, planned(rng, network, tasks), rng, lambda: next(rounds, None) is not None)
    assert sorted(better.order) == sorted(tasks)


def test_a_robot_that_follows_a_late_robot_arrives_behind_it() -> None:
    network = two_posts(bays=3, following_s=20.0)
    lane = network.lanes[0][0]
    tasks = {
        "late": Task(Start(1, False, 400.0, 0.0, lane, 400.0), (), 0),
        "next": Task(Start(0, True, 150.0, 0.0), (Goal(1, 10.0),), 0),
    }
    found = plan(network, tasks, ["late", "next"])
    assert found is not None
    assert found.journeys["next"].legs[1].arrive_s == pytest.approx(420.0, abs=0.1)
    assert problems(network, tasks, found.journeys) == []
    in_time = {"late": found.journeys["late"], "next": _sooner(found.journeys["next"])}
    assert problems(network, tasks, retimed(network, tasks, in_time)) == []


def _sooner(journey: Journey) -> Journey:
    """As if the one ahead had been in time."""
    return Journey(tuple(_at(leg, leg.enter_s - 100.0) for leg in journey.work), journey.way_home, journey.done_s)


def _at(leg: Leg, enter_s: float) -> Leg:
    return leg if leg.lane is None else leg._replace(enter_s=enter_s, arrive_s=enter_s + leg.lane.travel_s)


def test_idle_robots_keep_no_robot_from_something_better_however_late_it_is() -> None:
    network, now_s = two_posts(bays=2), 100_000.0
    tasks = {
        "busy": Task(Start(0, True, now_s, 0.0), (Goal(1, 10.0),), 0),
        "idle": Task(Start(1, True, now_s, 0.0), (), 1),
    }
    assert plan(network, tasks, ["busy", "idle"], within_s=now_s + 111.0) is not None
    assert plan(network, tasks, ["busy", "idle"], within_s=now_s + 109.0) is None


def test_the_check_wants_the_clearance_in_a_corridor_and_a_bay_left_before_it_is_taken() -> None:
    network = two_posts(bays=1)
    tasks, found = two_that_swap(network)
    assert problems(network, tasks, found.journeys) == []
    second = max(found.journeys, key=lambda robot: found.journeys[robot].legs[1].enter_s)
    for leg in range(1, len(found.journeys[second].legs)):
        early = _moved(found.journeys[second], leg, -0.09)
        if problems(network, tasks, {**found.journeys, second: early}):
            return
    pytest.fail("no two robots are near each other")


def _moved(journey: Journey, number: int, by_s: float) -> Journey:
    legs = [
        leg if at < number else leg._replace(enter_s=leg.enter_s + by_s, arrive_s=leg.arrive_s + by_s)
        for at, leg in enumerate(journey.legs)
    ]
    return Journey(tuple(legs), (), journey.done_s)


def test_the_check_wants_a_bay_to_be_left_strictly_before_it_is_entered() -> None:
    network = street(3, bays=1)
    out, into, back = network.lane(1, 0), network.lane(2, 1), network.lane(1, 2)
    tasks = {"out": Task(Start(1, False, 0.0, 0.0), (), 0), "into": Task(Start(2, True, 0.0, 0.0), (), 2)}
    leaves = Journey((standing(tasks["out"].start), Leg(out, 100.0, 200.0, 0, True, 0, 200.0)), (), 0.0)

    def said(enter_s: float) -> list[str]:
        there = Leg(into, enter_s, enter_s + 100.0, 1, False, 0, enter_s + 100.0)
        home = Leg(back, enter_s + 150.0, enter_s + 250.0, 2, True, 0, enter_s + 250.0)
        comes = Journey((standing(tasks["into"].start), there, home), (), 0.0)
        return problems(network, tasks, {"out": leaves, "into": comes})

    assert said(enter_s=100.0) == ["into finds no bay at p1 at 100.0 s"]
    assert said(enter_s=100.1) == []
    assert problems(network, tasks, {"out": leaves}) == ["into has no journey"]


def test_no_robot_waits_for_a_late_robot_where_another_bay_is_free() -> None:
    network = street(3, bays=2)
    late, after = Start(1, False, 0.0, 0.0), Start(2, True, 0.0, 0.0)
    tasks = {"late": Task(late, (), 0), "next": Task(after, (Goal(1, 10.0, 300.0),), 2)}
    found = plan(network, tasks, ["late", "next"])
    assert found is not None
    now = {**tasks, "late": replace(tasks["late"], start=replace(late, ready_s=5000.0))}
    again = retimed(network, now, found.journeys)
    assert again["late"].legs[1].enter_s >= 5000.0
    assert again["next"].done_s == pytest.approx(310.0, abs=1.0)
