"""Who is planned again: a robot that is late, those that come where it wants to go, and now and then anybody else."""

from collections import Counter
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fleet.schedule.journey import Goal, Start, Task
from fleet.schedule.neighbourhood import SOME_OF, neighbourhood
from fleet.schedule.planning import plan
from tests.app.dispatch.test_fleet_plan import street
from tests.fleet.schedule.test_schedules import planned, random_network, random_tasks

DRAWN = 2000


@given(st.randoms(use_true_random=False), st.integers(1, 8), st.booleans())
def test_it_is_always_some_of_the_robots_each_once(rng: Random, robots: int, crossing: bool) -> None:
    network = random_network(rng, crossing=crossing)
    tasks = random_tasks(rng, network, robots)
    found = planned(rng, network, tasks)
    again = neighbourhood(network, tasks, found.journeys, found.order, rng)
    assert len(again) == len(set(again)) > 0
    assert set(again) <= tasks.keys()
    assert len(again) <= max(SOME_OF, robots)


def test_the_late_one_goes_first_most_often_together_with_the_one_that_it_waits_for() -> None:
    network = street(9)
    tasks = {
        "meets": Task(Start(3, True, 0.0, 0.0), (Goal(0, 10.0),), 3),
        "late": Task(Start(0, True, 0.0, 0.0), (Goal(3, 10.0),), 0),
        **{f"far{n}": Task(Start(n, True, 0.0, 0.0), (Goal(n, 10.0),), n) for n in (5, 6, 7, 8)},
    }
    found = plan(network, tasks, list(tasks))
    assert found is not None
    assert found.journeys["late"].done_s > plan(network, {"late": tasks["late"]}, ["late"]).cost_s  # type: ignore[union-attr]
    rng = Random(1)
    drawn = [neighbourhood(network, tasks, found.journeys, found.order, rng) for _ in range(DRAWN)]
    led = [again for again in drawn if again[0] == "late" and len(again) <= SOME_OF]
    assert len(led) > 0.3 * DRAWN
    seen = Counter(name for again in led for name in again[1:])
    assert seen["meets"] > 0.9 * len(led)
    assert max(Counter(name for again in drawn for name in again).values()) < DRAWN, "any other has its turn as well"


def test_where_nothing_is_late_any_robot_is_planned_again() -> None:
    network = street(9)
    tasks = {f"r{n}": Task(Start(n, True, 0.0, 0.0), (Goal(n, 10.0),), n) for n in range(0, 9, 2)}
    found = plan(network, tasks, list(tasks))
    assert found is not None
    rng = Random(1)
    seen = Counter(
        name for _ in range(DRAWN) for name in neighbourhood(network, tasks, found.journeys, found.order, rng)
    )
    assert min(seen.values()) > 0.9 * max(seen.values())


@given(st.randoms(use_true_random=False), st.booleans())
def test_from_post_to_next_post_it_takes_as_long_as_the_quickest_way(rng: Random, crossing: bool) -> None:
    network = random_network(rng, crossing=crossing)
    start, goal = rng.randrange(len(network.posts)), rng.randrange(len(network.posts))
    at, took_s = start, 0.0
    while at != goal:
        following = network.next_post(at, goal)
        took_s += network.takes_s(network.lane(at, following))
        at = following
    arrives_s = network.crossing_s[goal] if goal != start else 0.0
    assert took_s + arrives_s == pytest.approx(network.shortest_s[start][goal])


def test_where_no_way_leads_there_is_no_next_post() -> None:
    network = street(3).without({street(3).corridors[1]})
    with pytest.raises(ValueError, match=f"no way leads from {network.posts[0]} to {network.posts[2]}"):
        network.next_post(0, 2)
