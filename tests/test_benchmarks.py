"""The benchmarks run, and what they print can be read. How long things take is not tested here.

The other interpreters are not run: python-agentspeak comes from the network, Jason from an archive that is set by hand.
"""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from benchmarks.mind.figures import FIGURES
from benchmarks.mind.ours import Ours
from benchmarks.mind.report import figure_report
from benchmarks.mind.worker import rows_of
from benchmarks.mind.workloads import write_workloads

CHECKOUT = Path(__file__).parents[1]


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "benchmarks.mind", *arguments]
    environment = {name: value for name, value in os.environ.items() if name != "JASON_JAR"}
    return subprocess.run(command, cwd=CHECKOUT, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.nightly
def test_a_quick_run_has_every_figure_of_ours_and_says_why_the_others_are_missing(tmp_path: Path) -> None:
    finished = run("--quick", "--alone", "--folder", str(tmp_path))
    assert finished.returncode == 0, finished.stderr
    report: dict[str, Any] = json.loads(finished.stdout)
    assert report["quick"] is True
    assert report["engines"] == {
        "ours": "this checkout",
        "python-agentspeak": "not run: --alone",
        "jason": "not run: --alone",
    }
    assert list(report["figures"]) == [figure.name for figure in FIGURES]
    assert [name for name, figure in report["figures"].items() if "median" not in figure.get("ours", {})] == []
    assert report["figures"]["paper"]["ours"]["actions"] > 0
    assert {target["met"] for figure in report["figures"].values() for target in figure["targets"]} == {None}


def test_a_figure_that_does_not_exist_is_named(tmp_path: Path) -> None:
    finished = run("--only", "beauty", "--folder", str(tmp_path))
    assert finished.returncode == 2
    assert "no figure is called beauty" in finished.stderr


def test_where_the_papers_records_are_missing_a_courier_of_ours_has_work_to_do(tmp_path: Path) -> None:
    said = write_workloads(tmp_path, recorded=tmp_path / "nowhere")
    assert said.startswith("a stand-in")
    interpreter = Ours(tmp_path)
    cycle = interpreter.start("paper")
    for percepts, goal in rows_of(tmp_path / "paper.script"):
        cycle(frozenset(percepts), goal)
    assert interpreter.acted > 200


def test_ratios_are_of_the_same_round_and_a_target_is_judged() -> None:
    counter = next(figure for figure in FIGURES if figure.name == "counter")
    ours = [{"value": 140.0}, {"value": 200.0}, {"value": 160.0}]
    theirs = [{"value": 1400.0}, {"value": 4000.0}, {"value": 1600.0}]
    report = figure_report(counter, {"ours": ours, "python-agentspeak": theirs}, judged=True)
    assert report["ours"] == {"least": 140, "median": 160}
    assert report["ratio"] == 0.1
    assert report["targets"] == [
        {"ours": "least", "at_most": 150, "met": True},
        {"of": "python-agentspeak", "at_most": 0.07, "met": False},
    ]
