"""Robots in one world: they run into each other, feel each other coming, hide what is behind them."""

import math

import pytest

from robot.drivers.camera.marker_reader import MarkerReader
from robot.simulated import Collision, CollisionJudge, Pose
from tests.plain_maps import plain_map
from tests.robot.simulated.conftest import Bench, Make

NEVER_DEEPER_MM = 0.5
STEP_S = 0.005
READER = MarkerReader(plain_map("test_track").posts)


def judged(benches: list[Bench], seconds: float, judge: CollisionJudge | None = None) -> list[Collision]:
    """All of them step by step, looked at after every step."""
    judge = judge or CollisionJudge()
    for _ in range(round(seconds / STEP_S)):
        for bench in benches:
            bench.run(STEP_S)
        judge.look({str(number): bench.robot.body.true_pose for number, bench in enumerate(benches)})
    return judge.found


def two(make: Make, one: Pose, other: Pose) -> tuple[Bench, Bench]:
    """In Safe mode, where they are put."""
    first = make("post1:post2")
    second = make("post2:post1", world=first.robot.world)
    for bench, pose in ((first, one), (second, other)):
        bench.robot.body.place(pose.x_m, pose.y_m, pose.heading_rad)
        bench.send(128, 131)
    return first, second


FACING = Pose(0.0, 3.0, math.pi / 2), Pose(0.0, 4.0, -math.pi / 2)


@pytest.mark.parametrize("speed_mm_s", [50, 200, 500])
def test_two_that_drive_at_each_other_stop_with_their_bumpers_pressed_and_never_overlap(
    make: Make, speed_mm_s: int
) -> None:
    one, other = two(make, *FACING)
    for bench in (one, other):
        bench.drive(speed_mm_s, speed_mm_s)
    (met,) = judged([one, other], 8.0)
    assert -2.0 < met.depth_mm < NEVER_DEEPER_MM
    assert met.x_m == pytest.approx(0.0, abs=0.02)
    assert met.y_m == pytest.approx(3.5, abs=0.05)
    assert (one.ask(7), other.ask(7)) == (0b11, 0b11)
    assert one.ask(14) == other.ask(14) == 0b11000, "both motors of both are blocked"


def test_one_that_is_run_into_from_behind_feels_nothing_and_is_not_pushed(make: Make) -> None:
    one, other = two(make, Pose(0.0, 3.0, math.pi / 2), Pose(0.0, 3.6, math.pi / 2))
    one.drive(200, 200)
    stood = other.robot.pose
    judged([one, other], 4.0)
    assert (one.ask(7), other.ask(7)) == (0b11, 0)
    assert other.robot.pose == stood


@pytest.mark.parametrize(("left_m", "pressed"), [(0.12, 0b10), (-0.12, 0b01)])
def test_one_that_stands_on_the_left_presses_the_left_side_of_the_bumper(
    make: Make, left_m: float, pressed: int
) -> None:
    one, other = two(make, Pose(0.0, 3.0, math.pi / 2), Pose(-left_m, 3.6, 0.0))
    one.drive(200, 200)
    judged([one, other], 3.0)
    assert one.ask(7) == pressed


def test_nobody_pushes_through_another_however_long_he_tries_and_each_can_back_off(make: Make) -> None:
    one, other = two(make, *FACING)
    one.drive(300, 300)
    (met,) = judged([one, other], 30.0)
    assert met.depth_mm < NEVER_DEEPER_MM
    one.drive(-100, -100)
    judged([one, other], 2.0)
    assert one.ask(7) == 0
    assert one.robot.pose.y_m < 3.6


def test_the_light_bumper_sees_the_other_before_the_touch(make: Make) -> None:
    one, other = two(make, *FACING)
    one.drive(100, 100)
    seen = []
    while not one.ask(7):
        judged([one, other], 0.1)
        seen.append(one.ask(45))
    assert seen[0] == 0, "65 cm away it sees nothing"
    assert 0b001100 in seen or 0b011110 in seen, f"ahead of it: {seen}"


def read(bench: Bench) -> list[str]:
    frame = bench.robot.camera.read()[1]
    assert frame is not None
    return [sighting.text for sighting in READER.look(frame, 0.0)]


def test_a_robot_between_camera_and_marker_hides_it(make: Make) -> None:
    """The marker stands 350 mm beside the line; seen from 800 mm there is room for a robot."""
    away = Pose(0.45, 3.7, math.pi / 2)
    one, other = two(make, away, Pose(0.0, 5.0, 0.0))
    assert read(one) == ["post1"]
    other.robot.place(Pose(0.0, 3.7, 0.0))
    assert read(one) == []


def test_a_robot_beside_the_sight_or_behind_the_marker_hides_nothing(make: Make) -> None:
    one, other = two(make, Pose(0.45, 3.7, math.pi / 2), Pose(0.0, 4.2, 0.0))
    assert read(one) == ["post1"]
    other.robot.place(Pose(-0.7, 3.7, 0.0))
    assert read(one) == ["post1"]


def test_the_base_alone_is_lower_than_a_marker(make: Make) -> None:
    """Where only the rim of the base, and not the box on it, is between lens and marker."""
    one, _ = two(make, Pose(0.45, 3.7, math.pi / 2), Pose(0.0, 3.86, 0.0))
    assert read(one) == ["post1"]


def test_a_robot_far_off_costs_no_contact_and_one_that_comes_is_met(make: Make) -> None:
    one, other = two(make, Pose(0.0, 3.0, math.pi / 2), Pose(0.0, 20.0, 0.0))
    assert one.robot.world.contacts(one.robot.body, 0.0, 3.0, 0.0) == []
    other.robot.place(Pose(0.0, 3.6, 0.0))
    assert len(one.robot.world.contacts(one.robot.body, 0.0, 3.0, 0.0)) == 1
