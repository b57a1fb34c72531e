"""The benchmark of the fleet runs, and what it prints can be read. Full samples are for a quiet machine."""

import json
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from benchmarks.body.report import missed
from benchmarks.fleet import throughput
from benchmarks.fleet.__main__ import PARTS
from benchmarks.fleet.assigning import Rule
from benchmarks.fleet.claimants import Campus, Faults
from benchmarks.fleet.grounds import track
from benchmarks.fleet.never_stuck import CASES, FAULTS, Case, Run, look_at
from benchmarks.fleet.world import CollisionError

CHECKOUT = Path(__file__).parents[1]


@pytest.mark.parametrize("name", PARTS)
def test_every_part_can_be_loaded_and_says_what_is_wanted_of_it(name: str) -> None:
    part: Any = import_module(f"benchmarks.fleet.{name}")
    assert callable(part.measure)
    figures = [wanted.figure for wanted in part.WANTED]
    assert len(set(figures)) == len(figures) > 0
    assert [one.figure for one in part.WANTED if one.at_most is None and one.at_least is None] == []


@pytest.mark.slow
def test_a_part_measures_every_figure_that_it_is_judged_by(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "benchmarks.fleet", "every_map", "--posts", "2", "--plots", str(tmp_path)]
    finished = subprocess.run(command, cwd=CHECKOUT, capture_output=True, text=True, check=False)
    report: dict[str, Any] = json.loads(finished.stdout)["parts"]
    assert "failed" not in report["every_map"], finished.stderr
    assert [row["figure"] for row in report["every_map"]["wanted"] if row["measured"] is None] == []
    assert report["every_map"]["figures"]["places"] == 426
    assert finished.returncode == bool(missed(report))
    assert "measured" in finished.stderr, "people get a table"


@pytest.mark.parametrize(
    "case", CASES, ids=lambda case: f"{case.ground}-{case.robots}-{case.bays}{'-planner' * case.planner}"
)
@pytest.mark.nightly
def test_no_robot_is_stuck_and_no_order_forgotten_while_robots_die_and_corridors_are_closed(case: Case) -> None:
    """Twelve hours of each; a hundred thousand robot-hours in `make bench-fleet ARGS="never_stuck"`."""
    seen = look_at(Run(case, seed=3, hours=12.0, faults=FAULTS, far=True))
    assert (seen.stuck, seen.met, seen.too_old) == (0, 0, 0)
    assert seen.robot_hours == 12.0 * case.robots
    assert seen.delivered > 6 * case.robots
    assert (seen.let_in_ahead > 0) == (case.following_s is None), (
        "behind each other the order is only known when they go in"
    )


def test_robots_that_meet_or_find_no_bay_would_be_seen() -> None:
    def campus() -> Campus:
        return Campus(track(), robots=3, seed=1, faults=Faults(), age_limit_s=3600.0)

    meeting = campus()
    there, back = meeting.network.lane(4, 2), meeting.network.lane(2, 4)
    meeting.robots["r0"].lane = there
    with pytest.raises(CollisionError, match="r1 meets another"):
        meeting.look_for_others(meeting.robots["r1"], back)
    full = campus()
    full.robots["r0"].post, full.robots["r0"].at_home = 2, False
    full.controller.joins("r0", post="post3", home="post5", at_home=False, now_s=0.0)
    full.controller.joins("r1", post="post2", home="post5", at_home=False, now_s=0.0)
    with pytest.raises(CollisionError, match="r1 finds no bay at post3"):
        full.look_for_others(full.robots["r1"], full.network.lane(1, 2))


@pytest.mark.slow
def test_in_the_tunnels_most_of_what_could_be_delivered_without_conflicts_is() -> None:
    run_ = throughput.run((throughput.Case(4, 2, Rule("quickest", orders=3, rounds=3), spread=0.2), 1, 24.0))
    assert run_.refused == 0
    assert run_.delivered > 0.85 * run_.same_rule
    assert run_.delivered > run_.first_come
    assert run_.of_orders_taken is not None
    assert 0.85 < run_.of_orders_taken < 1.0


@pytest.mark.parametrize("rule", [throughput.PLAIN, Rule("quickest", orders=5, rounds=1)])
def test_one_robot_alone_delivers_what_it_would_without_conflicts(rule: Rule) -> None:
    run_ = throughput.run((throughput.Case(1, 1, rule), 1, 60.0))
    assert run_.delivered == run_.same_rule


def test_one_robot_alone_delivers_no_less_with_the_planner_than_by_the_nearest_order() -> None:
    """It may be more: the planner looks further than to the nearest."""
    run_ = throughput.run((throughput.Case(1, 1), 1, 60.0))
    assert run_.delivered >= run_.same_rule
