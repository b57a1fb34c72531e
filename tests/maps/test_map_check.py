"""The map check names what is wrong, where, and the way out."""

import pytest

from maps.campus_map import FOLDER
from maps.check import check, check_file
from maps.map_file import load_map_file
from maps.problem import Problem
from maps.scaling import fitting_factor, scaled

CARLETON = (FOLDER / "carleton.toml").read_text(encoding="utf-8")
# The paper's Figure 5 as a file from before bays had places on the floor.
TRACK = """
name = "test_track"
title = "The paper's test track"

[[post]]
name = "post1"
title = "Post 1"
x_m = 0.0
y_m = 4.0

[[post]]
name = "post2"
title = "Post 2"
x_m = 0.0
y_m = 2.0

[[post]]
name = "post3"
title = "Post 3"
x_m = 2.0
y_m = 2.0

[[post]]
name = "post4"
title = "Post 4"
x_m = 2.0
y_m = 0.0

[[post]]
name = "post5"
title = "Post 5"
x_m = 2.0
y_m = 4.0
dock = { x_m = 2.0, y_m = 4.5, heading_deg = 90.0 }

[[corridor]]
ends = ["post1", "post2"]
length_m = 2.0

[[corridor]]
ends = ["post2", "post3"]
length_m = 2.0

[[corridor]]
ends = ["post3", "post4"]
length_m = 2.0

[[corridor]]
ends = ["post3", "post5"]
length_m = 2.0
"""


def problems_of(write_map, text: str) -> dict[str, Problem]:
    """By kind and place, so that a test says exactly what it expects and nothing more is found.

    All but the one of every map without bays on the floor, which has a test of its own.
    """
    found = check_file(write_map(text))
    return {f"{p.severity} {p.kind} {p.place}": p for p in found if p.kind != "no_bays_on_floor"}


@pytest.mark.parametrize("name", ["test_track", "carleton"])
def test_the_maps_that_ship_have_no_problem(name):
    assert check_file(FOLDER / f"{name}.toml") == ()


def test_the_tunnels_have_room_in_small_too():
    """The demonstrations shrink them: bodies, bays and markers keep their size."""
    file = load_map_file(FOLDER / "carleton.toml")
    assert check(scaled(file, fitting_factor(file, 3.0, 10.0))) == ()


def test_a_neighbour_that_only_one_side_lists_is_a_one_way_corridor(write_map):
    """The source of the Carleton map had exactly this defect: CTTC did not list Nicol."""
    found = problems_of(
        write_map, CARLETON.replace('sides = { 4 = "nicol", 3 = "robertson" }', "sides = { 3 = 'robertson' }")
    )
    assert list(found) == ["error one_way cttc-nicol"]
    assert "from cttc to nicol, but cttc does not list nicol" in found["error one_way cttc-nicol"].sentence
    assert found["error one_way cttc-nicol"].way_out == "Add nicol to the sides of cttc."


def test_a_listed_neighbour_without_a_corridor_is_named(write_map):
    found = problems_of(write_map, CARLETON.replace('sides = { 1 = "steacie" }', 'sides = { 1 = "steacie", 2 = "uc" }'))
    assert list(found) == ["error no_corridor richcraft-uc"]


def test_sides_that_contradict_the_drawing_are_a_warning(write_map):
    swapped = CARLETON.replace('sides = { 1 = "southam", 2 = "steacie" }', 'sides = { 1 = "southam", 4 = "steacie" }')
    assert list(problems_of(write_map, swapped)) == ["warning side_and_geometry loeb"]


def test_an_unknown_post_in_a_corridor_is_named(write_map):
    found = problems_of(write_map, TRACK.replace('["post3", "post5"]', '["post3", "post6"]'))
    assert list(found) == ["error unknown_post post3-post6"]


def test_a_post_that_no_corridor_reaches_is_named_and_has_no_dock_to_reach(write_map):
    island = '\n[[post]]\nname = "island"\nx_m = 9.0\ny_m = 9.0\n'
    found = problems_of(write_map, TRACK + island)
    assert list(found) == ["error unreachable island", "error no_dock island"]


def test_a_map_without_a_dock_is_not_fit_for_robots(write_map):
    without = "".join(line for line in TRACK.splitlines(keepends=True) if not line.startswith("dock"))
    assert list(problems_of(write_map, without)) == ["error no_dock test_track"]


def test_an_approach_without_a_marker_on_the_left_is_named(write_map):
    on_the_right = 'name = "post1"\nmarkers = [{ x_m = 0.35, y_m = 3.7, heading_deg = 180.0 }]'
    found = problems_of(write_map, TRACK.replace('name = "post1"', on_the_right))
    assert list(found) == ["error unseen_approach post1", "error unseen_marker post1, marker 1"]
    assert "comes from post2" in found["error unseen_approach post1"].sentence


@pytest.mark.parametrize(
    ("x_m", "heading_deg"),
    [(-0.35, 90.0), (-0.35, 180.0), (-0.35, -90.0), (0.35, 0.0), (-0.1, 0.0), (-1.0, 0.0)],
    ids=["ahead", "away", "back", "other side of the line", "too near", "too far"],
)
def test_a_marker_that_the_camera_cannot_see_is_named(write_map, x_m, heading_deg):
    turned = f'name = "post1"\nmarkers = [{{ x_m = {x_m}, y_m = 3.7, heading_deg = {heading_deg} }}]'
    found = problems_of(write_map, TRACK.replace('name = "post1"', turned))
    assert "error unseen_marker post1, marker 1" in found


def test_one_marker_may_serve_two_approaches_but_must_not_stand_on_a_line(write_map):
    in_the_way = """name = "post3"
markers = [
  { x_m = 2.0, y_m = 2.35, heading_deg = 270.0 },
  { x_m = 1.65, y_m = 1.7, heading_deg = 0.0 },
  { x_m = 2.35, y_m = 2.3, heading_deg = 180.0 },
]"""
    found = problems_of(write_map, TRACK.replace('name = "post3"', in_the_way))
    assert list(found) == ["error marker_in_the_way post3, marker 1"]
    assert "post3-post5" in found["error marker_in_the_way post3, marker 1"].sentence


def test_a_dock_without_a_marker_is_a_warning(write_map):
    only_approach = 'name = "post5"\nmarkers = [{ x_m = 1.65, y_m = 3.7, heading_deg = 0.0 }]'
    found = problems_of(write_map, TRACK.replace('name = "post5"', only_approach))
    assert list(found) == ["warning unseen_dock post5"]


def test_a_dock_without_network_is_a_warning(write_map):
    assert list(problems_of(write_map, TRACK.replace('name = "post5"', 'name = "post5"\nnetwork = false'))) == [
        "warning silent_dock post5"
    ]


def test_a_corridor_without_network_before_a_crossing_is_a_warning(write_map):
    bays = (FOLDER / "test_track.toml").read_text(encoding="utf-8")
    silent = bays.replace('ends = ["post2", "post3"]', 'ends = ["post2", "post3"]\nnetwork = false')
    assert list(problems_of(write_map, silent)) == ["warning silent_corridor post2-post3"]


def test_a_name_beyond_14_characters_makes_a_dense_marker(write_map):
    assert problems_of(write_map, TRACK.replace('"post1"', '"dormitories_14"')) == {}
    found = problems_of(write_map, TRACK.replace('"post1"', '"residences_of15"'))
    assert list(found) == ["warning dense_marker residences_of15"]


def test_errors_come_before_warnings(write_map):
    text = CARLETON.replace('"southam"', '"southam_hall_west"').replace(', 3 = "robertson" }', " }")
    assert [p.kind for p in check_file(write_map(text))] == ["one_way", *["dense_marker"] * 4]
