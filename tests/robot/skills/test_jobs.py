"""Jobs: every one ends once; one motion at a time; handovers, pulses, songs."""

import math
import threading
from collections.abc import Callable
from hashlib import sha256
from itertools import pairwise

import pytest

from protocol.proofs import ShownCode
from robot.core.errors import UnknownSkill
from robot.drivers.interfaces import STOP, Mode, WheelSpeeds
from robot.simulated import Pose
from robot.skills import Dock, Done, DrivePulse, Failed, FollowLine, PaperTurn, Running, Say, View, WaitHandover
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
    job = robot.loop.start(WaitHandover(lambda: {VERIFIER}, 60.0), robot.now)
    robot.steps(2)
    robot.robot.show_code(CODE)
    outcome = robot.end_of(job, 2.0)
    assert isinstance(outcome, Done) and outcome.shown == ShownCode.of(CODE)


def test_a_wrong_code_is_refused_with_a_sound_once_and_waited_on(drive: Make):
    robot = drive("post1:post2")
    robot.do(DrivePulse("stop"))
    waiting = WaitHandover(lambda: {VERIFIER}, 60.0)
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
    job = robot.loop.start(WaitHandover(lambda: {VERIFIER}, 3.0), robot.now)
    assert robot.end_of(job, 4.0) == Failed("no_one_came")


def test_a_code_that_opens_only_later_and_one_that_no_longer_does(drive: Make):
    robot = drive("post1:post2")
    codes = {VERIFIER}
    job = robot.loop.start(WaitHandover(lambda: codes, 60.0), robot.now)
    codes.clear()
    robot.robot.show_code(CODE)
    robot.steps(2)
    assert robot.loop.finished() == (), "taken back"
    codes.add(VERIFIER)
    assert robot.end_of(job, 2.0).__class__ is Done, "given while the robot waits"


class Broken(DrivePulse):
    """Drives for a moment, then meets a mistake of its author."""

    def __init__(self, at_once: bool = False) -> None:
        super().__init__("forward")
        self.at_once, self.steps = at_once, 0

    def start(self, view: View, now: float) -> None:
        if self.at_once:
            raise ZeroDivisionError

    def step(self, view: View, now: float) -> Running:
        self.steps += 1
        if self.steps > 50:
            raise ZeroDivisionError
        return Running(WheelSpeeds(100, 100))


@pytest.mark.parametrize("at_once", [True, False])
def test_a_mistake_in_a_skill_ends_that_skill_and_the_wheels_stand(drive: Make, at_once: bool):
    robot = drive("post1:post2")
    assert robot.do(Broken(at_once), 2) == Failed("broken")
    robot.steps(1)
    assert robot.robot.state()["wheels_mm_s"] == [0, 0]
    assert robot.do(DrivePulse("forward"), 1).__class__ is Done, "the loop goes on"


def test_a_docking_that_is_cancelled_stands_at_once(drive: Make):
    robot = drive("post5:post3")
    robot.robot.place(Pose(2.0, 3.8, math.pi / 2))
    job = robot.loop.start(Dock(), robot.now)
    robot.until(lambda: robot.robot.state()["wheels_mm_s"] != [0, 0], 5)
    robot.loop.cancel(job)
    robot.steps(0.5)
    assert robot.robot.state()["wheels_mm_s"] == [0, 0]


def test_clean_pressed_in_the_dock_starts_no_cleaning_round(drive: Make):
    robot = drive("dock", battery_ratio=0.5)
    robot.steps(5)
    robot.robot.body.interface.press_buttons(bytes((0b001,)))
    robot.steps(5)
    assert robot.loop.view.faults == {"emergency_stop"}
    assert robot.robot.state()["wheels_mm_s"] == [0, 0]
    assert robot.loop.view.base is not None and robot.loop.view.base.charging, "stopped, and charging all the same"


def test_spot_pressed_twice_loads_without_a_name(drive: Make):
    robot = drive("post1:post2")
    robot.steps(3)
    job = robot.loop.start(WaitHandover(lambda: {VERIFIER}, 60.0), robot.now)
    robot.tick()
    press_spot(robot)
    assert not robot.loop.finished(), "once may be an accident"
    press_spot(robot)
    outcome = robot.end_of(job, 1.0)
    assert isinstance(outcome, Done) and outcome.shown is None


def test_spot_does_not_open_where_it_must_not(drive: Make):
    robot = drive("post1:post2")
    robot.steps(3)
    waiting = WaitHandover(lambda: {VERIFIER}, 5.0, lambda: False)
    job = robot.loop.start(waiting, robot.now)
    robot.tick()
    press_spot(robot)
    press_spot(robot)
    assert waiting.refused == 1, "and says so"
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
