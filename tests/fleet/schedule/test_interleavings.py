"""Robots' reports come late, twice and in any order: no two bodies meet, and every robot comes to its end."""

from random import Random

import pytest

from benchmarks.fleet.bodies import Floor, standing_bodies
from benchmarks.fleet.interleavings import CASES, State, look_at, walk
from fleet.schedule.controller import TrafficController
from fleet.schedule.validation import problems
from tests.fleet.schedule.test_schedules import random_network

NAMES = [case.name for case in CASES if case.twice + case.restarts + case.dies < (1 if case.far else 2)]
"""All of them in `make bench-fleet ARGS="interleavings"`."""
QUICK = ("swap", "swap, said twice", "swap, from bays", "one home", "line", "line, far", "line, home in the middle")


@pytest.mark.parametrize(
    "name", [name if name in QUICK else pytest.param(name, marks=pytest.mark.nightly) for name in NAMES]
)
def test_in_no_order_of_reports_two_bodies_meet_and_all_is_done_in_the_end(name: str) -> None:
    seen = look_at(next(case for case in CASES if case.name == name))
    assert (seen.met, seen.stuck, seen.unfinished, seen.cut) == (0, 0, 0, 0)
    assert seen.finished
    assert seen.states > 100


def is_sound(floor: Floor) -> None:
    tasks, journeys = floor.controller.tasks(floor.now_s), floor.controller.journeys(floor.now_s)
    assert problems(floor.controller.network, tasks, journeys) == []


@pytest.mark.parametrize("seed", [*range(10), *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(10, 40))])
def test_on_any_map_any_order_of_reports_leads_to_the_end(seed: int) -> None:
    rng = Random(seed)
    network = random_network(rng, following=seed % 4 == 3, crossing=True)
    posts, robots = range(len(network.posts)), 2 + seed % 4
    homes, goals = [rng.choice(posts) for _ in range(robots)], [rng.choice(posts) for _ in range(robots)]
    bodies = standing_bodies(homes, goals)
    floor = Floor.at_rest(network, bodies, TrafficController(network, rng), far=seed % 2 == 0)
    assert walk(State(floor, 9, seed % 3, 1), rng, 6000, is_sound)
