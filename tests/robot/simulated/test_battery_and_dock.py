"""Battery and dock: what charges and empties a robot, and how the firmware finds its dock."""

import math
from itertools import pairwise

import pytest

from robot.simulated import Options, Pack, Pose
from robot.simulated.body import Build

PASSIVE, SAFE, FULL = 1, 2, 3
NOT, RECONDITION, CHARGING, TRICKLE, WAITING, FAULT = range(6)


@pytest.mark.slow
def test_driving_empties_the_battery_faster_than_standing(make):
    def used_mah(speed) -> float:
        bench = make(battery_ratio=0.9)
        bench.send(128, 131)
        bench.drive(speed, -speed)
        bench.run(120)
        return 0.9 * 2696 - bench.robot.battery.charge_mah

    assert used_mah(0) == pytest.approx(250 * 120 / 3600, rel=0.01)
    assert used_mah(100) == pytest.approx(850 * 120 / 3600, rel=0.02)


def test_voltage_falls_with_the_charge(make):
    bench = make()
    bench.send(128, 131)
    volts = []
    for ratio in (1.0, 0.5, 0.25, 0.1, 0.01):
        bench.robot.sag(ratio)
        bench.run(0.1)
        volts.append(bench.ask(22))
    assert all(high > low for high, low in pairwise(volts))
    assert volts[0] > 15500
    assert volts[2] > 13200 > volts[3]


def test_a_docked_robot_charges_in_off_and_passive_until_it_is_full(make):
    bench = make("dock", battery_ratio=0.5, capacity_mah=60)
    bench.send(128)
    bench.run(2)
    assert (bench.ask(21), bench.ask(34), bench.ask(23)) == (CHARGING, 2, 1250)
    bench.run(30 / 1250 * 3600)
    assert bench.ask(21) == TRICKLE
    assert bench.ask(25) == bench.ask(26) == 60


@pytest.mark.slow
def test_a_stronger_charger_fills_the_battery_sooner(make):
    options = Options(build=Build(pack=Pack(ratio=0.5, charger_ma=10_000.0)))
    bench = make("dock", options=options)
    bench.send(128)
    bench.run(2)
    assert bench.ask(23) == 10_000
    bench.run(0.5 * 2696 / 10_000 * 3600)
    assert bench.ask(21) == TRICKLE


def test_an_empty_battery_is_reconditioned_first(make):
    bench = make("dock", battery_ratio=0.0)
    bench.send(128)
    bench.run(2)
    assert bench.ask(21) in (RECONDITION, CHARGING)


def test_trickle_charge_does_not_feed_a_computer_on_the_battery(make):
    options = Options(build=Build(pack=Pack(capacity_mah=60, ratio=1.0, host_ma=600)))
    bench = make("dock", options=options)
    bench.send(128)
    bench.run(120)
    assert bench.ask(21) == TRICKLE
    assert bench.robot.battery.ratio < 0.75


def test_safe_on_the_dock_bounces_back_to_passive(make):
    bench = make("dock")
    bench.send(128, 131)
    bench.run(0.1)
    assert bench.ask(35) == PASSIVE


def test_full_on_the_dock_ends_the_charge_and_can_back_off(make):
    bench = make("dock", battery_ratio=0.5)
    bench.send(128)
    bench.run(3)
    bench.send(132)
    bench.run(0.1)
    assert (bench.ask(35), bench.ask(21)) == (FULL, NOT)
    bench.drive(-100, -100)
    bench.run(3)
    bench.drive(0, 0)
    bench.send(131)
    bench.run(1)
    assert (bench.ask(35), bench.ask(34)) == (SAFE, 0)
    assert bench.robot.pose.y_m == pytest.approx(4.2, abs=0.02)


def test_a_robot_cannot_drive_through_the_dock(make):
    bench = make("dock")
    bench.send(128, 132)
    bench.drive(200, 200)
    bench.run(3)
    assert bench.robot.pose.y_m == pytest.approx(4.5, abs=0.02)


@pytest.mark.parametrize("left_m", [-0.15, 0.0, 0.15])
@pytest.mark.parametrize("turned_deg", [-25, 0, 25])
@pytest.mark.parametrize("before_m", [0.4, 0.8, 1.4])
@pytest.mark.nightly
def test_seek_dock_finds_a_dock_in_front_of_it(make, left_m, turned_deg, before_m):
    bench = make("dock", options=Options(), battery_ratio=0.5)
    heading = math.pi / 2 + math.radians(turned_deg)
    bench.robot.place(Pose(2.0 - left_m, 4.5 - before_m, heading))
    bench.send(128, 143)
    bench.run(40)
    assert bench.robot.docked
    assert (bench.ask(21), bench.ask(34), bench.ask(35)) == (CHARGING, 2, PASSIVE)


def test_seek_dock_far_from_any_dock_gives_up_after_a_minute(make):
    bench = make("post4:post3")
    bench.send(128, 143)
    bench.run(30)
    assert bench.robot.driven_mm > 500
    bench.run(40)
    driven = bench.robot.driven_mm
    bench.run(10)
    assert bench.robot.driven_mm == driven
    assert not bench.robot.docked


def test_a_wheel_drop_aborts_the_search_for_the_dock(make):
    bench = make("post5")
    bench.send(128, 143)
    bench.run(0.5)
    bench.robot.lift(True)
    bench.run(1)
    driven = bench.robot.driven_mm
    bench.run(2)
    assert bench.robot.driven_mm == driven


def test_the_beams_say_on_which_side_of_the_dock_a_robot_is(make):
    """Green is on the left of a robot that comes, red on the right, both on the middle line."""
    bench = make("dock")
    bench.send(128)
    seen = []
    for left_m in (0.3, 0.0, -0.3):
        bench.robot.place(Pose(2.0 - left_m, 3.5, math.pi / 2))
        seen.append(bench.ask(17))
    assert seen == [164, 172, 168]
    bench.robot.place(Pose(2.0, 4.2, math.pi / 2))
    assert bench.ask(17) == 173
    bench.robot.place(Pose(2.0, 4.2, 0.0))
    assert (bench.ask(52), bench.ask(53)) == (173, 0), "the dock is on the left"
