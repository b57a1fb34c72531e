"""A run is recorded, and its page holds all of it and nothing that is not its own."""

import json
import logging
import re
import subprocess
import sys
from base64 import b64encode
from hashlib import sha256
from pathlib import Path

import cv2
import pytest
import structlog

from robot.scenarios.errors import RecordingError
from robot.scenarios.replay.pictures import write_pictures
from robot.scenarios.replay.recording import Recorder, read_recording
from robot.scenarios.replay.replaying import page
from robot.scenarios.scenario import Scenario
from robot.scenarios.stage import Stage

ROOT = Path(__file__).parents[3]
HOSTILE = "</script><script>alert(1)</script><!-- & {{DATA}} \u2028"


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.CRITICAL))
    folder = tmp_path_factory.mktemp("run")
    order = {"id": "o1", "from": "post3", "to": "post4"}
    stander = {"corridor": "post3-post5", "leaves_after_s": 3.0}
    scenario = Scenario.model_validate({"title": HOSTILE, "order": [order], "stander": [stander], "limit_s": 45})
    with Stage(scenario, folder) as stage, Recorder(folder / "run.gz", stage) as recorder:
        recorder.end(stage.run())
    return folder / "run.gz"


def test_the_recording_draws_spurs_and_what_stands_beside_them(tmp_path):
    bays = str(Path(__file__).parents[2] / "bays.toml")
    scenario = Scenario.model_validate({"title": "track", "limit_s": 1, "map": {"name": bays}})
    with Stage(scenario, tmp_path) as stage, Recorder(tmp_path / "run.gz", stage) as recorder:
        recorder.end(stage.run())
        track = stage.campus.track
    drawn = read_recording(tmp_path / "run.gz")[0]["map"]
    assert "post1-post1_bay2" in {name for name, _ in drawn["corridors"]}
    assert len(drawn["markers"]) == sum(len(place.markers) for place in track.posts.values())


@pytest.mark.nightly
def test_the_recording_has_the_truth_the_beliefs_and_the_people(recording):
    rows = read_recording(recording)
    states = [row for row in rows if row["kind"] == "state"]
    assert len(states) == pytest.approx(45 / 0.2, abs=3)
    assert states[-1]["y"] < states[0]["y"]
    kinds = {row["kind"] for row in rows}
    assert kinds >= {"scenario", "state", "people", "why", "doing", "percepts", "fault", "event", "mail", "end"}
    assert any("docked" in row["value"] for row in rows if row["kind"] == "percepts")
    stacks = [stack for row in rows if row["kind"] == "intentions" for _, stack in row["value"]]
    assert any(stack[0].startswith("+!pursue(mission") and "+!go_to(post3)" in stack for stack in stacks)


@pytest.mark.slow
def test_the_page_holds_every_row_and_allows_only_its_own_script(recording):
    rows = read_recording(recording)
    html = page(rows)
    data = re.search(r'<script type="application/json" id="data">(.*?)</script>', html, re.DOTALL)
    assert data
    assert json.loads(data.group(1)) == rows
    script = html.rpartition("<script>")[2].partition("</script>")[0]
    assert b64encode(sha256(script.encode()).digest()).decode() in html.partition("</head>")[0]
    assert "unsafe" not in html.partition("</head>")[0]


@pytest.mark.slow
def test_nothing_in_a_recording_becomes_markup_and_nothing_is_fetched(recording):
    html = page(read_recording(recording))
    assert "alert(1)</script>" not in html
    assert html.count("<script") == 2
    assert not re.search(r"(?:src|href)\s*=|@import|url\(|fetch\(|innerHTML", html)


def test_a_recording_becomes_pictures_too(recording, tmp_path):
    assert write_pictures(recording, tmp_path / "pictures", every_s=10.0) == 5
    picture = cv2.imread(str(tmp_path / "pictures" / "00004.png"))
    assert picture is not None
    assert picture.std() > 5


def test_what_is_no_recording_is_named(tmp_path):
    path = tmp_path / "other.gz"
    path.write_bytes(b"nothing")
    with pytest.raises(RecordingError, match=r"other\.gz: cannot be read as a recording"):
        read_recording(path)


def command(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "robot.scenarios", *arguments], capture_output=True, text=True, check=False, cwd=ROOT
    )


@pytest.mark.slow
def test_the_command_says_by_its_status_whether_the_expectation_held(tmp_path):
    path = tmp_path / "short.toml"
    path.write_text('limit_s = 3\n[[order]]\nid = "o1"\nfrom = "post1"\nto = "post4"\n')
    ended = command("run", str(path), "--json")
    assert ended.returncode == 1
    assert "r1: progress accepted" in ended.stderr, "progress is seen while it runs"
    assert json.loads(ended.stdout)["orders"]["o1"]["fate"] == "lost"
    path.write_text("limit_s = 3\n[expect]\nhome = true\n")
    assert command("run", str(path), "--quiet").returncode == 0
    path.write_text("limits = 3\n")
    refused = command("check", str(path))
    assert (refused.returncode, "Did you mean 'limit_s'?" in refused.stderr) == (2, True)
