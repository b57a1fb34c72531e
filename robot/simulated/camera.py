"""The camera as OpenCV's `VideoCapture` would offer it, with the hand-over codes that people hold up to it."""

import math
from collections.abc import Callable

import cv2

from robot.simulated.faults import Faults
from robot.simulated.frames import Frame, Renderer, View

SHOWN_FOR_S = 20.0
STEPS_WITH_IT_M = 0.3
"""A person who holds a code up does not run beside a robot that drives away."""


class SimulatedCamera:
    """`read` draws what the camera sees at this moment; it never waits for the next frame as a real one does."""

    def __init__(
        self, renderer: Renderer, view: Callable[[], View], clock: Callable[[], float], faults: Faults
    ) -> None:
        self._renderer = renderer
        self._view = view
        self._clock = clock
        self._faults = faults
        self._open = True
        self._newest: Frame | None = None
        self._shown: tuple[str, float, View] | None = None
        self.frames_read = 0

    def show(self, text: str, for_s: float = SHOWN_FOR_S) -> None:
        """A person holds this text up as a QR code, for so long or until `hide`."""
        self._shown = (text, self._clock() + for_s, self._view())

    def hide(self) -> None:
        self._shown = None

    @property
    def shown(self) -> str | None:
        """The text held up now."""
        if self._shown and (self._clock() >= self._shown[1] or self._has_left(self._shown[2])):
            self._shown = None
        return self._shown[0] if self._shown else None

    def _has_left(self, there: View) -> bool:
        here = self._view()
        return math.dist((here.x_m, here.y_m), (there.x_m, there.y_m)) > STEPS_WITH_IT_M

    def read(self) -> tuple[bool, Frame | None]:
        """(True, height × width frame), or (False, None) after `release` and while the camera is dead."""
        if not self._open or self._faults.camera_dead:
            return False, None
        self.frames_read += 1
        if self._newest is None or not self._faults.camera_frozen:
            self._newest = self._renderer.frame(self._view(), self.shown)
        return True, self._newest.copy()

    def isOpened(self) -> bool:  # noqa: N802  # OpenCV's own name
        return self._open

    def get(self, prop: int) -> float:
        """Width and height; 0.0 for everything else, as OpenCV says for what a camera does not know."""
        width_px, height_px = self._renderer.size_px
        return {cv2.CAP_PROP_FRAME_WIDTH: float(width_px), cv2.CAP_PROP_FRAME_HEIGHT: float(height_px)}.get(prop, 0.0)

    def set(self, prop: int, value: float) -> bool:
        """Only the size it has can be set, and one frame of buffer, which is all there is."""
        return self.get(prop) == value or (prop == cv2.CAP_PROP_BUFFERSIZE and value == 1)

    def release(self) -> None:
        self._open = False

    def close(self) -> None:
        """The same, as the robot's own camera door calls it."""
        self.release()
