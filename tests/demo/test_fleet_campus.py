"""A fleet has as many robots as its map has homes for; letters begin beside each of them."""

from itertools import islice
from pathlib import Path

import pytest
from typer.testing import CliRunner

from app.core.errors import StartError
from demo.__main__ import app as commands
from demo.fleet.campus import NAMES, Campus, campus_of
from demo.fleet.errands import errands, first_errands
from demo.fleet.settings import FleetDemo
from maps import read_map
from maps.campus_map import builtin_path
from tests.plain_maps import PLAIN_TUNNELS

SIX_DOCKS = ("uc", "canal", "mackenzie", "commons", "richcraft", "robertson")


@pytest.fixture
def wide_map(tmp_path: Path) -> Path:
    """The tunnels of Carleton with two docks more, in the homes at its dead ends."""
    text = builtin_path("carleton").read_text(encoding="utf-8")
    for post in ("richcraft", "robertson"):
        before, name, after = text.partition(f'name = "{post}"\n')
        assert name
        text = before + name + after.replace("home = true", "home = true\ndock = true", 1)
    file = tmp_path / "wide.toml"
    file.write_text(text, encoding="utf-8")
    assert {home.bay_of for home in read_map(file).track.home_bays if home.dock} == set(SIX_DOCKS)
    return file


HOMES = ("uc", "canal", "mackenzie", "commons", "loeb", "library", "richcraft", "robertson")
"""Of the shipped map, those with a dock first: each is the first bay of its post."""


def posts_of_homes(campus: Campus) -> list[str]:
    return [campus.map.address_of(home) for home in campus.homes.values()]


def test_without_a_number_there_is_a_robot_for_every_dock_of_the_map(wide_map: Path) -> None:
    assert set(posts_of_homes(campus_of(str(wide_map)))) == set(SIX_DOCKS)
    assert list(campus_of("carleton").homes.values()) == [f"{post}_bay1" for post in HOMES[:4]]
    assert campus_of(str(wide_map), 5).homes.keys() == {"r1", "r2", "r3", "r4", "r5"}


@pytest.mark.parametrize("robots", range(1, len(HOMES) + 1))
def test_there_may_be_a_robot_for_every_home_and_the_first_ones_have_a_dock(robots: int) -> None:
    assert list(campus_of("carleton", robots).homes.values()) == [f"{post}_bay1" for post in HOMES[:robots]]


def test_on_a_map_without_bays_the_docks_are_the_homes() -> None:
    assert list(campus_of(str(PLAIN_TUNNELS)).homes.values()) == list(HOMES[:4])
    with pytest.raises(StartError, match=r"has homes for 4 robots \(uc, canal, mackenzie, commons\); 5 were"):
        campus_of(str(PLAIN_TUNNELS), 5)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (
            ("--robots", "9"),
            "The map carleton has homes for 8 robots (uc_bay1, canal_bay1, mackenzie_bay1, commons_bay1, ",
        ),
        (("--map", "atlantis"), "The map cannot be used. atlantis"),
    ],
)
def test_more_robots_than_homes_or_no_such_map_are_one_sentence(options: tuple[str, str], sentence: str) -> None:
    ran = CliRunner().invoke(commands, ["fleet", "--json", "--port", "0", *options])
    said = ran.stderr.splitlines()
    assert (ran.exit_code, len(said), ran.stdout) == (2, 2, "")
    assert said[1].startswith(f"campus-mail: {sentence}")


def test_a_letter_begins_beside_every_home_and_each_goes_to_another_person(wide_map: Path) -> None:
    campus = campus_of(str(wide_map))
    first = list(first_errands(campus))
    assert [campus.offices[errand.sender] for errand in first] == posts_of_homes(campus)
    assert len({errand.recipient for errand in first}) == len(first)
    assert not {campus.offices[errand.recipient] for errand in first} & set(SIX_DOCKS)


def test_there_is_a_person_at_every_post_and_a_seed_says_who_sends() -> None:
    campus = campus_of("carleton")
    assert sorted(campus.offices.values()) == sorted(campus.map.posts)
    assert list(campus.offices) == list(NAMES[: len(campus.offices)])
    stream = [list(islice(errands(7, campus.offices), 20)) for _ in range(2)]
    assert stream[0] == stream[1]
    assert all(errand.sender != errand.recipient for errand in stream[0])


def test_every_robot_is_started_at_home(tmp_path: Path) -> None:
    wanted = campus_of("carleton", len(HOMES))
    demo = FleetDemo(tmp_path, tmp_path / "door", port=0, speed=8.0, once=True, as_json=True, campus=wanted)
    demo.lay_out()
    starts = []
    for robot, home in demo.homes.items():
        command = demo.robot_command(robot)
        starts.append(command[command.index("--start") + 1])
        config = Path(command[command.index("--config") + 1])
        assert f'home = "{home}"' in config.read_text()
    assert starts == [*(f"dock:{post}_bay1" for post in HOMES[:4]), *(f"{post}_bay1" for post in HOMES[4:])]
