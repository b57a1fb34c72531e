"""The benchmark of the fleet runs, and what it prints can be read. Full samples are for a quiet machine."""

import asyncio
import json
import subprocess
import sys
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from random import Random
from typing import Any

import pytest

from benchmarks.body.report import missed
from benchmarks.fleet import campus
from benchmarks.fleet.__main__ import PARTS
from benchmarks.fleet.decisions import Watched, until_all_work
from benchmarks.fleet_simulation.beside_vroom import compared
from benchmarks.fleet_simulation.honeycomb import Honeycomb
from fleet.assignment.problem import Stop
from fleet.schedule.journey import Goal
from maps import read_map
from maps.check import check_file
from tests.app.dispatch.fleet_life import order
from tests.app.dispatch.test_fleet_plan import problem_of, robot, street

CHECKOUT = Path(__file__).parents[1]


@pytest.mark.parametrize("name", PARTS)
def test_every_part_can_be_loaded_and_says_what_is_wanted_of_it(name: str) -> None:
    part: Any = import_module(f"benchmarks.fleet.{name}")
    assert callable(part.measure)
    figures = [wanted.figure for wanted in part.WANTED]
    assert len(set(figures)) == len(figures) > 0
    assert [one.figure for one in part.WANTED if one.at_most is None and one.at_least is None] == []


@pytest.mark.slow
def test_a_part_measures_every_figure_that_it_is_judged_by() -> None:
    command = [sys.executable, "-m", "benchmarks.fleet", "every_map", "--posts", "2"]
    finished = subprocess.run(command, cwd=CHECKOUT, capture_output=True, text=True, check=False)
    report: dict[str, Any] = json.loads(finished.stdout)["parts"]
    assert "failed" not in report["every_map"], finished.stderr
    assert [row["figure"] for row in report["every_map"]["wanted"] if row["measured"] is None] == []
    assert report["every_map"]["figures"]["places"] == 426
    assert finished.returncode == bool(missed(report))
    assert "measured" in finished.stderr, "people get a table"


@pytest.mark.parametrize("name", campus.FLEETS)
@pytest.mark.nightly
@pytest.mark.timeout(900)
def test_no_robot_is_stuck_and_none_meets_another_while_robots_die_and_corridors_are_closed(name: str) -> None:
    """A working day of each; weeks in `make bench-fleet ARGS="campus"`."""
    seen = campus.look_at((name, 3, 18.0))
    assert (seen["met"], seen["stuck"], seen["astray"]) == ({}, 0, [])
    assert seen["delivered"] > 0


def test_runs_of_one_fleet_are_told_together() -> None:
    run = dict.fromkeys(campus.ADDED, 1) | {
        "met": {"corridor": 1},
        "meetings": ["r1 and r2"],
        "astray": ["an order"],
        "befallen": {"killed": 2},
        "order_to_delivered_s": {"count": 1},
        "processor_s": 1.0,
    }
    told = [{"scored": 3, "inside": 1.0, "median_error": 0.1}, {"scored": 1, "inside": 0.0, "median_error": 0.5}]
    nothing = {"scored": 0, "inside": None, "median_error": None}
    runs = [run | {"estimates": {"placed": one, "under_way": nothing}} for one in told]
    figures = campus.together(runs)
    assert (figures["stuck"], figures["astray"], figures["befallen"]) == (2, 2, {"killed": 4})
    assert figures["met"] == {"corridor": 2, "bay": 0, "crossing": 0}
    assert figures["estimates"]["placed"] == {"scored": 4, "inside": 0.75, "median_error": 0.2}
    assert figures["estimates"]["under_way"] == nothing


def test_the_planner_beside_another_is_judged_by_the_same_seeds() -> None:
    ours, theirs = {1: [60.0, 120.0], 2: [180.0]}, {1: [120.0, 240.0], 2: [360.0]}
    found = compared(ours, theirs)
    assert found["planner"] == {"orders": 3, "mean_min": 2.0, "p95_min": 3.0, "longest_min": 3.0}
    assert found["mean"] == {"share": 0.5, "between": [0.5, 0.5]}
    assert found["p95"] == {"share": 0.5, "between": [0.5, 0.5]}


def test_a_honeycomb_fits_bodies_and_has_as_many_homes_and_bays_as_asked(tmp_path: Path) -> None:
    path = Honeycomb(12, homes=5, bays=2).write(tmp_path)
    assert check_file(path) == ()
    track = read_map(path).track
    assert len([post for post in track.posts.values() if not post.bay_of]) == 12
    assert len(track.home_bays) == 5
    assert all(home.dock for home in track.home_bays)
    passing = [bay for post in track.posts for bay in track.bays_of(post) if bay.is_for_passing]
    assert len(passing) == 24


def test_only_first_answers_that_give_an_order_are_timed() -> None:
    async def asked() -> Watched:
        watched = Watched(Random(1), 0, orders=1)
        idle = problem_of(street(3), {"r0": robot(0)}, [order(0, 1, 2)])
        await watched.decided(idle, Random(0))
        await watched.decided(replace(idle, orders={}), Random(0))
        return watched

    watched = asyncio.run(asked())
    assert (len(watched.took_s), len(watched.processor_s), len(watched.asked)) == (1, 1, 1)


def test_the_start_of_a_fleet_is_over_when_each_robot_has_had_something_to_do() -> None:
    idle, stop = robot(0), Stop("o1", Goal(1, 10.0, key="o1"), 1)
    works = replace(idle, route=(stop,))
    both_idle, one, other = ({"r0": a, "r1": b} for a, b in ((idle, idle), (works, idle), (idle, works)))
    asked = [problem_of(street(3), robots, []) for robots in (both_idle, one, other, both_idle)]
    assert [until_all_work(asked[:count]) for count in range(5)] == [0, 1, 2, 2, 2]
