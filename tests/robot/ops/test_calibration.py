"""Calibrating a simulated robot whose wheels, pins and camera are not what the settings say."""

import math
from collections.abc import Iterator

import pytest

from maps import find_map
from robot.core.config import LineSettings
from robot.core.line_pins import open_pins
from robot.drivers.create2.create2 import Create2
from robot.ops.calibration.line import judged, swing
from robot.ops.calibration.optics import field_of_view_deg
from robot.ops.calibration.rig import CalibrationFailed, Rig
from robot.ops.calibration.wheels import mm_per_count, roll, spin, wheel_base_mm
from robot.simulated import Build, CameraMount, Motion, Options, Pose, SimulatedRobot

NOMINAL_MM = 0.44456


class Bench:
    """A simulated robot in stepped time on the straight line between post3 and post2, its wheels as wrong as asked."""

    def __init__(self, wheels: tuple[float, float] = (1.0, 1.0), camera: CameraMount | None = None) -> None:
        options = Options(build=Build(motion=Motion(wheel_error=0.0)), camera=camera or CameraMount())
        self.robot = SimulatedRobot(find_map("test_track"), 0.0, "post3:post2", in_memory=True, options=options)
        self.carry(ahead_m=0.3)
        self.robot.body.base.left.scale, self.robot.body.base.right.scale = wheels
        self.now = 0.0
        self.base = Create2(self.robot.memory_port, self.robot.brc)
        self.rig = Rig(self.base, self.let_pass)

    def carry(self, ahead_m: float = 0.0, left_m: float = 0.0) -> None:
        pose = self.robot.pose
        along, across = math.cos(pose.heading_rad), math.sin(pose.heading_rad)
        x_m, y_m = pose.x_m + ahead_m * along - left_m * across, pose.y_m + ahead_m * across + left_m * along
        self.robot.place(Pose(x_m, y_m, pose.heading_rad))

    def let_pass(self, seconds: float) -> float:
        self.now += seconds
        self.robot.step_until(self.now)
        return self.now

    def close(self) -> None:
        self.base.close()
        self.robot.close()


@pytest.fixture
def bench() -> Iterator[Bench]:
    bench = Bench()
    yield bench
    bench.close()


@pytest.mark.parametrize("wheels", [(1.03, 1.03), (0.95, 0.95), (1.01, 1.03), (0.97, 0.98)])
def test_a_metre_that_is_measured_gives_the_way_per_count_within_half_a_percent(wheels: tuple[float, float]) -> None:
    bench = Bench(wheels)
    before = bench.robot.pose
    counts = roll(bench.rig, 1000.0, NOMINAL_MM)
    after = bench.robot.pose
    measured_mm = 1000 * math.dist((before.x_m, before.y_m), (after.x_m, after.y_m))
    found = mm_per_count(measured_mm, counts)
    assert found == pytest.approx(NOMINAL_MM * sum(wheels) / 2, rel=0.005)
    assert bench.robot.state()["wheels_mm_s"] == [0, 0]
    bench.close()


@pytest.mark.parametrize("wheels", [(1.0, 1.0), (1.03, 1.03), (1.03, 1.01), (0.96, 0.97)])
@pytest.mark.nightly
def test_turns_over_the_line_give_the_wheel_base_within_half_a_percent(wheels: tuple[float, float]) -> None:
    bench = Bench(wheels)
    devices = open_pins(LineSettings(), bench.robot.pin_factory)
    counts = spin(bench.rig, lambda: devices[1].value, 3)
    assert wheel_base_mm(counts, 3, NOMINAL_MM * sum(wheels) / 2) == pytest.approx(235.0, rel=0.005)
    bench.close()


def test_a_swing_over_the_line_tells_which_level_is_tape(bench: Bench) -> None:
    devices = open_pins(LineSettings(), bench.robot.pin_factory)
    found = swing(bench.rig, lambda: [device.value for device in devices])
    assert (found.line_is_low, found.swapped) == (True, False)


def test_pins_of_left_and_right_that_are_exchanged_are_found(bench: Bench) -> None:
    exchanged = LineSettings(left_pin="BOARD8", right_pin="BOARD12")
    devices = open_pins(exchanged, bench.robot.pin_factory)
    assert swing(bench.rig, lambda: [device.value for device in devices]).swapped


def test_a_diode_that_sees_nothing_and_one_that_is_wired_the_other_way_are_named(bench: Bench) -> None:
    devices = open_pins(LineSettings(left_pin="GPIO5"), bench.robot.pin_factory)
    with pytest.raises(CalibrationFailed, match="left diode did not change"):
        swing(bench.rig, lambda: [device.value for device in devices])
    swung = [
        (counts, (counts not in range(4), counts not in range(4, 8), counts in range(8, 12))) for counts in range(40)
    ]
    with pytest.raises(CalibrationFailed, match="right high"):
        judged([(counts, [int(level) for level in levels]) for counts, levels in swung])


def test_beside_the_line_no_turn_is_believed(bench: Bench) -> None:
    bench.carry(left_m=0.3)
    devices = open_pins(LineSettings(), bench.robot.pin_factory)
    with pytest.raises(CalibrationFailed, match="axle"):
        spin(bench.rig, lambda: devices[1].value, 1)


def test_a_foot_in_the_way_stops_the_wheels_and_the_measurement(bench: Bench) -> None:
    bench.robot.set_fault("bump_left", True)
    with pytest.raises(CalibrationFailed, match="touched"):
        roll(bench.rig, 1000.0, NOMINAL_MM)
    assert bench.robot.state()["wheels_mm_s"] == [0, 0]


def test_a_base_that_is_silent_is_told(bench: Bench) -> None:
    bench.robot.set_fault("frozen", True)
    with pytest.raises(CalibrationFailed, match="says nothing"):
        roll(bench.rig, 1000.0, NOMINAL_MM)


@pytest.mark.parametrize("across_deg", [48.0, 60.0, 72.0])
def test_one_marker_at_a_known_distance_gives_the_field_of_view_within_half_a_percent(across_deg: float) -> None:
    mount = CameraMount(across_rad=math.radians(across_deg))
    options = Options(camera=mount)
    campus = find_map("test_track")
    robot = SimulatedRobot(campus, 0.0, "post1", in_memory=True, options=options)
    robot.step_until(0.1)
    frames = [frame for _, frame in (robot.camera.read() for _ in range(5)) if frame is not None]
    found = field_of_view_deg(frames, lens_to_marker_mm(robot))
    assert found == pytest.approx(across_deg, rel=0.005)
    robot.close()


def lens_to_marker_mm(robot: SimulatedRobot) -> float:
    """As a technician would measure it: at right angles to the sheet."""
    pose = robot.pose
    left = (-math.sin(pose.heading_rad), math.cos(pose.heading_rad))
    away = [
        ((marker.x_m - pose.x_m) * left[0] + (marker.y_m - pose.y_m) * left[1], marker)
        for marker in robot.world.markers
        if math.dist((marker.x_m, marker.y_m), (pose.x_m, pose.y_m)) < 1.0
    ]
    return 1000 * min(mm for mm, _ in away if mm > 0)


def test_without_a_marker_there_is_no_field_of_view() -> None:
    robot = SimulatedRobot(find_map("test_track"), 0.0, "post3:post2", in_memory=True)
    robot.step_until(0.1)
    frames = [frame for _, frame in (robot.camera.read() for _ in range(5)) if frame is not None]
    with pytest.raises(CalibrationFailed, match="No marker"):
        field_of_view_deg(frames, 300.0)
    robot.close()
