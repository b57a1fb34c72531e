"""Whole robots with the whole service in one stepped world: no body touches another, and the judge would see it."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

from benchmarks.fleet_simulation.service import CALM
from benchmarks.stepped_fleet.fates import OFF_S, Rates
from benchmarks.stepped_fleet.judge import TrueFloor
from benchmarks.stepped_fleet.run import Fleet, Run
from maps import find_map
from robot.simulated.true_poses import TruePose

MAP = Path(__file__).parent / "bays.toml"
STAR = MAP.with_name("star.toml")
TRACK = find_map(MAP).track


def pose(at_s: float, x_m: float, y_m: float) -> TruePose:
    return TruePose(at_s, x_m, y_m, 0.0, 0)


def test_the_judge_sees_bodies_that_overlap():
    floor = TrueFloor(TRACK)
    for at_s, x_m in ((0.0, 1.9), (1.0, 1.6), (2.0, 1.3)):
        floor.look({"r1": pose(at_s, 1.0, 2.0), "r2": pose(at_s, x_m, 2.0)})
    assert [(one.one, one.other) for one in floor.collisions.overlaps] == [("r1", "r2")]


@pytest.mark.parametrize(("granted", "seen"), [({"post2-post3"}, 0), ({"post1-post2"}, 1), (set(), 1)])
def test_the_judge_sees_a_corridor_that_was_not_granted(granted: set[str], seen: int):
    floor = TrueFloor(TRACK)
    for _ in range(3):
        floor.look_at_grants({"r1": pose(0.0, 1.0, 2.0)}, {"r1": granted})
    assert len(floor.ungranted) == seen


def test_where_a_person_puts_a_robot_it_has_not_entered_and_where_it_drives_then_it_has():
    floor = TrueFloor(TRACK)
    floor.look_at_grants({"r1": pose(0.0, 2.0, 2.0)}, {})
    floor.look_at_grants({"r1": replace(pose(1.0, 1.0, 2.0), handled=1)}, {})
    assert floor.ungranted == []
    floor.look_at_grants({"r1": replace(pose(2.0, 2.0, 2.0), handled=1)}, {})
    floor.look_at_grants({"r1": replace(pose(3.0, 1.0, 2.0), handled=1)}, {})
    assert len(floor.ungranted) == 1


def test_the_judge_counts_how_long_a_robot_is_on_a_crossing():
    floor = TrueFloor(TRACK)
    for at_s in (0.0, 4.0, 9.0):
        floor.look({"r1": pose(at_s, 2.0 + 0.3 * math.sin(at_s), 2.0)})
    floor.look({"r1": pose(12.0, 2.0, 3.0)})
    assert floor.longest_on_crossing_s == 9.0


@pytest.mark.nightly
@pytest.mark.timeout(600)
def test_two_robots_with_the_whole_service_deliver_and_touch_nothing():
    figures = Run(Fleet(str(MAP), robots=2, scale=1.0, waiting=3), minutes=5, seed=1).carry_out()
    assert (figures["touches"], figures["ungranted"], figures["astray"]) == (0, [], [])
    assert figures["orders"]["delivered"] >= 1
    assert 0 < figures["longest_on_a_crossing_s"] < 20


@pytest.mark.nightly
@pytest.mark.timeout(600)
def test_robots_killed_in_turns_on_a_crossing_go_on_among_others_and_touch_nothing():
    fleet = Fleet(str(STAR), robots=3, scale=1.0, waiting=4, rates=Rates(turns_killed=0.5))
    figures = Run(fleet, minutes=10, seed=1).carry_out()
    assert (figures["touches"], figures["ungranted"], figures["astray"]) == (0, [], [])
    assert figures["befallen"]["kill in a turn"] >= 5
    assert figures["befallen"]["kill in a turn beside others"] >= 1
    assert figures["alarms"] == {}, "no person is asked"
    assert figures["longest_on_a_crossing_s"] < 3 * OFF_S, "one that is killed twice there goes on, too"
    assert figures["orders"]["delivered"] >= 5


@pytest.mark.nightly
@pytest.mark.timeout(600)
def test_robots_that_are_carried_away_or_found_dead_go_on_among_closures_and_touch_nothing():
    rates = Rates(kill_s=300, cut_s=200, lift_s=120, die_s=300, close_s=200)
    figures = Run(
        Fleet(str(STAR), robots=3, scale=1.0, waiting=4, rates=rates, pace=CALM), minutes=15, seed=1
    ).carry_out()
    assert ([one for one in figures["collisions"] if "a person" not in one], figures["ungranted"]) == ([], [])
    assert figures["astray"] == []
    assert min(figures["befallen"][what] for what in ("kill", "cut", "lift", "death", "closure")) >= 1
    assert figures["handed_over"] >= 3


@pytest.mark.nightly
@pytest.mark.timeout(600)
def test_a_run_ends_when_what_befell_its_robots_is_over_and_they_have_told_all():
    rates = Rates(cut_s=20, die_s=600, kill_s=300)
    figures = Run(Fleet(str(STAR), robots=3, scale=1.0, waiting=6, rates=rates), minutes=5, seed=1).carry_out()
    assert figures["befallen"]["cut"] >= 5, "and one just before the end"
    assert (figures["out_of_reach"], figures["astray"]) == ([], [])
    assert figures["alarms"]["emergency_stop"] == figures["befallen"]["death"] >= 1, "each that lay dead was found"


@pytest.mark.nightly
@pytest.mark.timeout(600)
def test_robots_come_out_again_of_the_bays_of_a_post_without_network_and_touch_nothing(tmp_path: Path):
    silent = tmp_path / "silent.toml"
    silent.write_text(STAR.read_text().replace('name = "south"', 'name = "south"\nnetwork = false'))
    figures = Run(Fleet(str(silent), robots=2, scale=1.0, waiting=3), minutes=6, seed=1).carry_out()
    assert (figures["touches"], figures["ungranted"]) == (0, [])
    assert figures["befallen"]["silence"] >= 1
    assert figures["orders"]["delivered"] >= 4
