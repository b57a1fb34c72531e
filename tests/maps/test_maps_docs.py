"""docs/reference/maps.md and examples/maps say what is so."""

import re

from maps import find_map
from maps.bays import MARKER_BEFORE_PLACE_M, MARKER_BESIDE_LINE_M
from maps.campus_map import FOLDER
from maps.check import check_file
from maps.map_file import BayRow, CorridorRow, MapFile, PostRow, load_map_file

PAGE = (FOLDER.parent / "docs/reference/maps.md").read_text(encoding="utf-8")
EXAMPLES = FOLDER.parent / "examples/maps"


def block(language: str) -> str:
    found = re.search(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)
    assert found
    return found[1]


def test_the_format_on_the_page_is_a_map_file_that_uses_every_key(tmp_path):
    path = tmp_path / "campus.toml"
    path.write_text(block("toml"), encoding="utf-8")
    file = load_map_file(path)
    post = file.post[0]
    for row, table in ((file, MapFile), (post.bay[0], BayRow), (file.corridor[0], CorridorRow)):
        assert row.model_fields_set == set(table.model_fields)
    before_bays_had_places = {"bays", "homes", "dock"}
    assert post.model_fields_set == set(PostRow.model_fields) - before_bays_had_places
    assert all(f"`{key}" in PAGE for key in before_bays_had_places)


def test_every_kind_of_problem_is_explained():
    source = "".join(file.read_text(encoding="utf-8") for file in sorted(FOLDER.glob("*.py")))
    kinds = set(re.findall(r'(?:error|warning)\(\s*"(\w+)"', source))
    assert len(kinds) > 10
    table = PAGE[PAGE.index("| kind |") :]
    assert kinds == set(re.findall(r"`(\w+)`", "".join(re.findall(r"^\| (`.*?) \|", table, re.MULTILINE))))


def test_the_code_on_the_page_runs():
    names: dict[str, object] = {}
    exec(block("python"), names)  # noqa: S102  our own page
    assert names["campus"] == find_map("test_track")
    assert str(names["route"]) in block("python").replace('"', "'")


def test_the_standard_places_are_the_ones_on_the_page():
    assert f"**{MARKER_BEFORE_PLACE_M:.2f} m before the post, {MARKER_BESIDE_LINE_M:.2f} m beside the line" in PAGE


def test_the_example_of_an_own_campus_is_fit_for_robots():
    assert check_file(EXAMPLES / "two_buildings.toml") == ()


def test_the_example_of_a_one_way_corridor_is_refused_in_the_words_it_quotes():
    (problem,) = check_file(EXAMPLES / "one_way.toml")
    assert f"# {problem}\n" in (EXAMPLES / "one_way.toml").read_text(encoding="utf-8")
