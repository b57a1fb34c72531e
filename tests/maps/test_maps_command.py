"""`python -m maps` as people use it."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
import zxingcpp
from typer.testing import CliRunner, Result

import maps
from maps import builtin_map
from maps.__main__ import cli
from maps.sheets import marker_code

CHECKOUT = Path(maps.__file__).parent.parent


def run(*arguments: str) -> Result:
    return CliRunner().invoke(cli, arguments)


def test_a_clean_map_ends_with_exit_0():
    command = [sys.executable, "-m", "maps", "check", "test_track"]
    finished = subprocess.run(command, cwd=CHECKOUT, capture_output=True, text=True, check=False)
    assert (finished.returncode, finished.stderr) == (0, "")
    assert "test_track.toml: no problems\n" in finished.stdout


def test_a_map_unfit_for_robots_ends_with_exit_1_and_a_sentence_each(write_map):
    result = run("check", str(write_map('[[post]]\nname = "a"\nx_m = 0\ny_m = 0\n')))
    assert result.exit_code == 1
    assert "error: campus: there is no dock on this map" in result.stdout


def test_the_check_speaks_json(write_map):
    result = run("check", "--json", str(write_map('[[post]]\nname = "a"\nx_m = 0\ny_m = 0\n')))
    answer = json.loads(result.stdout)
    assert [problem["kind"] for problem in answer["problems"]] == ["no_dock", "no_bays_on_floor"]
    assert set(answer["problems"][0]) == {"severity", "kind", "place", "sentence", "way_out"}


def test_an_unreadable_map_ends_with_exit_2_and_names_line_and_column(write_map):
    path = str(write_map('name = "a"\ntitle = \n'))
    result = run("check", path)
    assert result.exit_code == 2
    assert "line 2, column 9" in result.stderr
    answer = json.loads(run("check", "--json", path).stdout)
    assert answer["error"]["place"] == "line 2, column 9"


@pytest.mark.parametrize("command", ["show", "markers", "tape", "check"])
def test_an_unknown_map_is_answered_with_those_that_ship(command):
    result = run(command, "nowhere")
    assert result.exit_code == 2
    assert "carleton, test_track" in result.stderr


def test_show_marks_assumed_lengths():
    assert "southam ~70" in run("show", "carleton").stdout
    assert "~2" not in run("show", "test_track").stdout


def test_show_tells_the_bays_of_a_post_by_bearing_and_use():
    shown = run("show", str(CHECKOUT / "examples/maps/two_buildings.toml"))
    cells = {cell.strip() for line in shown.stdout.splitlines() for cell in line.split("│")}
    assert {"90° home", "dock, 0°", "90°, 270°"} <= cells


def test_route_prints_posts_and_metres():
    assert run("route", "test_track", "post1", "post4").stdout == "post1 → post2 → post3 → post4: 6 m\n"


@pytest.mark.parametrize("question", [("route", "test_track", "post1"), ("markers", "test_track", "--post")])
def test_a_post_that_is_not_on_the_map_is_misuse_and_the_nearest_name_is_told(question, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    wrong = run(*question, "pots4")
    assert (wrong.exit_code, "Did you mean 'post4'" in wrong.stderr) == (2, True)
    assert list(tmp_path.iterdir()) == [], "nothing was written"


def test_two_posts_that_nothing_joins_end_a_route_with_exit_1(write_map):
    apart = "".join(f'[[post]]\nname = "{name}"\nx_m = {x_m}\ny_m = 0\n' for name, x_m in (("a", 0), ("b", 5)))
    none = run("route", str(write_map(apart)), "a", "b")
    assert (none.exit_code, "No route from a to b" in none.stderr) == (1, True)


@pytest.mark.parametrize("campus", ["test_track", "carleton"])
def test_a_marker_is_read_as_its_posts_name_by_an_independent_decoder(campus):
    import numpy as np

    for name in builtin_map(campus).posts:
        dark = np.pad(np.array([list(row) for row in marker_code(name).matrix], dtype=np.uint8), 4)
        picture = np.kron(1 - dark, np.full((6, 6), 255, dtype=np.uint8))
        assert [code.text for code in zxingcpp.read_barcodes(picture)] == [name]


def test_the_papers_markers_are_of_version_1_with_error_correction_h():
    code = marker_code("post3")
    assert (code.version, code.error) == (1, "H")
