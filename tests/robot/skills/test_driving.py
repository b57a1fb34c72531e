"""Closed loop on the simulated track: bytes, pins and frames on one side, posts reached on the other."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from maps import read_map
from robot.drivers.interfaces import STOP, Mode
from robot.scenarios.places import POST_ROOM_M
from robot.simulated import Build, DiodeMount, Options, Person, Pose
from robot.skills import Dock, Done, Failed, FindLine, FollowLine, Say, Turn, Undock
from robot.skills.tunes import TUNES
from tests.robot.skills.track import TICK_S, Drive

Make = Callable[..., Drive]
NEAR_M = 0.03


def follow(drive: Drive, leaving: str | None) -> FollowLine:
    return FollowLine(drive.campus, leaving, shape=drive.shape)


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.slow
def test_it_drives_from_post1_to_post4_and_stops_at_every_post(drive: Make, seed: int):
    robot = drive("post1:post2", seed=seed)
    way = [("post1", "post2", math.pi / 2), ("post2", "post3", -math.pi / 2), ("post3", "post4", math.pi)]
    for leaving, post, turn_rad in way:
        began, line_began = robot.now, len(robot.readings)
        assert robot.do(follow(robot, leaving)) == Done(post)
        assert robot.distance_to_m(post) < NEAR_M
        assert 1.95 / (robot.now - began) > 0.125, "mean speed in m/s with start, braking and standing still at the end"
        on_the_way = robot.readings[line_began:-60]
        assert on_the_way.count("111") / len(on_the_way) < 0.01
        assert robot.do(Turn(turn_rad, robot.shape)).__class__ is Done
    assert robot.loop.view.find_line_episodes == 0
    assert not [speeds for speeds in robot.sent if any(0 < abs(wheel) < 30 for wheel in speeds)]


@pytest.mark.nightly
def test_it_leaves_the_dock_and_docks_again(drive: Make):
    robot = drive("dock", battery_ratio=0.5)
    assert robot.do(Undock(robot.shape)) == Done()
    assert not robot.robot.docked
    assert robot.robot.pose.heading_rad == pytest.approx(-math.pi / 2, abs=0.3)
    assert robot.do(follow(robot, "post5")) == Done("post3")
    assert robot.do(Turn(math.pi, robot.shape)) == Done()
    assert robot.do(follow(robot, "post3")) == Done("post5")
    assert robot.do(Dock()) == Done()
    assert robot.robot.docked
    assert robot.loop.view.base is not None and robot.loop.view.base.charging
    robot.steps(10)
    assert robot.robot.docked, "and it stays in the dock"


@pytest.mark.nightly
def test_a_dock_without_power_is_given_up_after_the_last_try(drive: Make):
    robot = drive("post5:post3")
    robot.robot.place(Pose(2.0, 4.0, math.pi / 2))
    robot.robot.set_fault("dock_unpowered", True)
    assert robot.do(Dock(tries=2), limit_s=310) == Failed("no_dock")
    robot.steps(1)
    assert robot.loop.view.sent == STOP


@pytest.mark.nightly
def test_a_firmware_that_sees_no_dock_roams_no_farther_than_the_room_of_the_post(drive: Make):
    robot = drive("post5:post3")
    robot.robot.set_fault("dock_beams_off", True)
    job, far_m = robot.loop.start(Dock(), robot.now), list[float]()
    for _ in range(400):
        robot.steps(0.1)
        far_m.append(robot.distance_to_m("post5"))
    robot.robot.set_fault("dock_beams_off", False)
    assert max(far_m) < POST_ROOM_M
    assert robot.end_of(job) == Done(), "and docks when it is there again"


@pytest.mark.slow
def test_bouncing_contacts_are_not_a_failed_dock(drive: Make):
    robot = drive("post5:post3", battery_ratio=0.4)
    robot.robot.place(Pose(2.0, 4.0, math.pi / 2))
    robot.robot.set_fault("contact_bounce", True)
    job = robot.loop.start(Dock(), robot.now)
    robot.until(lambda: robot.robot.docked)
    robot.steps(2)
    robot.robot.set_fault("contact_bounce", False)
    assert robot.end_of(job) == Done()


@pytest.mark.parametrize("sideways_m", [0.05, -0.12])
@pytest.mark.nightly
def test_carried_off_the_line_it_finds_it_again_and_goes_on_the_same_way(drive: Make, sideways_m: float):
    robot = drive("post1:post2")
    job = robot.loop.start(follow(robot, "post1"), robot.now)
    robot.steps(4)
    pose = robot.robot.pose
    robot.robot.place(replace(pose, x_m=pose.x_m + sideways_m, heading_rad=pose.heading_rad + 0.2))
    assert robot.end_of(job, limit_s=200) == Done("post2")
    assert robot.distance_to_m("post2") < NEAR_M
    assert robot.loop.view.find_line_episodes >= 1


@pytest.mark.nightly
def test_where_there_is_no_line_at_all_it_says_so_and_stands(drive: Make):
    robot = drive("post1:post2")
    robot.robot.place(Pose(-3.0, -3.0, 0.0))
    assert robot.do(FindLine(robot.shape), limit_s=130) == Failed("line_lost")
    robot.steps(0.2)
    assert robot.loop.view.sent == STOP


def test_worn_tape_does_not_make_it_search(drive: Make):
    robot = drive("post1:post2", options=Options(gap_m=0.02))
    assert robot.do(follow(robot, "post1")) == Done("post2")
    assert robot.loop.view.find_line_episodes == 0


def test_on_a_dock_it_does_not_try_to_follow_a_line(drive: Make):
    assert drive("dock").do(FollowLine(drive("dock").campus)) == Failed("docked")


def test_a_bump_stops_the_wheels_before_any_agent_thinks(drive: Make):
    robot = drive("post1:post2")
    robot.loop.start(follow(robot, "post1"), robot.now)
    robot.steps(3)
    assert robot.loop.view.sent != STOP
    robot.robot.bump("left")
    waited_s = robot.until(lambda: robot.loop.view.sent == STOP, 1.0)
    assert waited_s <= 3 * TICK_S, "a frame of 15 ms and the next tick"
    assert "bump" in robot.loop.view.faults or robot.until(lambda: "bump" in robot.loop.view.faults, 0.1)


def test_after_a_bump_it_backs_off_waits_and_goes_on_to_the_post(drive: Make):
    robot = drive("post1:post2")
    job = robot.loop.start(follow(robot, "post1"), robot.now)
    robot.steps(4)
    robot.robot.bump("both")
    at_bump = robot.robot.pose.y_m
    robot.steps(2.5)
    assert robot.robot.pose.y_m > at_bump + 0.03
    assert robot.loop.view.bumps == 1
    assert robot.end_of(job) == Done("post2")
    assert robot.distance_to_m("post2") < NEAR_M


def test_somebody_who_does_not_move_blocks_the_way(drive: Make):
    robot = drive("post1:post2", options=Options(obstacles=(Person(0.0, 3.0),)))
    assert robot.do(follow(robot, "post1")) == Failed("blocked")
    assert robot.loop.view.bumps == 3


def test_before_a_drop_it_stands_until_somebody_lets_it_go_on(drive: Make):
    robot = drive("post1:post2")
    job = robot.loop.start(follow(robot, "post1"), robot.now)
    robot.steps(3)
    robot.robot.cliff(True)
    robot.steps(5)
    here = robot.robot.pose
    robot.steps(5)
    assert robot.robot.pose == here
    assert robot.loop.view.faults == {"cliff"}
    assert robot.loop.view.base is not None and robot.loop.view.base.mode is Mode.PASSIVE
    robot.robot.cliff(False)
    robot.steps(5)
    assert robot.robot.pose == here
    robot.loop.rearm()
    assert robot.end_of(job) == Done("post2")


def test_without_a_mind_it_stops_within_a_second_and_a_bit(drive: Make):
    robot = drive("post1:post2")
    robot.loop.start(follow(robot, "post1"), robot.now)
    robot.steps(3)
    robot.mind_lives = False
    robot.steps(1.5)
    assert robot.loop.view.faults == {"agent_silent"}
    assert robot.loop.view.sent == STOP
    robot.mind_lives = True
    robot.steps(1)
    assert robot.loop.view.sent != STOP


def test_a_loop_that_hangs_leaves_no_robot_driving_as_long_as_the_driver_is_polled(drive: Make):
    robot = drive("post1:post2")
    robot.loop.start(follow(robot, "post1"), robot.now)
    robot.steps(3)
    for _ in range(100):
        robot.now += 0.01
        robot.robot.step_until(robot.now)
        robot.base.poll(robot.now)
    here = robot.robot.pose
    robot.robot.step_until(robot.now + 1)
    assert robot.robot.pose == here


def test_a_frozen_base_is_noticed_and_the_way_goes_on_when_it_answers_again(drive: Make):
    robot = drive("post1:post2")
    job = robot.loop.start(follow(robot, "post1"), robot.now)
    robot.steps(3)
    robot.robot.set_fault("frozen", True)
    robot.steps(1)
    assert robot.loop.view.faults == {"base_silent"}
    robot.robot.set_fault("frozen", False)
    assert robot.end_of(job) == Done("post2")


def test_the_emergency_stop_ends_even_a_docking_that_the_firmware_drives(drive: Make):
    robot = drive("post5:post3")
    robot.robot.place(Pose(2.0, 3.8, math.pi / 2))
    job = robot.loop.start(Dock(), robot.now)
    robot.steps(2)
    robot.loop.emergency_stop()
    assert robot.end_of(job, 1.0) == Failed("emergency_stop")
    robot.steps(1)
    here = robot.robot.pose
    robot.steps(2)
    assert robot.robot.pose == here
    robot.loop.rearm()
    robot.steps(0.1)
    assert robot.loop.view.faults == frozenset()


def test_with_the_sensor_near_the_axle_it_follows_too(drive: Make):
    build = Build(diodes=DiodeMount(lead_mm=20.0))
    robot = drive("post1:post2", options=Options(build=build))
    assert robot.do(follow(robot, "post1")) == Done("post2")


def test_without_a_camera_it_stands_and_with_the_next_picture_it_drives_on_to_the_post(drive: Make):
    robot = drive("post3:post4")
    robot.robot.set_fault("camera_dead", True)
    job = robot.loop.start(follow(robot, "post3"), robot.now)
    robot.steps(3.0)
    assert robot.loop.view.faults == {"camera_stale"}
    assert robot.loop.view.sent.still
    robot.robot.set_fault("camera_dead", False)
    assert robot.end_of(job) == Done("post4")


BENDS = """name = "bends"
title = "A line with two bends"
[[post]]
name = "a"
x_m = 0.0
y_m = 0.0
[[post]]
name = "b"
x_m = 1.8
y_m = 1.2
dock = { x_m = 9.0, y_m = 9.0, heading_deg = 0.0 }
[[corridor]]
ends = ["a", "b"]
via = [[0.9, 0.0], [0.9, 1.2]]
bend_radius_m = 0.3
"""


def test_bends_worn_tape_and_flipped_reads_do_not_lose_the_line(drive: Make, tmp_path: Path):
    (tmp_path / "bends.toml").write_text(BENDS)
    robot = drive("a:b", campus=read_map(tmp_path / "bends.toml"), options=Options(gap_m=0.02))
    robot.robot.set_fault("floor_flip", 0.01)
    began, readings = robot.now, len(robot.readings)
    assert robot.do(follow(robot, "a")) == Done("b")
    assert robot.loop.view.find_line_episodes == 0
    assert robot.loop.view.odometry.travelled_mm / (robot.now - began) > 110
    on_the_way = robot.readings[readings:-60]
    assert sum(pattern in ("111", "010") for pattern in on_the_way) / len(on_the_way) < 0.05


def heard(robot: Drive, for_s: float) -> list[str]:
    """Return what comes out of its speaker in that time, by name."""
    names = {tuple(note for note, _ in tune): name for name, tune in TUNES.items()}
    number, found = 0, []
    for _ in range(round(for_s / TICK_S)):
        robot.tick()
        number, tunes = robot.robot.tunes_since(number)
        found += [names[tune] for tune in tunes]
    return found


def test_a_tune_is_heard_although_another_one_was_just_being_played(drive: Make):
    robot = drive("post1:post2")
    robot.steps(2.5)  # in Passive the base plays nothing
    for tune in ("refused", "accepted"):
        robot.loop.start(Say(tune), robot.now)
    assert heard(robot, 1.5) == ["refused", "accepted"]


def test_of_many_tunes_the_newest_are_heard(drive: Make):
    robot = drive("post1:post2")
    robot.steps(2.5)  # in Passive the base plays nothing
    for tune in ("refused",) * 8 + ("accepted",):
        robot.loop.start(Say(tune), robot.now)
    assert heard(robot, 6.0) == ["refused", "refused", "refused", "accepted"]
