"""Where the robots of a demonstration truly are is looked at without anybody's word."""

import json
from pathlib import Path

import pytest

from demo.fleet.campus import campus_of
from demo.fleet.places import AT_POST_M, TruePlaces, somewhere
from demo.fleet.settings import FleetDemo
from demo.settings import DemoFailed
from maps import CampusMap, Point, builtin_map, find_map


@pytest.fixture(scope="module")
def campus() -> CampusMap:
    return builtin_map("carleton")


class Worlds:
    """The files in which simulated worlds keep the places of their robots."""

    def __init__(self, campus: CampusMap, folder: Path) -> None:
        self.files = {robot: folder / robot for robot in ("r1", "r2")}
        self.places = TruePlaces(campus, self.files)

    def put(self, robot: str, x_m: float, y_m: float) -> None:
        self.files[robot].write_text(json.dumps({"x_m": x_m, "y_m": y_m}).ljust(512))
        self.places.look()


@pytest.fixture
def worlds(campus: CampusMap, tmp_path: Path) -> Worlds:
    return Worlds(campus, tmp_path)


def test_near_a_post_a_robot_is_at_it_and_farther_in_the_corridor_whose_tape_is_nearest(campus: CampusMap) -> None:
    uc = campus.post("uc")
    assert somewhere(campus, Point(uc.x_m, uc.y_m + AT_POST_M / 2)).post == "uc"
    assert str(somewhere(campus, Point(uc.x_m, uc.y_m + 2 * AT_POST_M))) == "in canal-uc"
    for corridor in campus.corridors:
        assert somewhere(campus, corridor.tape[len(corridor.tape) // 2 - 1]).corridor in (None, corridor)


def test_two_robots_in_one_corridor_are_an_error_that_names_all_three(campus: CampusMap, worlds: Worlds) -> None:
    worlds.put("r1", 125.0, 0.0)
    with pytest.raises(DemoFailed, match=r"r1 and r2 are both in the corridor canal-uc"):
        worlds.put("r2", 125.0, 40.0)
    assert worlds.places.met == 1


def test_robots_in_two_corridors_or_at_a_post_beside_one_are_none(worlds: Worlds) -> None:
    worlds.put("r1", 125.0, 0.0)
    worlds.put("r2", 125.0, 50.5)
    worlds.put("r2", 125.0, 55.0)
    assert (worlds.places.moves, worlds.places.most_at_once, worlds.places.met) == (1, 2, 0)


def test_a_world_that_has_not_begun_is_no_place(worlds: Worlds) -> None:
    worlds.places.look()
    assert worlds.places.seen == {}


def test_the_tunnels_of_a_demonstration_are_a_tenth_as_long_and_its_robots_are_at_home_in_their_docks(
    tmp_path: Path, campus: CampusMap
) -> None:
    wanted = campus_of("carleton")
    demo = FleetDemo(tmp_path, tmp_path / "door", port=0, speed=8.0, once=True, as_json=True, campus=wanted)
    demo.lay_out()
    small = find_map(demo.map)
    assert small.corridor("uc", "canal").length_m == pytest.approx(campus.corridor("uc", "canal").length_m / 10)
    assert sorted(demo.homes.values()) == sorted(post.name for post in small.docks())
    assert demo.service.traffic == "schedule"
