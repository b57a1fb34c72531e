"""The camera on the left side: a thread grabs without pause and keeps only the newest frame.

A camera that was unplugged is opened again, once a second, for as long as it takes; meanwhile there are no frames, and
the age of the last one tells.
"""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol, cast

import cv2
import structlog

from robot.core.errors import CameraAbsent
from robot.drivers.interfaces import Frame

log = structlog.get_logger("robot.camera")

DEAD_AFTER_S = 1.0
REOPEN_EVERY_S = 1.0
STARVED_S = 0.02
"""Pause after a read that gave nothing, so that a dead device keeps no processor busy."""
CLOSES_WITHIN_S = 2.0
MANUAL_EXPOSURE = 1.0  # V4L2
UNITS_PER_MS = 10.0  # V4L2 counts exposure in 0.1 ms


class Device(Protocol):
    """The interface that OpenCV's `VideoCapture` and the simulated camera share."""

    def isOpened(self) -> bool: ...  # noqa: N802  # OpenCV's own name

    def read(self) -> tuple[bool, Any]: ...

    def get(self, prop: int, /) -> float: ...

    def set(self, prop: int, value: float, /) -> bool: ...

    def release(self) -> None: ...


def _video(device: int | str) -> Device:
    """Failures are told by name here; what OpenCV writes to the error stream of its own accord says nothing more."""
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
    return cast(Device, cv2.VideoCapture(device))


@dataclass(frozen=True, slots=True)
class CameraState:
    """The camera's real settings, which may differ from what was asked. `exposure_ms` None: it chooses by itself."""

    width_px: int
    height_px: int
    frames_per_s: float
    exposure_ms: float | None
    age_s: float
    """Since the last frame, or since the start if none ever came."""
    reopened: int
    """How often the device had to be opened again."""


class GrabbingCamera:
    """See `interfaces.Camera`. Raises CameraAbsent when the device does not open."""

    def __init__(
        self,
        device: int | str,
        width_px: int = 640,
        height_px: int = 480,
        exposure_ms: float = 15.0,
        open_device: Callable[[int | str], Device] | None = None,
    ) -> None:
        self._source, self._open_device = device, open_device or _video
        self._wanted = {cv2.CAP_PROP_FRAME_WIDTH: width_px, cv2.CAP_PROP_FRAME_HEIGHT: height_px}
        self._wanted_exposure_ms = exposure_ms
        self._exposure_ms: float | None = None
        self._device = self._opened()
        if self._device is None:
            raise CameraAbsent(device)
        self._newest: Frame | None = None
        self._shape = (0, 0)
        self._frame_s = self._since_s = self._opened_s = time.monotonic()
        self._frames = self._reopened = 0
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._grab, name="camera grabber", daemon=True)
        self._thread.start()

    def _opened(self) -> Device | None:
        """The device with everything set that it lets be set; None if it is not there."""
        device = self._open_device(self._source)
        if not device.isOpened():
            device.release()
            return None
        for prop, value in self._wanted.items():
            device.set(prop, value)
        device.set(cv2.CAP_PROP_BUFFERSIZE, 1)
        manual = device.set(cv2.CAP_PROP_AUTO_EXPOSURE, MANUAL_EXPOSURE)
        taken = manual and device.set(cv2.CAP_PROP_EXPOSURE, self._wanted_exposure_ms * UNITS_PER_MS)
        self._exposure_ms = device.get(cv2.CAP_PROP_EXPOSURE) / UNITS_PER_MS if taken else None
        return device

    def _grab(self) -> None:
        """Alone with the device: OpenCV's read may block for ten seconds, and no other thread may free it meanwhile."""
        while not self._closing.is_set():
            if self._device is None:
                self._reopen()
            elif not self._grab_one(self._device):
                self._give_up_if_dead()
        if self._device is not None:
            self._device.release()

    def _grab_one(self, device: Device) -> bool:
        try:
            there_is_one, frame = device.read()
        except Exception:  # OpenCV has errors beside its own for a device that is going away; this thread outlives them
            there_is_one, frame = False, None
        if not there_is_one or frame is None:
            self._closing.wait(STARVED_S)
            return False
        self._newest = cast(Frame, frame)
        self._shape = frame.shape[:2]
        self._frame_s = time.monotonic()
        self._frames += 1
        return True

    def _give_up_if_dead(self) -> None:
        if self._device is not None and time.monotonic() - max(self._frame_s, self._opened_s) > DEAD_AFTER_S:
            log.warning("camera_silent", device=self._source, age_s=round(time.monotonic() - self._frame_s, 1))
            self._device.release()
            self._device = None

    def _reopen(self) -> None:
        try:
            self._device = self._opened()
        except Exception:  # see _grab_one
            self._device = None
        if self._device is None:
            self._closing.wait(REOPEN_EVERY_S)
            return
        self._opened_s = time.monotonic()
        self._reopened += 1
        log.info("camera_reopened", device=self._source)

    def read(self) -> tuple[bool, Frame | None]:
        """See `interfaces.Camera.read`."""
        frame, self._newest = self._newest, None
        return frame is not None, frame

    def describe(self) -> CameraState:
        """Describe the camera's output, for people who set it up; the rate is the mean since the start."""
        now = time.monotonic()
        rate = self._frames / max(0.001, now - self._since_s)
        height_px, width_px = self._shape
        return CameraState(width_px, height_px, rate, self._exposure_ms, now - self._frame_s, self._reopened)

    def close(self) -> None:
        """Stop grabbing and free the device; a read that hangs is left to end by itself."""
        self._closing.set()
        self._thread.join(timeout=CLOSES_WITHIN_S)
