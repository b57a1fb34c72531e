"""The camera on the left side: a thread grabs without pause and keeps only the newest frame."""

import threading
from typing import cast

import cv2

from ..errors import CameraAbsent
from .interfaces import Frame


class GrabbingCamera:
    """See `interfaces.Camera`. Raises CameraAbsent when the device does not open."""

    def __init__(self, device: int | str, width_px: int = 640, height_px: int = 480, exposure_ms: float = 15.0) -> None:
        self._capture = cv2.VideoCapture(device)
        if not self._capture.isOpened():
            raise CameraAbsent(device)
        self._set(width_px, height_px, exposure_ms)
        self._newest: Frame | None = None
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._grab, name="camera", daemon=True)
        self._thread.start()

    def _set(self, width_px: int, height_px: int, exposure_ms: float) -> None:
        self._capture.set(cv2.CAP_PROP_FRAME_WIDTH, width_px)
        self._capture.set(cv2.CAP_PROP_FRAME_HEIGHT, height_px)
        # V4L2: 1 is manual, exposure counts in 0.1 ms. A camera that does not allow it stays as it is.
        self._capture.set(cv2.CAP_PROP_AUTO_EXPOSURE, 1)
        self._capture.set(cv2.CAP_PROP_EXPOSURE, exposure_ms * 10)

    def _grab(self) -> None:
        while not self._closing.is_set():
            there_is_one, frame = self._capture.read()
            if there_is_one:
                self._newest = cast(Frame, frame)
            else:
                # Unplugged or starved: the age of the newest frame tells; try again without a busy loop.
                self._closing.wait(0.2)

    def read(self) -> tuple[bool, Frame | None]:
        """See `interfaces.Camera.read`."""
        frame, self._newest = self._newest, None
        return frame is not None, frame

    def close(self) -> None:
        """Stop grabbing and free the device."""
        self._closing.set()
        self._thread.join(timeout=2.0)
        self._capture.release()
