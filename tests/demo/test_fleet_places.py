"""Where the robots of a demonstration truly are is looked at without anybody's word."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from demo.fleet.campus import campus_of
from demo.fleet.places import AT_POST_M, TruePlaces, somewhere
from demo.fleet.settings import FleetDemo
from demo.settings import DemoFailed
from maps import CampusMap, Point, builtin_map, find_map
from robot.simulated import TruePose, WorldFile

BAY = """
name = "short"
title = "Short"
corridor = [{ ends = ["a", "b"] }]
[[post]]
name = "a"
x_m = 0.0
y_m = 0.0
[[post.bay]]
bearing_deg = 180
length_m = 1.5
dock = true
[[post]]
name = "b"
x_m = 20.0
y_m = 0.0
"""


@pytest.fixture(scope="module")
def campus() -> CampusMap:
    return builtin_map("carleton")


class Seen:
    """A world in which robots are put down, and the places that the demonstration sees."""

    def __init__(self, campus: CampusMap, folder: Path, ghosts: bool = False) -> None:
        self._world = WorldFile.create(folder / "world", ghosts)
        self._now = 0.0
        self.log = folder / "true_poses.csv"
        self.places = TruePlaces(campus, folder / "world", self.log, ghosts)

    def put(self, robot: str, x_m: float, y_m: float) -> None:
        self._now += 1.0
        self._world.write(self._world.take(robot), TruePose(self._now, x_m, y_m, 0.0))
        self.places.look()

    def close(self) -> None:
        self.places.close()
        self._world.close()


@pytest.fixture
def seen(campus: CampusMap, tmp_path: Path) -> Iterator[Seen]:
    made = Seen(campus, tmp_path)
    yield made
    made.close()


@pytest.fixture
def ghosts(campus: CampusMap, tmp_path: Path) -> Iterator[Seen]:
    made = Seen(campus, tmp_path, ghosts=True)
    yield made
    made.close()


def test_near_a_post_a_robot_is_at_it_and_farther_in_the_corridor_whose_tape_is_nearest(campus: CampusMap) -> None:
    uc = campus.post("uc")
    assert somewhere(campus, Point(uc.x_m, uc.y_m + AT_POST_M / 2)).post == "uc"
    assert str(somewhere(campus, Point(uc.x_m, uc.y_m + 2 * AT_POST_M))) == "in canal-uc"
    for corridor in campus.corridors:
        assert somewhere(campus, corridor.tape[len(corridor.tape) // 2 - 1]).corridor in (None, corridor)


def test_in_a_bay_and_in_its_dock_a_robot_is_at_the_post_however_long_the_spur(tmp_path: Path) -> None:
    (tmp_path / "short.toml").write_text(BAY)
    campus = find_map(str(tmp_path / "short.toml"))
    for x_m in (-0.9, -1.5, -2.0):
        assert somewhere(campus, Point(x_m, 0.0)).post == "a"
    assert str(somewhere(campus, Point(0.9, 0.0))) == "in a-b"


def test_two_robots_in_one_corridor_are_an_error_that_names_all_three(seen: Seen) -> None:
    seen.put("r1", 125.0, 0.0)
    with pytest.raises(DemoFailed, match=r"r1 and r2 are both in the corridor canal-uc"):
        seen.put("r2", 125.0, 40.0)
    assert seen.places.met == 1


def test_two_bodies_that_overlap_at_a_post_are_an_error_that_says_where_and_how_far(seen: Seen) -> None:
    seen.put("r1", 125.0, 50.5)
    seen.put("r2", 125.0, 51.0)
    with pytest.raises(DemoFailed, match=r"r1 and r2 overlap by 50 mm at \(125.00, 50.65\).*true_poses.csv"):
        seen.put("r2", 125.0, 50.7985)
    assert seen.log.read_text().splitlines()[-1].startswith("3.000,r2,125.0000,50.7985")


def test_bodies_that_touch_at_a_post_are_counted(seen: Seen) -> None:
    seen.put("r1", 125.0, 50.5)
    seen.put("r2", 125.0, 51.0)
    seen.put("r2", 125.0, 50.5 + 0.3485)
    assert (seen.places.judge.touches, seen.places.judge.overlaps) == (1, [])


def test_among_ghosts_both_are_counted_once_and_raise_nothing(ghosts: Seen) -> None:
    for y_m in (0.0, 40.0, 0.2, 0.3, 50.5, 0.2):
        ghosts.put("r1", 125.0, 0.0)
        ghosts.put("r2", 125.0, y_m)
    assert (ghosts.places.met, len(ghosts.places.judge.overlaps)) == (2, 2)


def test_robots_in_two_corridors_or_at_a_post_beside_one_are_none(seen: Seen) -> None:
    seen.put("r1", 125.0, 0.0)
    seen.put("r2", 125.0, 50.5)
    seen.put("r2", 125.0, 55.0)
    assert (seen.places.moves, seen.places.most_at_once, seen.places.met) == (1, 2, 0)


def test_a_world_that_has_not_begun_is_no_place(seen: Seen) -> None:
    seen.places.look()
    assert seen.places.seen == {}


def test_the_tunnels_of_a_demonstration_are_a_tenth_as_long_and_its_robots_are_at_home_in_their_docks(
    tmp_path: Path, campus: CampusMap
) -> None:
    wanted = campus_of("carleton")
    demo = FleetDemo(tmp_path, tmp_path / "door", port=0, speed=8.0, once=True, as_json=True, campus=wanted)
    demo.lay_out()
    small = find_map(demo.map)
    assert small.corridor("uc", "canal").length_m == pytest.approx(campus.corridor("uc", "canal").length_m / 10)
    assert sorted(demo.homes.values()) == sorted(bay.name for bay in small.track.home_bays if bay.dock)


@pytest.mark.parametrize("ghosts", [False, True])
def test_all_robots_of_a_demonstration_join_its_one_world(tmp_path: Path, ghosts: bool) -> None:
    wanted = campus_of("carleton")
    run = {"port": 0, "speed": 8.0, "once": True, "as_json": True}
    demo = FleetDemo(tmp_path, tmp_path / "door", **run, campus=wanted, ghosts=ghosts)
    demo.lay_out()
    world = WorldFile(demo.world_file)
    assert (world.ghosts, world.poses()) == (ghosts, {})
    world.close()
    for robot in demo.homes:
        command = demo.robot_command(robot)
        assert command[command.index("--world") + 1] == str(demo.world_file)
