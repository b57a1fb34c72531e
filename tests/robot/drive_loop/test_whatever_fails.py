"""A drive loop that is late, fed with nonsense or broken from below: the wheels do not lurch, and stop if need be."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from robot.drive_loop import DriveLoop
from robot.drivers.interfaces import CameraReport, WheelSpeeds
from robot.skills.interfaces import Done, Failed, Running, Step, View
from tests.robot.reflexes.moving import CRUISE, Moving, Rolls


class Asks(Rolls):
    """Does what a test gives it: at its start, and at each step."""

    def __init__(self, does: Callable[[View], Step], begins: Callable[[View], object] = lambda _: None) -> None:
        super().__init__()
        self.does, self.begins = does, begins

    def start(self, view: View, now: float) -> None:
        self.begins(view)

    def step(self, view: View, now: float) -> Step:
        return self.does(view)


def _breaks(_: View) -> Step:
    raise ZeroDivisionError


@pytest.mark.parametrize("when", ["start", "step"])
def test_a_skill_that_breaks_ends_as_broken_and_the_wheels_stand(moving: Moving, when: str) -> None:
    moving.loop.cancel(moving.sets_off())
    skill = Asks(_breaks) if when == "step" else Asks(lambda _: Running(CRUISE), begins=_breaks)
    assert moving.do(skill) == Failed("broken")
    moving.steps(0.5)
    assert moving.wheels_stand


def test_speeds_that_are_no_numbers_end_the_skill_and_never_reach_the_base(moving: Moving) -> None:
    assert moving.do(Asks(lambda _: Running(WheelSpeeds(math.nan, 100.0)))) == Failed("broken")
    assert moving.do(Asks(lambda _: Running(WheelSpeeds(100.0, math.inf)))) == Failed("broken")
    moving.steps(0.5)
    assert moving.wheels_stand


def test_a_report_that_cannot_be_used_ends_the_loop_and_its_last_word_stops_the_wheels(moving: Moving) -> None:
    moving.sets_off()
    nonsense: Any = "no report"
    moving.loop.report(nonsense, moving.now)
    with pytest.raises(AttributeError):
        moving.tick()
    moving.base.close()
    moving.robot.step_until(moving.now + 0.6)
    assert moving.wheels_stand


def test_a_tick_that_comes_a_little_late_is_noted_and_the_robot_drives_on(moving: Moving) -> None:
    moving.sets_off()
    late = moving.loop.late_ticks
    _nothing_happens_for(moving, 0.1)
    moving.tick()
    assert moving.loop.late_ticks == late + 1
    assert moving.loop.worst_gap_s == pytest.approx(0.12)
    assert moving.loop.view.sent == pytest.approx(CRUISE, abs=3)


def test_after_a_long_gap_it_stands_first_and_no_skill_decides_by_a_leap(moving: Moving) -> None:
    seen: list[float] = []

    def looks(view: View) -> Step:
        seen.append(view.at_s)
        return Running(CRUISE)

    moving.loop.start(Asks(looks), moving.now)
    moving.steps(1.0)
    _nothing_happens_for(moving, 0.7)
    steps = len(seen)
    moving.tick()
    moving.tick()
    assert moving.loop.view.sent.still
    assert len(seen) == steps
    moving.steps(0.6)
    assert moving.loop.view.sent == pytest.approx(CRUISE, abs=3)


def _nothing_happens_for(moving: Moving, gap_s: float) -> None:
    """The computer does something else; the world goes on."""
    moving.now += gap_s
    moving.robot.step_until(moving.now)
    moving.loop.heartbeat(moving.now)
    moving.loop.report(CameraReport(), moving.now)


class Brittle:
    """A device that works until a test says otherwise: then this method of it raises."""

    def __init__(self, device: Any, method: str, error: Exception) -> None:
        self.device, self.method, self.error = device, method, error
        self.broken = False

    def __getattr__(self, name: str) -> Any:
        if self.broken and name == self.method:
            raise self.error
        return getattr(self.device, name)


def test_a_driver_that_breaks_ends_the_loop_and_its_last_word_stops_the_wheels(moving: Moving) -> None:
    base = Brittle(moving.base, "poll", RuntimeError("an unexpected byte"))
    moving.loop = DriveLoop(base, moving.sensor, moving.shape, moving.now)
    moving.sets_off()
    base.broken = True
    with pytest.raises(RuntimeError, match="an unexpected byte"):
        moving.tick()
    moving.base.close()  # as the thread of the loop does, whatever ended it
    moving.robot.step_until(moving.now + 0.6)
    assert moving.wheels_stand
    assert moving.robot.state()["mode"] == "passive"


def test_pins_that_cannot_be_read_are_a_fault_and_no_end(moving: Moving) -> None:
    sensor = Brittle(moving.sensor, "sample", OSError("lgpio: the chip is gone"))
    moving.loop = DriveLoop(moving.base, sensor, moving.shape, moving.now)
    moving.sets_off()
    sensor.broken = True
    moving.steps(0.6)
    assert moving.faults == {"line_sensor"}
    assert moving.wheels_stand
    sensor.broken = False
    moving.steps(0.6)
    assert moving.faults == frozenset()


def test_a_job_ends_once_even_if_it_is_cancelled_twice(moving: Moving) -> None:
    job = moving.sets_off()
    moving.loop.cancel(job)
    moving.loop.cancel(job)
    moving.steps(0.1)
    assert [end.outcome for end in moving.loop.finished()] == [Failed("cancelled")]
    assert moving.do(Asks(lambda _: Done())) == Done()
