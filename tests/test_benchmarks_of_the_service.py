"""The benchmark of the service runs, and what it prints can be read. What it measures is judged on a quiet machine."""

import json
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from random import Random
from typing import Any

import pytest

from benchmarks.body.report import missed
from benchmarks.fleet_simulation.honeycomb import MOST_ROBOTS, Honeycomb
from benchmarks.service.__main__ import PARTS
from benchmarks.service.filling import KnownRobot
from benchmarks.service.played_robots import at_home
from maps import MapError
from maps.check import check

CHECKOUT = Path(__file__).parents[1]


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "benchmarks.service", *arguments]
    return subprocess.run(command, cwd=CHECKOUT, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("name", PARTS)
def test_every_part_can_be_loaded_and_says_what_is_wanted_of_it(name: str) -> None:
    part: Any = import_module(f"benchmarks.service.{name}")
    assert callable(part.measure)
    figures = [wanted.figure for wanted in part.WANTED]
    assert len(set(figures)) == len(figures) > 0
    assert [one.figure for one in part.WANTED if one.at_most is None and one.at_least is None] == []


@pytest.mark.parametrize("posts", [2, 7, 36])
def test_robots_could_drive_on_the_made_up_campus_and_each_has_a_home_of_its_own(posts: int, tmp_path: Path) -> None:
    ground = Honeycomb(posts, posts)
    assert check(ground.file()) == ()
    campus = ground.read(tmp_path)
    fleet = at_home([KnownRobot(f"r{n}", "") for n in range(posts)], campus, Random(1))
    assert {robot.home for robot in fleet} == {bay.name for bay in campus.track.home_bays}
    assert len({robot.post for robot in fleet}) == posts


def test_a_campus_is_no_larger_than_there_are_tags(tmp_path: Path) -> None:
    assert len(Honeycomb(MOST_ROBOTS, MOST_ROBOTS).read(tmp_path).posts) == MOST_ROBOTS
    with pytest.raises(MapError, match="have the same tag"):
        Honeycomb(MOST_ROBOTS + 1, MOST_ROBOTS + 1).read(tmp_path)


@pytest.mark.nightly
def test_a_part_measures_every_figure_that_it_is_judged_by() -> None:
    finished = run("followers", "--followers", "3", "--seconds", "1")
    report: dict[str, Any] = json.loads(finished.stdout)["parts"]
    assert "failed" not in report["followers"], finished.stderr
    assert [row["figure"] for row in report["followers"]["wanted"] if row["measured"] is None] == []
    assert report["followers"]["figures"]["not_seen"] == 0
    assert finished.returncode == bool(missed(report))
    assert "measured" in finished.stderr, "people get a table"
