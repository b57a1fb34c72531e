"""The number of robots that a map carries, and why: the check says it."""

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from maps import CampusMap, builtin_map, find_map
from maps.__main__ import cli
from maps.campus_map import FOLDER
from maps.carrying import carrying, places_problems

POSTS = """
name = "campus"
title = "Campus"
[[post]]
name = "a"
x_m = 0.0
y_m = 0.0
{a}
[[post]]
name = "b"
x_m = 10.0
y_m = 0.0
bays = {bays}
[[post]]
name = "c"
x_m = 20.0
y_m = 0.0
dock = {{ x_m = 20.6, y_m = 0.0, heading_deg = 0.0 }}
[[corridor]]
ends = ["a", "b"]
{way}
[[corridor]]
ends = ["b", "c"]
{way}
"""


def written(folder: Path, *, a: str = "", bays: int = 1, way: str = "") -> Path:
    path = folder / "campus.toml"
    path.write_text(POSTS.format(a=a, bays=bays, way=way))
    return path


def on_the_floor(folder: Path, a: str = "", b: str = "[[post.bay]]\nbearing_deg = 90\n") -> Path:
    """The same posts; a has a home, c a dock."""
    home = "[[post.bay]]\nbearing_deg = 180\nhome = true\n"
    text = POSTS.replace("bays = {bays}", b).replace("dock = {{ x_m = 20.6, y_m = 0.0, heading_deg = 0.0 }}", "{c}")
    path = folder / "campus.toml"
    path.write_text(text.format(a=home + a, c="[[post.bay]]\nbearing_deg = 0\nhome = true\ndock = true\n", way=""))
    return path


def test_as_many_robots_as_bays_that_are_homes(tmp_path: Path) -> None:
    campus = find_map(on_the_floor(tmp_path, a="[[post.bay]]\nbearing_deg = 270\nhome = true\n"))
    assert carrying(campus).robots == 3
    assert carrying(campus).homes == {"a": 2, "c": 1}
    assert "It carries 3 robots, one for each home place (a 2, c 1)." in str(carrying(campus))


@pytest.mark.parametrize(("name", "robots"), [("test_track", 3), ("carleton", 8)])
def test_what_ships_carries_as_many_as_the_page_on_maps_says(name: str, robots: int) -> None:
    campus = builtin_map(name)
    assert carrying(campus).robots == robots
    assert all(post.bays >= 1 for post in campus.posts.values())
    page = (FOLDER.parent / "docs/reference/maps.md").read_text(encoding="utf-8")
    assert re.search(rf"\({re.escape(f'../../maps/{name}.toml')}\)[^.]*?carries\s+{robots}\b", page)


def test_the_tunnels_have_two_bays_for_visitors_at_every_post_but_one() -> None:
    assert [post.name for post in builtin_map("carleton").posts.values() if post.bays != 2] == ["uc"]


def test_one_robot_where_no_post_has_a_bay_on_the_floor(tmp_path: Path) -> None:
    campus = find_map(written(tmp_path, a="homes = 2"))
    assert carrying(campus).robots == 1
    assert str(carrying(campus)) == "It carries 1 robot, since no post has a bay on the floor."
    (problem,) = places_problems(campus)
    assert (problem.severity, problem.kind, problem.place) == ("warning", "no_bays_on_floor", "campus")
    assert "a robot that stops at a post stands where others drive" in problem.sentence
    assert "[[post.bay]]" in problem.way_out


def test_a_post_without_a_bay_on_the_floor_among_others_that_have_one_is_named(tmp_path: Path) -> None:
    assert [p.kind for p in places_problems(find_map(on_the_floor(tmp_path)))] == ["no_bay", "no_bay"]
    missing, *_ = places_problems(find_map(on_the_floor(tmp_path, b="")))
    assert (missing.severity, missing.kind, missing.place) == ("warning", "bay_missing", "b")


def test_the_only_way_between_two_sides_bounds_what_is_delivered(tmp_path: Path) -> None:
    """10 m at 0.1 m/s: 36 passages an hour; of the six orders between three posts four need either corridor."""
    bound = carrying(find_map(written(tmp_path)), speed_m_s=0.1).bottleneck
    assert bound is not None
    assert bound.posts in {(1, 2), (2, 1)}
    assert bound.deliveries_per_h == pytest.approx(36 * 6 / 4)


def test_where_robots_may_follow_each_other_a_corridor_is_no_such_bound(tmp_path: Path) -> None:
    assert carrying(find_map(written(tmp_path, way="following_s = 20.0"))).bottleneck is None


def test_the_tunnels_are_bound_by_a_bridge() -> None:
    """With 300 s for it, twelve passages an hour; 112 of 210 orders need it, so 22.5 deliveries at the very most
    (design/fleet.md, where robots must come back for more, says near 21)."""
    campus = builtin_map("carleton")
    canal = campus.corridor("canal", "uc")
    bound = carrying(campus, speed_m_s=canal.length_m / 300.0).bottleneck
    assert bound is not None
    assert (bound.corridor, sorted(bound.posts)) == (canal.name, [7, 8])
    assert bound.deliveries_per_h == pytest.approx(22.5)


def test_a_post_without_a_bay_and_a_dock_without_a_home_are_named(tmp_path: Path) -> None:
    _, *problems = places_problems(find_map(written(tmp_path, bays=0)))
    assert [(problem.severity, problem.place) for problem in problems] == [("warning", "b")]
    assert "none can pass" in str(problems[0])


def test_a_dock_in_a_bay_may_be_for_all_robots_to_charge(tmp_path: Path) -> None:
    path = on_the_floor(tmp_path)
    path.write_text(path.read_text().replace("home = true\ndock = true", "dock = true"))
    assert carrying(find_map(path)).homes == {"a": 1}
    assert "dock_without_home" not in {p.kind for p in places_problems(find_map(path))}
    old = find_map(written(tmp_path)).posts["c"]
    no_home = CampusMap("m", "M", {"c": replace(old, homes=0)}, ())
    assert "dock_without_home" in {p.kind for p in places_problems(no_home)}


def test_it_is_said_whose_robot_finds_no_dock(tmp_path: Path) -> None:
    campus = find_map(on_the_floor(tmp_path))
    assert carrying(campus).without_dock == ("a_bay1",)
    assert "Robots at home in a_bay1 find no dock" in str(carrying(campus))
    with_one = find_map(on_the_floor(tmp_path, b="[[post.bay]]\nbearing_deg = 90\ndock = true\n"))
    assert carrying(with_one).without_dock == ()
    assert "find no dock" not in str(carrying(with_one))
    assert carrying(builtin_map("carleton")).without_dock == ()


def test_the_check_says_it_to_people_and_to_programs(tmp_path: Path) -> None:
    path = str(on_the_floor(tmp_path))
    said = CliRunner().invoke(cli, ["check", path])
    assert "It carries 2 robots, one for each home place (a 1, c 1)." in said.stdout
    facts = json.loads(CliRunner().invoke(cli, ["check", path, "--json"]).stdout)
    assert facts["carries"]["robots"] == 2


def test_maps_that_say_nothing_of_it_keep_their_version(tmp_path: Path) -> None:
    plain = find_map(written(tmp_path)).version
    assert find_map(written(tmp_path, way="following_s = 20.0")).version != plain
    assert find_map(written(tmp_path, a="homes = 1")).version != plain
    assert find_map(written(tmp_path, a="homes = 0")).version == plain
