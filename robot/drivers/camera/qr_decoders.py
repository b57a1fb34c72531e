"""Two ways to read QR codes behind one function: zxing-cpp where it is installed, else a ladder of OpenCV's detectors.

Whatever a decoder does with a foreign or torn code, it never takes the robot down: OpenCV raises on some of them.
"""

from collections.abc import Callable, Iterator
from time import thread_time
from typing import Any, NamedTuple, cast

import cv2
import numpy as np

from robot.drivers.interfaces import Frame

Corner = tuple[float, float]
Corners = tuple[Corner, Corner, Corner, Corner]
LADDER_BUDGET_S = 0.080
"""Of this thread's own time: that others use the machine too is no reason to give a code up."""
CROP_MARGIN = 0.25
"""Of a detected code's size: OpenCV's quads are often a few modules off."""
SMALLEST_PX = 24
"""Side of the smallest code worth a look: version 1 at little more than one pixel a module."""


class Decoded(NamedTuple):
    """A code and its corners in pixels: top left, top right, bottom right, bottom left of the printed code."""

    text: str
    corners: Corners


Decoder = Callable[[Frame], tuple[Decoded, ...]]


def best_decoder() -> Decoder:
    """zxing-cpp reads more and twenty times faster, but has no wheel for every machine."""
    try:
        import zxingcpp
    except ImportError:
        return read_with_opencv
    return zxing_decoder(zxingcpp)


def grey_of(frame: Frame) -> Frame:
    return frame if frame.ndim == 2 else cast(Frame, cv2.cvtColor(frame, cv2.COLOR_BGR2GRAY))


# What is worth a look

CELL_PX = 4
CONTRAST = 6.5
"""Of the strongest steps to the median one. Grain alone reaches 5.8 at 1920 × 1080; of the generated pictures with a
code (`benchmarks/body`) none is below 7.2."""
CERTAIN_STEP = 40
"""Grey levels that no grain makes: a busy scene, whose median step is large as well, is looked at for these alone."""
LEAST_STEP = 5
"""Grey levels between neighbouring cells; below that lies nothing but grain."""
STRONG = 20
"""How many steps are as large as what counts as strong. The smallest code worth a look has more edges."""


def may_hold_code(grey: Frame) -> bool:
    """Return whether anything in the frame stands out: an empty wall is not searched for codes (0.2 ms instead of
    3)."""
    cells = cv2.resize(grey, None, fx=1 / CELL_PX, fy=1 / CELL_PX, interpolation=cv2.INTER_AREA)
    steps = cv2.absdiff(cells[:, 1:], cells[:, :-1])
    counts = cv2.calcHist([steps], [0], None, [256], [0, 256]).ravel()
    up_to = np.cumsum(counts)
    strong = int(np.searchsorted(up_to, up_to[-1] - STRONG))
    if strong <= LEAST_STEP or strong > CERTAIN_STEP:
        return strong > CERTAIN_STEP
    half, middle = up_to[-1] / 2, int(np.searchsorted(up_to, up_to[-1] / 2))
    # Grain has a median of 0.5 to 6 levels: whole ones would be too coarse.
    median = middle + 0.5 - float((up_to[middle] - half) / counts[middle])
    return strong > CONTRAST * median


# zxing-cpp

ENLARGED_UP_TO_PX = 800 * 600
"""Of 1,920 × 1,080 enlarging would cost 10 ms a frame, and read no more of the generated pictures."""


def zxing_decoder(zxingcpp: Any) -> Decoder:
    """A decoder by zxing-cpp, of QR codes alone: as it is, then without grain, then enlarged.

    Codes are found at any rotation. Light on dark is not looked for: we print none.
    """

    def read(picture: Frame) -> list[Any]:
        try:
            return list(
                zxingcpp.read_barcodes(
                    picture,
                    formats=zxingcpp.BarcodeFormat.QRCodeModel2,  # QRCode would be its small and oblong relatives too
                    binarizer=zxingcpp.Binarizer.LocalAverage,
                    try_rotate=False,  # turned lines only: its search for QR codes knows every direction
                    try_downscale=True,
                    try_invert=False,
                )
            )
        except Exception:  # a decoder's own fault must not stop the robot
            return []

    def look(frame: Frame) -> tuple[Decoded, ...]:
        grey = grey_of(frame)
        for scale, picture in _looks(grey) if may_hold_code(grey) else ():
            found = tuple(Decoded(code.text, _scaled(code.position, scale)) for code in read(picture) if code.text)
            if found:
                return found
        return ()

    return look


def _looks(grey: Frame) -> Iterator[tuple[float, Frame]]:
    """Low light needs the second, steep and small codes the third. A large frame has pixels enough as it is."""
    yield 1.0, grey
    yield 1.0, cast(Frame, cv2.GaussianBlur(grey, (0, 0), 1.3))
    if grey.size <= ENLARGED_UP_TO_PX:
        yield 1.5, _enlarged(grey, 1.5)


def _scaled(position: Any, scale: float) -> Corners:
    """zxing-cpp counts from the middle of the first pixel, and in whole ones."""
    a, b, c, d = position.top_left, position.top_right, position.bottom_right, position.bottom_left
    points = (((p.x + 0.5) / scale - 0.5, (p.y + 0.5) / scale - 0.5) for p in (a, b, c, d))
    return cast(Corners, tuple(points))


# OpenCV


def read_with_opencv(frame: Frame, budget_s: float = LADDER_BUDGET_S) -> tuple[Decoded, ...]:
    """One code at most. Later rungs look only at what an earlier one has detected, as long as time is left."""
    until_s = thread_time() + budget_s
    grey = grey_of(frame)
    plain, other = cv2.QRCodeDetector(), cv2.QRCodeDetectorAruco()
    box: tuple[int, int, int, int] | None = None
    for detector in (plain, other):
        found, quad = _try(detector, grey)
        if found:
            return (found,)
        box = box or _box(quad, grey)
    if box is None:
        return ()
    left, top, right, bottom = box
    part = np.ascontiguousarray(grey[top:bottom, left:right])
    for scale, picture in _rungs(part):
        if thread_time() > until_s:
            return ()
        found, _ = _try(plain, picture)
        if found:
            return (_moved(found, scale, left, top),)
    return ()


def _rungs(part: Frame) -> Iterator[tuple[float, Frame]]:
    """The detected part alone, enlarged: the whole frame would cost 40 ms a rung."""
    yield 3.0, _enlarged(part, 3.0)
    yield 2.0, (larger := _enlarged(part, 2.0))
    blurred = cv2.GaussianBlur(larger, (0, 0), 2)
    yield 2.0, cast(Frame, cv2.addWeighted(larger, 1.8, blurred, -0.8, 0))
    low, high = np.percentile(larger, (2, 98))
    stretched = np.clip((larger.astype(np.float32) - low) * (255 / max(1.0, high - low)), 0, 255).astype(np.uint8)
    yield 2.0, cast(Frame, cv2.GaussianBlur(stretched, (5, 5), 0))


def _try(detector: Any, picture: Frame) -> tuple[Decoded | None, Any]:
    """The decoded markers, and where something was detected."""
    try:
        text, quad, _ = detector.detectAndDecode(picture)
    except (cv2.error, UnicodeDecodeError):  # raised on some foreign codes
        return None, None
    if quad is None or len(quad) == 0:
        return None, None
    points = np.asarray(quad, dtype=float).reshape(-1, 2)
    if not text or len(points) != 4 or not np.isfinite(points).all():
        return None, points
    return Decoded(text, cast(Corners, tuple((float(x), float(y)) for x, y in points))), points


def _box(quad: Any, grey: Frame) -> tuple[int, int, int, int] | None:
    """Left, top, right, bottom around a detected code; None where there is nothing or the quad makes no sense."""
    if quad is None or not np.isfinite(quad).all():
        return None
    low, high = quad.min(axis=0), quad.max(axis=0)
    margin = CROP_MARGIN * float((high - low).max()) + 8
    left, top = (int(max(0.0, value - margin)) for value in low)
    right, bottom = (int(min(size, value + margin)) for value, size in zip(high, grey.shape[::-1], strict=True))
    return (left, top, right, bottom) if min(right - left, bottom - top) >= SMALLEST_PX else None


def _moved(found: Decoded, scale: float, left: int, top: int) -> Decoded:
    """Corners of an enlarged part, in the whole picture."""
    points = (((x + 0.5) / scale - 0.5 + left, (y + 0.5) / scale - 0.5 + top) for x, y in found.corners)
    return Decoded(found.text, cast(Corners, tuple(points)))


def _enlarged(picture: Frame, times: float) -> Frame:
    return cast(Frame, cv2.resize(picture, None, fx=times, fy=times, interpolation=cv2.INTER_CUBIC))
