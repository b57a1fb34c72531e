"""Ways home that no robot blocks stay as they were; all others are found again round what is new."""

from dataclasses import replace
from random import Random

from hypothesis import given, settings
from hypothesis import strategies as st

from fleet.schedule.journey import Goal, Journey, Start, Task
from fleet.schedule.planning import Journeys, plan
from fleet.schedule.validation import problems
from tests.app.dispatch.test_fleet_plan import street
from tests.fleet.schedule.test_schedules import planned, random_network, random_tasks


def later(journey: Journey, by_s: float) -> Journey:
    """The same with the way home begun later."""
    way_home = tuple(
        leg._replace(enter_s=leg.enter_s + by_s, arrive_s=leg.arrive_s + by_s, ready_s=leg.ready_s + by_s)
        for leg in journey.way_home
    )
    return replace(journey, way_home=way_home)


def two_on_a_street(bays: tuple[int, ...], goal_of_new: int) -> tuple[Journeys, Journeys]:
    """`old` goes from 0 to 2 and home again, two hours late; `new` comes from 5. The journeys of `old` before and
    after `new` has been planned for."""
    network = replace(street(6), bays=bays)
    old, new = Task(Start(0, True, 0.0, 0.0), (Goal(2, 10.0),), 0), Task(Start(5, True, 0.0, 0.0), (), 5)
    first = plan(network, {"old": old}, ["old"])
    assert first is not None
    kept = {"old": later(first.journeys["old"], 7200.0)}
    tasks = {"old": old, "new": replace(new, goals=(Goal(goal_of_new, 7200.0),))}
    assert problems(network, {"old": old}, kept) == []
    found = plan(network, tasks, ["new"], kept)
    assert found is not None
    assert problems(network, tasks, found.journeys) == []
    return kept, found.journeys


def test_a_way_home_that_no_robot_is_in_the_way_of_stays_as_it_was() -> None:
    before, after = two_on_a_street((1, 1, 1, 1, 1, 1), goal_of_new=3)
    assert after["old"] == before["old"]


def test_a_way_home_is_planned_again_when_a_robot_is_going_to_stand_in_it() -> None:
    before, after = two_on_a_street((2, 1, 2, 2, 2, 2), goal_of_new=1)
    assert after["old"].work == before["old"].work
    assert after["old"].way_home != before["old"].way_home


def test_a_way_home_past_a_robot_is_no_matter_where_there_is_a_bay_for_both() -> None:
    before, after = two_on_a_street((2, 2, 2, 2, 2, 2), goal_of_new=1)
    assert after["old"] == before["old"]


@settings(max_examples=100)
@given(st.randoms(use_true_random=False), st.integers(2, 6), st.booleans(), st.booleans())
def test_new_work_beside_what_is_kept_makes_a_whole_schedule(
    rng: Random, robots: int, following: bool, crossing: bool
) -> None:
    network = random_network(rng, following=following, crossing=crossing)
    tasks = random_tasks(rng, network, robots)
    kept = planned(rng, network, tasks).journeys
    some = rng.sample(sorted(tasks), rng.randint(1, robots - 1))
    posts = range(len(network.posts))
    for robot in some:
        more = tuple(Goal(rng.choice(posts), rng.uniform(0.0, 60.0)) for _ in range(rng.randint(0, 3)))
        tasks[robot] = replace(tasks[robot], goals=more)
    found = plan(network, tasks, some, kept)
    if found is not None:
        assert problems(network, tasks, found.journeys) == []
        assert all(found.journeys[robot].work == kept[robot].work for robot in tasks if robot not in some)
