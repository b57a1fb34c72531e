"""Every way to stop a robot by hand ends in the same latched stop, and it stays one through a restart."""

import math
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from robot.drive_loop import DriveLoop
from robot.drivers.interfaces import Mode
from robot.mission.latched_stop import LatchedStop
from robot.simulated import Pose
from robot.skills.dock import Dock
from robot.skills.interfaces import Failed
from tests.robot.reflexes.moving import Moving

DOORS: dict[str, Callable[[Moving], object]] = {
    "the Clean button": lambda robot: robot.robot.press("clean"),
    "lifting": lambda robot: robot.robot.lift(True),
    "a call from any thread": lambda robot: _from_a_thread(robot.loop),
}


def _from_a_thread(loop: DriveLoop) -> None:
    thread = threading.Thread(target=loop.emergency_stop)
    thread.start()
    thread.join()


@pytest.mark.parametrize("door", DOORS)
def test_it_stops_the_wheels_in_half_a_second_whether_or_not_the_mind_lives(moving: Moving, door: str) -> None:
    moving.sets_off()
    moving.mind_lives = False
    DOORS[door](moving)
    moving.steps(0.5)
    assert moving.wheels_stand
    moving.mind_lives = True
    moving.steps(3.0)
    assert moving.wheels_stand
    assert moving.faults & {"emergency_stop", "wheel_drop"}


@pytest.mark.parametrize("door", DOORS)
def test_the_spot_button_lets_it_go_again_whoever_stopped_it_and_whether_or_not_the_mind_lives(
    moving: Moving, door: str
) -> None:
    moving.sets_off()
    moving.mind_lives = False
    DOORS[door](moving)
    moving.steps(2.0)
    moving.robot.lift(False)
    moving.robot.press("spot")
    moving.steps(0.5)
    assert moving.faults == {"agent_silent"}
    moving.mind_lives = True
    moving.until(lambda: not moving.wheels_stand, 1.0)


def test_a_stop_that_comes_while_somebody_still_presses_spot_holds(moving: Moving) -> None:
    moving.sets_off()
    moving.robot.press("spot")
    moving.steps(0.1)
    moving.loop.emergency_stop()
    moving.steps(1.0)
    assert moving.faults == {"emergency_stop"}


@pytest.mark.parametrize("order", [("emergency_stop", "rearm"), ("rearm", "emergency_stop")])
def test_a_stop_wins_over_a_rearming_by_somebody_who_cannot_have_seen_it(
    moving: Moving, order: tuple[str, str]
) -> None:
    moving.sets_off()
    for call in order:
        getattr(moving.loop, call)()
    moving.steps(0.5)
    assert moving.faults == {"emergency_stop"}


@pytest.mark.slow
def test_clean_pressed_in_the_dock_starts_no_cleaning_and_a_dead_mind_ends_no_charge() -> None:
    robot = Moving("dock", battery_ratio=0.5)
    try:
        robot.mind_lives = False
        robot.steps(20.0)
        assert robot.robot.state()["battery"]["charging"]
        robot.robot.press("clean")
        robot.steps(5.0)
        assert robot.faults == {"agent_silent", "emergency_stop"}
        assert robot.robot.docked
        assert robot.wheels_stand
    finally:
        robot.close()


@pytest.mark.parametrize("door", DOORS)
@pytest.mark.slow
def test_it_takes_the_wheels_from_a_firmware_that_docks(door: str) -> None:
    robot = Moving("dock", battery_ratio=0.6)
    try:
        pose = robot.robot.pose
        robot.robot.place(Pose(*_away_from_the_dock(pose, 0.8)))
        robot.steps(3.0)
        job = robot.loop.start(Dock(), robot.now)
        robot.until(lambda: not robot.wheels_stand, 10.0)
        assert robot.loop.view.base is not None
        assert robot.loop.view.base.mode is Mode.PASSIVE
        DOORS[door](robot)
        robot.steps(0.6)
        assert robot.wheels_stand
        assert isinstance(robot.end_of(job, 1.0), Failed)
        robot.steps(3.0)
        assert robot.wheels_stand
    finally:
        robot.close()


def _away_from_the_dock(pose: Pose, by_m: float) -> tuple[float, float, float]:
    return pose.x_m - by_m * math.cos(pose.heading_rad), pose.y_m - by_m * math.sin(pose.heading_rad), pose.heading_rad


def test_a_stop_outlives_the_program_even_if_no_mind_has_heard_of_it(moving: Moving, tmp_path: Path) -> None:
    moving.sets_off()
    moving.loop.emergency_stop()
    moving.steps(0.1)
    LatchedStop(tmp_path / "stops.json").keep(moving.faults)
    moving.loop = DriveLoop(
        moving.base, moving.sensor, moving.shape, moving.now, LatchedStop(tmp_path / "stops.json").read()
    )
    moving.steps(0.2)
    assert moving.faults == {"emergency_stop"}
    moving.loop.rearm()
    moving.steps(0.1)
    assert moving.faults == frozenset()


def test_what_is_not_latched_is_not_kept_and_what_is_over_is_forgotten(tmp_path: Path) -> None:
    memory = LatchedStop(tmp_path / "stops.json")
    memory.keep({"bump", "cliff"})
    assert LatchedStop(tmp_path / "stops.json").read() == {"cliff"}
    memory.keep(frozenset())
    assert LatchedStop(tmp_path / "stops.json").read() == frozenset()


@pytest.mark.parametrize("text", ["", "7", "{", '"cliff', '"cliff"', "{}"])
def test_a_memory_of_stops_that_nobody_understands_is_a_stop(tmp_path: Path, text: str) -> None:
    (tmp_path / "stops.json").write_text(text)
    assert LatchedStop(tmp_path / "stops.json").read() == {"emergency_stop"}


def test_a_disk_that_cannot_be_written_ends_nothing(tmp_path: Path) -> None:
    memory = LatchedStop(tmp_path / "gone" / "stops.json")
    memory.keep({"cliff"})
    (tmp_path / "gone").mkdir()
    memory.keep({"cliff"})
    assert memory.read() == {"cliff"}, "it is tried again"
