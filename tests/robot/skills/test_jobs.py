"""Jobs: every one ends once; one motion at a time; handovers, pulses, songs."""

import threading
from collections.abc import Callable
from hashlib import sha256
from itertools import pairwise

import pytest

from robot.drivers.interfaces import STOP, Mode, WheelSpeeds
from robot.errors import UnknownSkill
from robot.skills import Done, DrivePulse, Failed, FollowLine, PaperTurn, Say, WaitHandover
from tests.robot.skills.track import Drive

Make = Callable[..., Drive]
CODE = "CM1:" + "0123456789abcdef" * 2
VERIFIER = sha256(CODE.encode()).hexdigest()


def test_a_second_motion_fails_with_busy_and_the_first_goes_on(drive: Make):
    robot = drive("post1:post2")
    first = robot.loop.start(FollowLine(robot.campus, "post1", shape=robot.shape), robot.now)
    robot.steps(1)
    assert robot.do(DrivePulse("left"), 1) == Failed("busy")
    assert robot.loop.view.motion == "follow_line"
    assert robot.end_of(first) == Done("post2")


def test_a_cancelled_motion_ends_once_and_the_wheels_stand(drive: Make):
    robot = drive("post1:post2")
    job = robot.loop.start(FollowLine(robot.campus, "post1", shape=robot.shape), robot.now)
    robot.steps(1)
    robot.loop.cancel(job)
    assert robot.end_of(job, 0.1) == Failed("cancelled")
    robot.tick()
    assert robot.loop.view.sent == STOP
    robot.loop.cancel(job)
    robot.steps(0.2)
    assert robot.loop.finished() == ()


def test_a_job_that_takes_too_long_fails_by_name(drive: Make):
    robot = drive("post1:post2")
    skill = FollowLine(robot.campus, "post1", shape=robot.shape, limit_s=2.0)
    assert robot.do(skill, 2.2) == Failed("timeout")


def test_a_pulse_is_done_at_once_and_drives_for_a_fifth_of_a_second(drive: Make):
    robot = drive("post1:post2")
    robot.do(DrivePulse("stop"))
    robot.steps(1)
    begin = len(robot.sent)
    assert robot.do(DrivePulse("forward"), 0.1) == Done(None, (), WheelSpeeds(50, 50), 0.2)
    robot.steps(1)
    assert 9 <= robot.sent[begin:].count((50, 50)) <= 11


def test_pulses_that_follow_each_other_make_one_movement(drive: Make):
    robot = drive("post1:post2")
    for _ in range(20):
        robot.do(DrivePulse("forward"))
        robot.steps(0.1)
    driven = [speeds for before, speeds in pairwise(robot.sent) if before == (50, 50)]
    assert driven.count((0, 0)) <= 1


def test_no_pulse_asks_a_wheel_for_less_than_30_mm_s(drive: Make):
    robot = drive("post1:post2")
    for way in ("forward", "left", "right", "spiral", "stop"):
        robot.do(DrivePulse(way))
        robot.steps(0.3)
    assert not [speeds for speeds in robot.sent if any(0 < abs(wheel) < 30 for wheel in speeds)]


def test_an_unknown_pulse_is_an_error_and_never_nothing():
    with pytest.raises(UnknownSkill, match="backwards"):
        DrivePulse("backwards")
    with pytest.raises(UnknownSkill, match="yodel"):
        Say("yodel")


def test_the_papers_turn_ends_with_the_line_centred(drive: Make):
    robot = drive("post3:post2")
    assert robot.do(PaperTurn(1.5708, robot.shape)) == Done()
    assert robot.loop.view.reading.centre


def test_the_papers_turn_without_a_line_fails_in_ten_seconds(drive: Make):
    robot = drive("post1:post2")
    outcome = robot.do(PaperTurn(1.5708, robot.shape), 10.5)
    assert isinstance(outcome, Failed)


def test_the_right_code_opens(drive: Make):
    robot = drive("post1:post2")
    job = robot.loop.start(WaitHandover({VERIFIER}, 60.0), robot.now)
    robot.steps(2)
    robot.robot.show_code(CODE)
    outcome = robot.end_of(job, 2.0)
    assert isinstance(outcome, Done) and outcome.result == VERIFIER


def test_a_wrong_code_is_refused_with_a_sound_once_and_waited_on(drive: Make):
    robot = drive("post1:post2")
    robot.do(DrivePulse("stop"))
    waiting = WaitHandover({VERIFIER}, 60.0)
    job = robot.loop.start(waiting, robot.now)
    robot.robot.show_code("CM1:" + "f" * 32)
    robot.steps(5)
    assert waiting.refused == 1
    robot.robot.show_code(CODE)
    assert robot.end_of(job, 2.0).__class__ is Done


def test_a_code_that_was_shown_before_the_wait_does_not_count(drive: Make):
    robot = drive("post1:post2")
    robot.robot.show_code(CODE, for_s=1.0)
    robot.steps(2)
    job = robot.loop.start(WaitHandover({VERIFIER}, 3.0), robot.now)
    assert robot.end_of(job, 4.0) == Failed("no_one_came")


def test_spot_pressed_twice_loads_without_a_name(drive: Make):
    robot = drive("post1:post2")
    robot.steps(3)
    job = robot.loop.start(WaitHandover({VERIFIER}, 60.0), robot.now)
    robot.tick()
    press_spot(robot)
    assert not robot.loop.finished(), "once may be an accident"
    press_spot(robot)
    outcome = robot.end_of(job, 1.0)
    assert isinstance(outcome, Done) and outcome.result is None


def test_spot_does_not_open_where_it_must_not(drive: Make):
    robot = drive("post1:post2")
    robot.steps(3)
    job = robot.loop.start(WaitHandover({VERIFIER}, 5.0, spot_counts=False), robot.now)
    press_spot(robot)
    press_spot(robot)
    assert robot.end_of(job, 6.0) == Failed("no_one_came")


def test_a_robot_at_rest_keeps_its_buttons_to_itself_and_on_the_dock_it_charges(drive: Make):
    robot = drive("post1:post2")
    robot.steps(3)
    assert robot.loop.view.base is not None and robot.loop.view.base.mode is Mode.SAFE
    press_spot(robot)
    robot.steps(2)
    assert robot.distance_to_m("post1") < 0.001, "in Passive the button would start a cleaning cycle"
    docked = drive("dock", battery_ratio=0.3)
    docked.steps(5)
    assert docked.loop.view.base is not None and docked.loop.view.base.mode is Mode.PASSIVE
    assert docked.loop.view.base.charging


def press_spot(robot: Drive) -> None:
    robot.robot.body.interface.press_buttons(bytes((0b010,)))
    robot.steps(0.5)


def test_requests_from_many_threads_all_end_once(drive: Make):
    robot = drive("post1:post2")
    jobs: list[int] = []

    def ask() -> None:
        jobs.extend(robot.loop.start(Say(), robot.now) for _ in range(50))

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    robot.steps(0.1)
    assert sorted(end.job for end in robot.loop.finished()) == sorted(jobs) == list(range(1, 201))
