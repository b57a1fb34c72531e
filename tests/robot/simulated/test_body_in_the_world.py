"""Wheels, bumper and line pins: what happens to the body, seen through packets and pins."""

import math

import pytest
from gpiozero import DigitalInputDevice

from robot.simulated import DiodeMount, Motion, Options, Person, Pose, UnknownStart, Wall
from robot.simulated.base.drive_base import MM_PER_COUNT
from robot.simulated.body import Build
from tests.plain_maps import plain_map

STILL = Motion(ripple_mm_s=0.0, wheel_error=0.0)


def wrapped(delta):
    return (delta + 32768) % 65536 - 32768


# Starting --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("start", "pose"),
    [
        ("dock", (2.0, 4.5, math.pi / 2)),
        ("dock:post5", (2.0, 4.5, math.pi / 2)),
        ("post1:post2", (0.0, 4.0, -math.pi / 2)),
        ("post1", (0.0, 3.7, math.pi / 2)),
    ],
)
def test_a_robot_starts_where_it_is_told(make, start, pose):
    found = make(start).robot.pose
    assert (found.x_m, found.y_m, found.heading_rad) == pytest.approx(pose)


@pytest.mark.parametrize("start", ["post9", "post1:post3", "dock:post1", "post1:nowhere", ""])
def test_a_start_that_is_not_on_the_map_is_named(make, start):
    with pytest.raises(UnknownStart, match="cannot start at"):
        make(start)


# Wheels ----------------------------------------------------------------------------------------------------------


def test_one_second_at_200_mm_s_covers_185_to_190_mm(awake):
    awake.drive(200, 200)
    awake.run(1.0 - 0.02)
    assert 185 <= awake.robot.driven_mm <= 190


def test_encoders_count_what_the_wheels_rolled_and_wrap_at_65536(make):
    bench = make(options=Options(build=Build(motion=Motion(0.06, 0.0, 0.0, encoder_start=65000))))
    bench.send(128, 131)
    before = bench.ask(43)
    bench.drive(300, 300)
    bench.run(2)
    bench.drive(0, 0)
    bench.run(1)
    after = bench.ask(43)
    assert after < before, "it wrapped"
    assert wrapped(after - before) * MM_PER_COUNT == pytest.approx(bench.robot.driven_mm, abs=1)


def test_backing_counts_down_and_comes_back_to_where_it_was(awake):
    before = awake.ask(44)
    for speed in (-100, 0, 100, 0):
        awake.drive(speed, speed)
        awake.run(2)
    assert abs(wrapped(awake.ask(44) - before)) <= 1
    assert awake.robot.pose.y_m == pytest.approx(4.0, abs=0.001)


def test_while_a_command_turns_round_the_count_has_already_the_new_sign(awake):
    awake.drive(300, 300)
    awake.run(1)
    awake.drive(-300, -300)
    base = awake.robot.body.base
    counted, south_m = base.left.encoder, base.y_m
    awake.run(0.015)
    assert base.y_m < south_m, "it still rolls on"
    assert wrapped(base.left.encoder - counted) < 0


def test_a_spin_turns_on_the_spot(awake):
    awake.drive(-100, 100)
    awake.run(math.pi / 2 * 117.5 / 100)
    awake.drive(0, 0)
    awake.run(1)
    pose = awake.robot.pose
    assert (pose.x_m, pose.y_m) == pytest.approx((0, 4.0), abs=1e-6)
    assert pose.heading_rad == pytest.approx(0.0, abs=0.05)


def test_wheels_of_another_seed_have_other_errors(make):
    def end(seed) -> Pose:
        bench = make(options=Options(), seed=seed)
        bench.send(128, 131)
        bench.drive(200, 200)
        bench.run(5)
        return bench.robot.pose

    assert end(1) == end(1)
    assert end(1) != end(2)
    assert end(1).y_m == pytest.approx(3.0, abs=0.1)


# Bumper ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("x_m", "bits"), [(0.0, 0b11), (0.15, 0b10), (-0.15, 0b01)])
def test_a_person_in_the_way_presses_the_bumper_on_his_side_and_holds_the_robot(make, x_m, bits):
    """The robot drives south, so east is on its left."""
    bench = make(options=Options(build=Build(motion=STILL), obstacles=(Person(x_m, 3.4, 0.2),)))
    bench.send(128, 131)
    bench.drive(200, 200)
    bench.run(3)
    assert bench.ask(7) == bits
    held_at = bench.robot.pose.y_m
    assert math.dist((0, held_at), (x_m, 3.4)) == pytest.approx(0.2 + 0.17425, abs=0.003)
    counts = bench.ask(43)
    bench.run(1.5)
    assert bench.robot.pose.y_m == held_at
    assert wrapped(bench.ask(43) - counts) > 300, "the wheels slip and count"
    assert (bench.ask(14), bench.ask(58)) == (0b11000, 0)
    assert bench.ask(54) == 1200


def test_a_robot_can_back_off_from_what_it_ran_into(make):
    bench = make(options=Options(build=Build(motion=STILL), obstacles=(Wall(-1, 3.5, 1, 3.5),)))
    bench.send(128, 131)
    bench.drive(200, 200)
    bench.run(3)
    assert bench.ask(7) == 0b11
    bench.drive(-200, -200)
    bench.run(1)
    assert bench.ask(7) == 0
    assert bench.robot.pose.y_m == pytest.approx(3.5 + 0.174 + 0.19, abs=0.01)


def test_a_robot_that_backs_into_somebody_stands_still_and_feels_no_bump(make):
    bench = make(options=Options(build=Build(motion=STILL), obstacles=(Person(0, 4.6, 0.2),)))
    bench.send(128, 131)
    bench.drive(-200, -200)
    bench.run(3)
    assert bench.ask(7) == 0
    assert bench.robot.pose.y_m == pytest.approx(4.6 - 0.374, abs=0.003)


def test_the_light_bumper_sees_somebody_before_the_touch(make):
    bench = make(options=Options(build=Build(motion=STILL), obstacles=(Person(0, 3.57, 0.2),)))
    bench.send(128)
    assert bench.ask(45) & 0b001100
    assert bench.ask(48) > 0
    assert bench.ask(7) == 0


@pytest.mark.parametrize(
    ("beside_m", "bits"), [(0.30, 0), (0.25, 0b000001), (-0.25, 0b100000), (0.20, 0b000011), (-0.20, 0b110000)]
)
def test_a_wall_along_the_way_is_seen_by_the_lights_that_look_to_its_side(make, beside_m, bits):
    """The robot looks south, so east is on its left."""
    bench = make(options=Options(build=Build(motion=STILL), obstacles=(Wall(beside_m, 0, beside_m, 6),)))
    bench.send(128)
    assert bench.ask(45) == bits


@pytest.mark.parametrize(("switch", "bits"), [("lights_blind", 0), ("lights_dazzled", 0b111111)])
def test_light_bumpers_can_be_fooled(make, switch, bits):
    bench = make(options=Options(build=Build(motion=STILL), obstacles=(Person(0, 3.57, 0.2),)))
    bench.robot.set_fault(switch, True)
    bench.send(128)
    assert bench.ask(45) == bits
    assert bool(bench.ask(48)) == bool(bits)


def test_somebody_who_steps_aside_lets_the_robot_go_on(make):
    bench = make(options=Options(build=Build(motion=STILL), obstacles=(Person(0, 3.4),)))
    bench.send(128, 131)
    bench.drive(100, 100)
    bench.run(4)
    bench.robot.world.obstacles.clear()
    bench.run(1)
    assert bench.ask(7) == 0
    assert bench.robot.pose.y_m < 3.7


def test_two_robots_in_one_world_run_into_each_other(make):
    one = make("post1:post2")
    other = make("post2:post1", world=one.robot.world)
    one.send(128, 131)
    one.drive(100, 100)
    for _ in range(200):
        one.run(0.1)
        other.run(0.1)
    other.send(128)
    assert (one.ask(7), other.ask(7)) == (0b11, 0b11), "they meet head-on"
    gap_m = one.robot.pose.y_m - other.robot.pose.y_m
    assert gap_m == pytest.approx(2 * 0.17425, abs=0.003)


# Line pins -------------------------------------------------------------------------------------------------------


def read_pins(robot):
    """Left, centre, right, through real gpiozero devices."""
    devices = [
        DigitalInputDevice(pin, pull_up=None, active_state=True, pin_factory=robot.pin_factory) for pin in (18, 15, 14)
    ]
    values = "".join(str(device.value) for device in devices)
    for device in devices:
        device.close()
    return values


@pytest.mark.parametrize(
    ("left_mm", "pattern"),
    [(0, "101"), (15, "110"), (-15, "011"), (9, "100"), (-9, "001"), (50, "111"), (-50, "111")],
)
def test_the_pins_say_where_the_line_is(make, left_mm, pattern):
    """The robot looks south along the line and stands so far to the left of it."""
    bench = make()
    bench.robot.place(Pose(left_mm / 1000, 3.5, -math.pi / 2))
    assert read_pins(bench.robot) == pattern


def test_all_pins_are_low_where_a_line_crosses(make):
    bench = make()
    bench.robot.place(Pose(2.0 - 0.06, 2.5, 0.0))
    assert read_pins(bench.robot) == "000"


def test_the_diodes_are_mounted_where_the_settings_say(make):
    bench = make(options=Options(build=Build(diodes=DiodeMount(lead_mm=0.0, spacing_mm=10.0))))
    bench.robot.place(Pose(2.0, 2.5, 0.0))
    assert read_pins(bench.robot) == "000"
    bench.robot.place(Pose(0.0, 3.5, -math.pi / 2))
    assert read_pins(bench.robot) == "000", "10 mm beside the middle is still tape"


def test_pins_change_while_the_robot_rolls(make):
    bench = make()
    device = DigitalInputDevice(15, pull_up=None, active_state=True, pin_factory=bench.robot.pin_factory)
    bench.robot.place(Pose(-0.3, 3.5, 0.0))
    bench.send(128, 131)
    bench.drive(200, 200)
    seen = []
    for _ in range(400):
        bench.run(0.005)
        seen.append(device.value)
    device.close()
    assert 20 <= seen.count(0) <= 28, "24 mm of tape at 200 mm/s are 24 steps"


def test_a_gap_in_the_tape_looks_like_no_line(make):
    worn = make(options=Options(build=Build(motion=STILL), gap_m=0.02))
    whole = make()
    lost = [0, 0]
    for step in range(1900):
        for index, bench in enumerate((worn, whole)):
            pose = Pose(0.0, 3.95 - step / 1000, -math.pi / 2)
            lost[index] += bench.robot.body.pins.readings(pose.x_m, pose.y_m, pose.heading_rad)[1]
    assert lost[1] == 0
    assert 15 <= lost[0] <= 70


def test_one_robots_pins_are_not_anothers(make):
    one, other = make(), make()
    one.robot.place(Pose(0.0, 3.5, -math.pi / 2))
    other.robot.place(Pose(1.0, 3.5, -math.pi / 2))
    assert (read_pins(one.robot), read_pins(other.robot)) == ("101", "111")


# Sameness --------------------------------------------------------------------------------------------------------


def test_the_same_seed_and_inputs_give_the_same_bytes_frames_and_way(make):
    def life(seed) -> tuple[bytes, list[int], Pose]:
        bench = make(options=Options(), seed=seed)
        bench.robot.set_fault("floor_flip", 0.01)
        bench.robot.set_fault("flip_byte", 0.001)
        bench.send(128, 131, 148, 4, 7, 43, 44, 25)
        heard, frames = b"", []
        for turn in range(60):
            bench.drive(150 + turn, 150 - turn)
            bench.run(0.1)
            heard += bench.heard()
            frames.append(bench.robot.camera.read()[1].sum())
        return heard, frames, bench.robot.pose

    assert life(5) == life(5)
    assert life(5)[0] != life(6)[0]


def test_steps_do_not_depend_on_how_often_the_world_is_asked(make):
    def end(pause_s) -> Pose:
        bench = make(options=Options(), seed=4)
        bench.send(128, 131)
        bench.drive(200, 180)
        while bench.robot.now < 3 - 1e-9:
            bench.robot.step_until(min(bench.robot.now + pause_s, 3.0))
        return bench.robot.pose

    assert end(0.005) == end(0.1) == end(1.0)


def test_the_tunnels_have_their_floor_and_docks_too(make):
    campus = plain_map("carleton")
    for post in campus.docks():
        bench = make(f"dock:{post.name}", campus="carleton")
        bench.run(2)
        assert bench.robot.docked
    bench = make("loeb:southam", campus="carleton")
    assert read_pins(bench.robot) == "101"
