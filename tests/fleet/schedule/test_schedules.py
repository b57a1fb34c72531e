"""Every robot that is sent out comes home: schedules on random maps, checked independently and carried out by
robots that are late."""

from dataclasses import replace
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fleet.schedule.execution import retimed
from fleet.schedule.journey import Goal, Start, Task
from fleet.schedule.network import Lane, Network
from fleet.schedule.planning import Insertion, Schedule, first_plan, improve, insert, plan
from fleet.schedule.validation import problems
from tests.fleet.schedule.carried_out import World


def random_network(rng: Random, *, following: bool = False, crossing: bool = False) -> Network:
    """A connected map of 2 to 9 posts with 1 to 3 bays, ways of 20 to 90 s, and crossings of 5 to 20 s."""
    posts = rng.randint(2, 9)
    edges = {(rng.randrange(post), post) for post in range(1, posts)}
    for _ in range(rng.randint(0, posts // 2)):
        a, b = sorted(rng.sample(range(posts), 2))
        edges.add((a, b))
    lanes: list[list[Lane]] = [[] for _ in range(posts)]
    for number, (a, b) in enumerate(sorted(edges)):
        travel_s, after_s = rng.uniform(20.0, 90.0), 10.0 if following and rng.random() < 0.7 else None
        lanes[a].append(Lane(number, 0, a, b, travel_s, after_s))
        lanes[b].append(Lane(number, 1, b, a, travel_s, after_s))
    names = tuple(f"p{post}" for post in range(posts))
    corridors = tuple(f"p{a}-p{b}" for a, b in sorted(edges))
    network = Network(names, tuple(rng.randint(1, 3) for _ in names), corridors, tuple(tuple(out) for out in lanes))
    return replace(network, crossing_s=tuple(rng.uniform(5.0, 20.0) for _ in names)) if crossing else network


def random_tasks(rng: Random, network: Network, robots: int) -> dict[str, Task]:
    """Everybody at home, with up to four goals."""
    posts = range(len(network.posts))
    tasks = {}
    for number in range(robots):
        goals = tuple(Goal(rng.choice(posts), rng.uniform(0.0, 60.0)) for _ in range(rng.randint(0, 4)))
        home = rng.choice(posts)
        tasks[f"r{number}"] = Task(Start(home, True, 0.0, 0.0), goals, home)
    return tasks


def planned(rng: Random, network: Network, tasks: dict[str, Task]) -> Schedule:
    found = first_plan(network, tasks, rng)
    assert found is not None, "from home everybody can serve and come home"
    return found


@given(st.randoms(use_true_random=False), st.integers(1, 6), st.booleans(), st.booleans())
def test_every_schedule_passes_a_check_that_knows_nothing_of_the_search(
    rng: Random, robots: int, following: bool, crossing: bool
) -> None:
    network = random_network(rng, following=following, crossing=crossing)
    tasks = random_tasks(rng, network, robots)
    first = planned(rng, network, tasks)
    assert problems(network, tasks, first.journeys) == []
    rounds = iter(range(4))
    better = improve(network, tasks, first, rng, lambda: next(rounds, None) is not None)
    assert problems(network, tasks, better.journeys) == []
    assert better.cost_s <= first.cost_s


@given(st.randoms(use_true_random=False), st.integers(1, 6), st.booleans())
def test_late_robots_come_home_by_the_order_of_entry(rng: Random, robots: int, following: bool) -> None:
    network = random_network(rng, following=following)
    tasks = random_tasks(rng, network, robots)
    world = World(network, dict(tasks), dict(planned(rng, network, tasks).journeys), rng)
    world.run()
    assert all(task.start.at_home and task.start.post == task.home for task in world.tasks.values())
    assert not any(task.goals for task in world.tasks.values())


@given(st.randoms(use_true_random=False), st.integers(2, 6))
def test_one_more_goal_can_always_be_taken_on_however_late_everybody_is(rng: Random, robots: int) -> None:
    network = random_network(rng)
    tasks = random_tasks(rng, network, robots)
    world = World(network, dict(tasks), dict(planned(rng, network, tasks).journeys), rng)
    for _ in range(rng.randint(0, 20)):
        if not any(len(journey.legs) > 1 for journey in world.journeys.values()):
            break
        world.step()
    robot = rng.choice(sorted(tasks))
    now = {
        name: replace(task, start=replace(task.start, ready_s=max(task.start.ready_s, world.now_s)))
        for name, task in world.tasks.items()
    }
    kept = retimed(network, now, world.journeys)
    assert problems(network, now, kept) == []
    more = {**now, robot: replace(now[robot], goals=(*now[robot].goals, Goal(rng.randrange(len(network.posts)), 5.0)))}
    found = insert(network, more, kept, robot)
    assert found is not None
    assert problems(network, more, found.journeys) == []


@given(st.randoms(use_true_random=False), st.integers(2, 6))
def test_robots_get_more_to_do_one_by_one_and_who_is_put_back_does_what_it_did(rng: Random, robots: int) -> None:
    network = random_network(rng, crossing=True)
    tasks = random_tasks(rng, network, robots)
    before = planned(rng, network, tasks)
    posts, more = range(len(network.posts)), Insertion(network, tasks, before.journeys)
    for robot in sorted(tasks):
        assert more.put(robot, replace(tasks[robot], goals=(*tasks[robot].goals, Goal(rng.choice(posts), 20.0))))
        if rng.random() < 0.5:
            more.put_back(robot, tasks[robot], before.journeys[robot])
    assert problems(network, more.tasks, more.schedule().journeys) == []


def test_one_that_finds_no_way_to_more_stays_in_the_way_of_others_as_it_was() -> None:
    network, here, there = two_posts(1), Start(0, True, 0.0, 0.0), Start(1, True, 0.0, 0.0)
    tasks = {"r1": Task(here, (Goal(1, 30.0),), 0), "r2": Task(there, (), 1)}
    found = first_plan(network, tasks, Random(0))
    assert found is not None
    more = Insertion(replace(network, lanes=((), ())), tasks, found.journeys)
    assert not more.put("r2", Task(there, (Goal(0, 30.0),), 1))
    assert (more.tasks, more.journeys) == (tasks, found.journeys)
    assert more.schedule().cost_s == found.cost_s


def two_posts(bays: int, following_s: float | None = None) -> Network:
    lanes = (Lane(0, 0, 0, 1, 100.0, following_s),), (Lane(0, 1, 1, 0, 100.0, following_s),)
    return Network(("a", "b"), (bays, bays), ("a-b",), lanes)


def test_two_robots_that_want_to_change_places_do_so_one_after_the_other() -> None:
    network = two_posts(bays=1)
    tasks = {
        "r1": Task(Start(0, True, 0.0, 0.0), (Goal(1, 10.0),), 0),
        "r2": Task(Start(1, True, 0.0, 0.0), (Goal(0, 10.0),), 1),
    }
    found = plan(network, tasks, ["r1", "r2"])
    assert found is not None
    assert [found.journeys[robot].done_s for robot in tasks] == pytest.approx([110.0, 210.1], abs=0.5)


def test_robots_follow_each_other_where_the_map_allows_it() -> None:
    def third_arrives_s(following_s: float | None) -> float:
        network = two_posts(bays=3, following_s=following_s)
        tasks = {f"r{n}": Task(Start(0, True, 0.0, 0.0), (Goal(1, 0.0),), 0) for n in range(3)}
        found = plan(network, tasks, sorted(tasks))
        assert found is not None
        return found.journeys["r2"].done_s

    assert third_arrives_s(None) == pytest.approx(300.0, abs=1.0)
    assert third_arrives_s(20.0) == pytest.approx(140.0, abs=1.0)


@pytest.mark.parametrize(
    ("broken", "said"),
    [
        (lambda leg: leg._replace(enter_s=leg.enter_s - 5.0), "leaves a before it is ready"),
        (lambda leg: leg._replace(arrive_s=leg.arrive_s - 5.0), "is too fast"),
        (lambda leg: leg._replace(goals=0), "leaves 1 of its goals unserved"),
        (lambda leg: leg._replace(post=0), "has no way from a to a"),
        (lambda leg: leg._replace(ready_s=leg.ready_s - 1.0), "has not served all"),
    ],
)
def test_the_check_sees_what_is_wrong(broken, said) -> None:  # type: ignore[no-untyped-def]
    network = two_posts(bays=1)
    tasks = {"r1": Task(Start(0, True, 0.0, 0.0), (Goal(1, 10.0),), 0)}
    found = plan(network, tasks, ["r1"])
    assert found is not None
    journey = found.journeys["r1"]
    wrong = replace(journey, work=(journey.work[0], broken(journey.work[1])))
    assert any(said in problem for problem in problems(network, tasks, {"r1": wrong}))


def test_the_check_sees_robots_that_meet_and_bays_that_are_full() -> None:
    network = two_posts(bays=1)
    tasks = {f"r{n}": Task(Start(0, True, 0.0, 0.0), (Goal(1, 10.0),), 0) for n in range(2)}
    alone = {robot: plan(network, {robot: task}, [robot]) for robot, task in tasks.items()}
    journeys = {robot: found.journeys[robot] for robot, found in alone.items() if found is not None}
    said = problems(network, tasks, journeys)
    assert "r0 and r1 meet in a-b" in said
    assert any("finds no bay at b" in problem for problem in said)
