"""What fleets are compared with: robots that pass through each other, by the table of durations and the map alone."""

from pathlib import Path
from random import Random

import pytest

from benchmarks.fleet_simulation.durations import FITTED
from benchmarks.fleet_simulation.grounds import Ground
from benchmarks.fleet_simulation.simulation import homes
from benchmarks.fleet_simulation.unhindered import Unhindered
from maps import CampusMap, shortest_route


@pytest.fixture(scope="module")
def campus(tmp_path_factory: pytest.TempPathFactory) -> CampusMap:
    return Ground(bays=1).read(Path(tmp_path_factory.mktemp("ground")))


def test_a_way_takes_what_its_corridors_take_and_some_seconds_at_each_post(campus: CampusMap) -> None:
    metres = campus.corridor("canal", "nicol").length_m + campus.corridor("nicol", "cttc").length_m
    took_s = Unhindered(campus, 5, 1).drive_s("canal", "cttc")
    least, most = FITTED.each_way
    assert metres / FITTED.speed_m_s * least * 0.99 < took_s < metres / FITTED.speed_m_s * most * 1.01 + 30.0
    assert Unhindered(campus, 5, 1).drive_s("canal_bay1", "canal") == 0.0


def test_twice_as_many_robots_and_hours_deliver_about_twice_as_much(campus: CampusMap) -> None:
    def delivered(robots: int, hours: float) -> int:
        return sum(Unhindered(campus, 5, seed).delivered(homes(campus, robots), hours) for seed in range(5))

    assert delivered(4, 24.0) == pytest.approx(2 * delivered(2, 24.0), rel=0.15)
    assert delivered(2, 48.0) == pytest.approx(2 * delivered(2, 24.0), rel=0.15)


def test_the_nearest_order_is_fetched_so_that_more_to_choose_from_is_more_delivered(campus: CampusMap) -> None:
    few, many = (Unhindered(campus, free, 1).delivered(homes(campus, 4), 48.0) for free in (1, 9))
    assert many > 1.2 * few


def test_one_robot_that_cannot_choose_takes_all_its_time_for_ways_and_people(campus: CampusMap) -> None:
    hours, at, metres = 96.0, campus.track.address_of(homes(campus, 1)[0]), 0.0
    count = Unhindered(campus, 1, 1).delivered(homes(campus, 1), hours)
    coming = Random("1 orders")
    for _ in range(count):
        start, end = coming.sample(sorted(campus.posts), 2)
        metres += shortest_route(campus, at, start).length_m + shortest_route(campus, start, end).length_m
        at = end
    left_s = hours * 3600.0 - metres / FITTED.speed_m_s
    assert 250.0 < left_s / count < 500.0, "people take 200 s for an order, moves at posts the rest"
