"""The benchmarks of the body and of the paper run, and what they print can be read. What they measure is judged
elsewhere: by people on a quiet machine, and by the tests that run small samples of missions, kills and tracks."""

import json
import math
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from benchmarks.body.__main__ import PARTS
from benchmarks.body.report import Part, Samples, Wanted, at_path, missed, part_report, table
from benchmarks.paper.contenders import contenders
from benchmarks.paper.figures import figures_of, most_stages, real_time_figures
from benchmarks.paper.logged_run import logged
from benchmarks.paper.plots import draw
from benchmarks.paper.real_time import Views
from benchmarks.paper.stages import CHARGING, COLLECTED, MOVED_ON_M, NAMES, PROCEEDING
from maps import find_map

CHECKOUT = Path(__file__).parents[1]
PAPERS_PROGRAM = CHECKOUT.parent / "shared" / "cases" / "paper" / "mail.asl"


def run(module: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", module, *arguments]
    return subprocess.run(command, cwd=CHECKOUT, capture_output=True, text=True, check=False)


def test_a_part_that_does_not_exist_is_named() -> None:
    finished = run("benchmarks.body", "beauty")
    assert finished.returncode == 2
    assert "no part is called beauty" in finished.stderr


@pytest.mark.parametrize("name", PARTS)
def test_every_part_can_be_loaded_and_says_what_is_wanted_of_it(name: str) -> None:
    part: Part = import_module(f"benchmarks.body.{name}")
    assert callable(part.measure)
    figures = [wanted.figure for wanted in part.WANTED]
    assert len(set(figures)) == len(figures) > 0
    assert [one.figure for one in part.WANTED if one.at_most is None and one.at_least is None] == []


@pytest.mark.parametrize(
    ("part", "arguments"),
    [
        ("vision", ("--seeds", "1")),
        pytest.param("stops", ("--seeds", "1"), marks=pytest.mark.alone),  # wheels at real time
        ("hour", ("--hour-s", "60")),
    ],
)
@pytest.mark.nightly
def test_a_part_measures_every_figure_that_it_is_judged_by(
    part: str, arguments: tuple[str, ...], tmp_path: Path
) -> None:
    finished = run("benchmarks.body", part, *arguments, "--plots", str(tmp_path))
    report: dict[str, Any] = json.loads(finished.stdout)["parts"]
    assert list(report) == [part]
    assert "failed" not in report[part], finished.stderr
    assert [row["figure"] for row in report[part]["wanted"] if row["measured"] is None] == []
    assert finished.returncode == bool(missed(report))
    assert "measured" in finished.stderr, "people get a table"


class Halves:
    """A part with one bound that holds, one that does not, and one of which nothing was measured."""

    WANTED = (
        Wanted("share", at_least=0.5),
        Wanted("speed.slowest", at_least=2, unit="mm/s"),
        Wanted("lost", at_most=0),
    )

    def measure(self, samples: Samples) -> dict[str, Any]:
        return {"share": 0.5, "speed": {"slowest": 1}, "seeds": list(samples.some_seeds())}


def test_what_was_not_measured_is_not_met() -> None:
    report = part_report(Halves(), Samples(seeds=2, first_seed=7))
    assert at_path(report, "figures.seeds") == [7, 8]
    assert [row["met"] for row in report["wanted"]] == [True, False, False]
    broken = {"figures": {}, "wanted": [], "failed": "OSError: no camera"}
    assert missed({"halves": report, "broken": broken}) == [
        "broken: OSError: no camera",
        "halves: speed.slowest",
        "halves: lost",
    ]
    lines = table({"halves": report}).splitlines()
    assert lines[2].split() == ["halves:", "speed.slowest", "1", "≥", "2", "mm/s", "MISSED"]


@pytest.mark.nightly
def test_our_run_on_the_papers_track_is_logged_and_drawn(tmp_path: Path) -> None:
    ours = contenders(None)
    log = logged(ours[0], seed=1)
    assert log.delivered, log.reason
    assert "post5" in log.posts, "the battery was low on the way"
    report = {"ours": figures_of([log])}
    assert report["ours"]["missions_lost"] == 0
    assert report["ours"]["actions"]["follow_line"]["count"] >= 4
    assert sum(plan["share"] for plan in report["ours"]["plans"].values()) == pytest.approx(1.0)
    assert {stage.name for stage in log.stages} == set(NAMES)
    assert [stage.time_s for stage in log.stages] == sorted(stage.time_s for stage in log.stages)
    assert log.stages[0].name == COLLECTED
    places = {stage.name: stage.place[:2] for stage in log.stages}
    dock = find_map("test_track").posts["post5"].dock
    assert math.dist(places[CHARGING], (dock.x_m, dock.y_m)) < 0.3
    assert math.dist(places[CHARGING], places[PROCEEDING]) >= MOVED_ON_M
    samples = {"ours": {"view_ms": [20.0, 21.0], "cycle_ms": [0.1, 0.2], "view_age_ms": [3.0], "would_wait": [4, 8]}}
    draw(tmp_path, ours, report, samples, {"ours": most_stages([log])})
    drawn = {file.stem for file in tmp_path.glob("*.svg")}
    assert {"figure-06-stages-ours", "figure-07-perception", "percept-queue"} <= drawn
    assert "on to the destination" in (tmp_path / "figure-06-stages-ours.svg").read_text()


def test_the_perception_period_is_that_of_the_body_and_not_of_the_mind() -> None:
    """Ten views between two ticks of the mind: in a queue that each tick takes one from, nine more wait every time."""
    samples: dict[str, list[float]] = {"view_ms": [], "cycle_ms": [], "view_age_ms": [], "would_wait": []}
    views = Views(samples)
    for tick in range(1, 51):
        at_s = tick / 50
        views.renewed(at_s)
        views.renewed(at_s)
        if tick % 10 == 0:
            views.reasoned(at_s + 0.003, at_s)
    assert samples["view_ms"] == pytest.approx([20.0] * 49)
    assert samples["view_age_ms"] == pytest.approx([3.0] * 5)
    assert samples["would_wait"] == [9, 18, 27, 36, 45]
    figures = real_time_figures(samples, 1.0)
    assert (figures["queue_would_grow_per_s"], figures["view_ms"]["p50"]) == (36.0, pytest.approx(20.0))
    assert "would_wait" not in figures


@pytest.mark.skipif(not PAPERS_PROGRAM.exists(), reason="the paper's program lies in ../shared, which is absent")
@pytest.mark.nightly
def test_the_papers_program_is_logged_in_the_papers_words_and_a_lost_mission_is_said() -> None:
    paper = next(one for one in contenders(PAPERS_PROGRAM) if one.name == "paper_lead")
    log = logged(paper, seed=1, limit_s=75)
    assert (log.delivered, log.reason) == (False, "not delivered in 75 s")
    assert {"drive(forward)", "turn(left)", "setDestination"} <= log.actions.keys()
    assert log.plans.most_common(1)[0][0] == "+!followPath", "as in the paper's Figure 9"
