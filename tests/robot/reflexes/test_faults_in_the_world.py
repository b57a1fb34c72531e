"""Fault by fault, from its cause in the simulated world over the real driver to wheels that stand, and back."""

import math
from collections.abc import Callable

import pytest

from robot.drivers.interfaces import WheelSpeeds
from robot.reflexes import FAULTS, LATCHED
from robot.simulated import Person
from robot.skills.interfaces import Failed
from tests.robot.reflexes.moving import Moving, Rolls

ROWS = {fault.name: fault for fault in FAULTS}
STANDS_FOR_S = 0.6
Change = Callable[[Moving], object]


def switch(name: str, on: object = True, off: object = False) -> tuple[Change, Change]:
    return lambda robot: robot.robot.set_fault(name, on), lambda robot: robot.robot.set_fault(name, off)


def _dies(robot: Moving) -> None:
    robot.mind_lives = False


def _lives(robot: Moving) -> None:
    robot.mind_lives = True


def _offline(robot: Moving) -> None:
    robot.online = False


def _online(robot: Moving) -> None:
    robot.online = True


def _nothing(_: Moving) -> None: ...


CAUSES: dict[str, tuple[Change, Change]] = {
    "emergency_stop": (lambda robot: robot.robot.press("clean"), _nothing),
    "wheel_drop": (lambda robot: robot.robot.lift(True), lambda robot: robot.robot.lift(False)),
    "cliff": (lambda robot: robot.robot.cliff(True), lambda robot: robot.robot.cliff(False)),
    # Its words are lost, it hears ours: one that hears nothing goes on as told last (docs/explanation/safety.md).
    "base_silent": switch("drop_byte", 1.0, 0.0),
    "agent_silent": (_dies, _lives),
    "over_current": switch("over_current"),
    "stall": switch("wheels_jammed"),
    "stasis": switch("slipping"),
    "bump": switch("bump_left"),
    "virtual_wall": switch("virtual_wall"),
    "camera_stale": switch("camera_dead"),
    "camera_frozen": switch("camera_frozen"),
    "camera_lost": switch("camera_dead"),
    "line_sensor": switch("pins_stuck"),
    "battery_critical": (lambda robot: robot.robot.sag(0.08), lambda robot: robot.robot.sag(0.9)),
    "under_voltage": switch("under_voltage"),
    "clock_jump": switch("clock_jump"),
    "disk_low": switch("disk_full"),
    "link_loss": (_offline, _online),
}
STOPPING = sorted(name for name, row in ROWS.items() if row.stands_within_s is not None)
TELLING = sorted(set(ROWS) - set(STOPPING))
SELF_CLEARING = sorted(set(STOPPING) - LATCHED)


def test_every_fault_of_the_table_happens_here() -> None:
    assert set(CAUSES) == set(ROWS)


@pytest.mark.parametrize("name", STOPPING)
@pytest.mark.slow
def test_from_the_cause_to_wheels_that_stand_it_takes_no_longer_than_the_table_says(moving: Moving, name: str) -> None:
    row, (happens, _) = ROWS[name], CAUSES[name]
    moving.sets_off()
    if name == "line_sensor":
        moving.until(lambda: any(moving.loop.view.reading))
    happens(moving)
    assert row.stands_within_s is not None
    moving.steps(row.stands_within_s)
    for _ in range(round(STANDS_FOR_S / 0.02)):
        assert moving.wheels_stand, f"{moving.robot.state()['wheels_mm_s']} with {moving.faults}"
        moving.tick()
    assert name in moving.faults, "the agent perceives it by name"


@pytest.mark.parametrize("name", TELLING)
@pytest.mark.slow
def test_what_is_only_told_leaves_the_robot_driving(moving: Moving, name: str) -> None:
    happens, is_over = CAUSES[name]
    moving.sets_off()
    happens(moving)
    moving.steps(11.0)
    assert moving.faults == {name}
    assert not moving.wheels_stand
    is_over(moving)
    moving.steps(61.5 if name == "clock_jump" else (ROWS[name].clears_s or 0.0) + 1.0)
    assert moving.faults == frozenset()


@pytest.mark.parametrize("name", SELF_CLEARING)
@pytest.mark.slow
def test_when_the_cause_is_gone_it_drives_on_as_soon_as_the_table_says(moving: Moving, name: str) -> None:
    row, (happens, is_over) = ROWS[name], CAUSES[name]
    moving.sets_off()
    happens(moving)
    moving.until(lambda: name in moving.faults, 62.0)
    moving.steps(0.4)
    is_over(moving)
    if name == "line_sensor":
        moving.robot.push(200.0)  # a technician looks after it, and a diode sees something else
        moving.robot.set_fault("floor_flip", 0.3)
        moving.steps(0.2)
        moving.robot.set_fault("floor_flip", 0.0)
    if row.clears_s and row.clears_s >= 1.0 and name not in ("stall", "stasis"):
        moving.steps(row.clears_s - 0.6)
        assert name in moving.faults
    moving.until(lambda: name not in moving.faults, (row.clears_s or 0.0) + 2.0)
    moving.until(lambda: not moving.wheels_stand, 2.0)


@pytest.mark.parametrize("name", sorted(LATCHED))
def test_a_latched_stop_ends_when_somebody_rearms_the_robot_and_not_before(moving: Moving, name: str) -> None:
    happens, is_over = CAUSES[name]
    moving.sets_off()
    happens(moving)
    moving.steps(0.1)
    moving.loop.rearm()
    moving.steps(0.5)
    is_over(moving)
    moving.steps(5.0)
    assert moving.wheels_stand, "with a hand on the button or a wheel in the air no person re-arms it"
    moving.robot.press("spot")
    moving.until(lambda: not moving.faults, 1.0)
    moving.until(lambda: not moving.wheels_stand, 2.0)


def test_a_wheel_that_turns_as_slowly_as_it_may_is_no_stall(moving: Moving) -> None:
    moving.sets_off(WheelSpeeds(30, 30))
    for _ in range(500):
        moving.tick()
        assert moving.faults == frozenset()


def test_people_who_push_a_resting_robot_through_a_hall_cause_no_fault(moving: Moving) -> None:
    moving.steps(1.0)
    for _ in range(100):
        moving.robot.push(200.0)
        moving.steps(0.1)
        assert moving.faults == frozenset()


def test_a_motion_that_a_virtual_wall_refuses_ends_by_that_name_and_turning_away_is_free(moving: Moving) -> None:
    job = moving.sets_off()
    moving.robot.set_fault("virtual_wall", True)
    assert moving.end_of(job, 5.0) == Failed("virtual_wall")
    moving.loop.start(Rolls(WheelSpeeds(-80, 80)), moving.now)
    moving.until(lambda: not moving.wheels_stand, 1.0)


def test_somebody_in_the_way_is_touched_left_alone_and_met_again_until_they_are_gone(moving: Moving) -> None:
    pose = moving.robot.pose
    person = Person(pose.x_m + 0.7 * math.cos(pose.heading_rad), pose.y_m + 0.7 * math.sin(pose.heading_rad))
    moving.robot.world.obstacles.append(person)
    moving.sets_off()
    moving.until(lambda: moving.loop.view.bumps == 1, 5.0)
    touched = moving.distance_m(person)
    moving.steps(1.8)
    assert moving.distance_m(person) > touched + 0.05, "it has gone back"
    moving.until(lambda: moving.loop.view.bumps == 2, 8.0)
    moving.robot.world.obstacles.remove(person)
    moving.until(lambda: not moving.faults, 6.0)
    moving.steps(2.0)
    assert not moving.wheels_stand
