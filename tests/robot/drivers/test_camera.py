"""The camera door: a real file behind OpenCV, and the simulated camera, which can die and come back."""

import time
from collections.abc import Callable

import cv2
import numpy as np
import pytest

from robot.core.errors import CameraAbsent
from robot.drivers.camera.camera import Device, GrabbingCamera
from robot.drivers.camera.marker_reader import MarkerReader, MarkerWatch
from robot.drivers.interfaces import Frame
from robot.simulated import SimulatedRobot
from tests.plain_maps import plain_map

pytestmark = pytest.mark.alone
TRACK = plain_map("test_track")


def within_s(limit_s: float, condition: Callable[[], bool]) -> bool:
    until_s = time.monotonic() + limit_s
    while time.monotonic() < until_s:
        if condition():
            return True
        time.sleep(0.005)
    return condition()


def newest(camera: GrabbingCamera, limit_s: float = 2.0) -> Frame | None:
    frames: list[Frame | None] = []
    within_s(limit_s, lambda: bool((got := camera.read())[0] and not frames.append(got[1])))
    return frames[0] if frames else None


@pytest.fixture
def pictures(tmp_path):
    """Three numbered pictures, which OpenCV opens as a video."""
    for number, grey in enumerate((40, 120, 200)):
        cv2.imwrite(str(tmp_path / f"frame_{number}.png"), np.full((480, 640, 3), grey, np.uint8))
    return str(tmp_path / "frame_%d.png")


def test_real_frames_come_out_of_opencv_and_only_the_newest_is_kept(pictures):
    camera = GrabbingCamera(pictures)
    try:
        assert within_s(2.0, lambda: camera.describe().age_s > 0.1), "it has read to the end"
        there_is_one, frame = camera.read()
        assert there_is_one and frame is not None and frame.shape == (480, 640, 3)
        assert frame[0, 0, 0] == 200, "the last picture"
        assert camera.read() == (False, None), "none is handed out twice"
        state = camera.describe()
        assert (state.width_px, state.height_px) == (640, 480)
        assert state.exposure_ms is None, "a file has no exposure to set"
    finally:
        camera.close()


def test_a_source_that_ended_is_opened_again(pictures):
    """To the driver a film that is over is a camera that was unplugged and is back."""
    camera = GrabbingCamera(pictures)
    try:
        assert newest(camera) is not None
        assert within_s(4.0, lambda: camera.describe().reopened >= 1)
        assert within_s(1.0, lambda: camera.read()[0])
    finally:
        camera.close()


def test_a_camera_that_is_not_there_is_named():
    with pytest.raises(CameraAbsent, match=r"video device nowhere\.avi"):
        GrabbingCamera("nowhere.avi")


class Socket:
    """Where a camera can be plugged in: what opens is the simulated camera, or nothing."""

    def __init__(self, robot: SimulatedRobot) -> None:
        self.plugged, self.opened, self._robot = True, 0, robot

    def open(self, _: int | str) -> Device:
        self.opened += 1
        return Plugged(self, self._robot)


class Plugged:
    """As OpenCV on Linux: after the cable is out it is still open, and reads nothing for ever after."""

    def __init__(self, socket: Socket, robot: SimulatedRobot) -> None:
        self._socket, self._camera, self._lost = socket, robot.camera, not socket.plugged
        self._released = False

    def isOpened(self) -> bool:  # noqa: N802
        return not self._lost and not self._released

    def read(self) -> tuple[bool, Frame | None]:
        assert not self._released, "read after release crashes OpenCV"
        self._lost = self._lost or not self._socket.plugged
        return (False, None) if self._lost else self._camera.read()

    def get(self, prop: int, /) -> float:
        return 150.0 if prop == cv2.CAP_PROP_EXPOSURE else self._camera.get(prop)

    def set(self, prop: int, value: float, /) -> bool:
        exposure = (cv2.CAP_PROP_AUTO_EXPOSURE, cv2.CAP_PROP_EXPOSURE)
        return prop in exposure or self._camera.set(prop, value)

    def release(self) -> None:
        assert not self._released, "released twice"
        self._released = True


def test_an_unplugged_camera_grows_old_and_is_back_within_two_seconds_of_being_plugged_in():
    robot = SimulatedRobot(TRACK, 0.0, "post1", in_memory=True)
    socket = Socket(robot)
    camera = GrabbingCamera(0, open_device=socket.open)
    watch = MarkerWatch(camera, MarkerReader(TRACK.posts), time.monotonic())
    try:
        assert within_s(2.0, lambda: bool(watch.tick(time.monotonic()).posts)), "it reads its marker"
        assert camera.describe().exposure_ms == 15.0
        socket.plugged = False
        time.sleep(1.3)
        camera.read()
        assert watch.tick(time.monotonic()).frame_age_s > 1.0
        assert within_s(2.0, lambda: socket.opened >= 3), "it keeps trying"
        socket.plugged = True
        assert within_s(2.0, lambda: bool(watch.tick(time.monotonic()).posts))
        assert camera.describe().reopened == 1
    finally:
        camera.close()
        robot.close()


def test_a_camera_that_freezes_for_less_than_a_second_is_left_open():
    robot = SimulatedRobot(TRACK, 0.0, "post1", in_memory=True)
    socket = Socket(robot)
    camera = GrabbingCamera(0, open_device=socket.open)
    try:
        assert newest(camera) is not None
        robot.set_fault("camera_dead", True)
        time.sleep(0.5)
        robot.set_fault("camera_dead", False)
        assert newest(camera) is not None
        assert (socket.opened, camera.describe().reopened) == (1, 0)
    finally:
        camera.close()
        robot.close()
