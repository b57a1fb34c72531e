"""Two ways to read QR codes behind one function: zxing-cpp where it is installed, else a ladder of OpenCV's detectors.

Whatever a decoder does with a foreign or torn code, it never takes the robot down: OpenCV raises on some of them.
"""

from collections.abc import Callable, Iterator
from time import perf_counter
from typing import Any, NamedTuple, cast

import cv2
import numpy as np

from .interfaces import Frame

Corner = tuple[float, float]
LADDER_BUDGET_S = 0.040


class Decoded(NamedTuple):
    """A code and its corners in pixels: top left, top right, bottom right, bottom left of the printed code."""

    text: str
    corners: tuple[Corner, Corner, Corner, Corner]


Decoder = Callable[[Frame], tuple[Decoded, ...]]


def best_decoder() -> Decoder:
    """zxing-cpp reads more and twenty times faster, but has no wheel for every machine."""
    try:
        import zxingcpp
    except ImportError:
        return read_with_opencv
    return zxing_decoder(zxingcpp)


def zxing_decoder(zxingcpp: Any) -> Decoder:
    """A decoder of upright QR codes by zxing-cpp."""
    qr_only = zxingcpp.BarcodeFormat.QRCode

    def read(frame: Frame) -> tuple[Decoded, ...]:
        try:
            found = zxingcpp.read_barcodes(
                _grey(frame), formats=qr_only, try_rotate=False, try_downscale=True, try_invert=False
            )
        except Exception:  # a decoder's own fault must not stop the robot
            return ()
        return tuple(Decoded(code.text, _corners(code.position)) for code in found)

    return read


def _corners(position: Any) -> tuple[Corner, Corner, Corner, Corner]:
    a, b, c, d = position.top_left, position.top_right, position.bottom_right, position.bottom_left
    return (a.x, a.y), (b.x, b.y), (c.x, c.y), (d.x, d.y)


def read_with_opencv(frame: Frame, budget_s: float = LADDER_BUDGET_S) -> tuple[Decoded, ...]:
    """One code at most. Later rungs only if a code was detected at all and time is left (an empty frame: 9 ms)."""
    began_s = perf_counter()
    grey = _grey(frame)
    for scale, picture, detector in _rungs(grey):
        found, detected = _try(detector, picture, scale)
        if found:
            return (found,)
        if not detected or perf_counter() - began_s > budget_s:
            return ()
    return ()


def _rungs(grey: Frame) -> Iterator[tuple[float, Frame, Any]]:
    plain = cv2.QRCodeDetector()
    yield 1.0, grey, plain
    yield 1.0, grey, cv2.QRCodeDetectorAruco()
    larger = cast(Frame, cv2.resize(grey, None, fx=2, fy=2, interpolation=cv2.INTER_CUBIC))
    yield 2.0, larger, plain
    blurred = cv2.GaussianBlur(larger, (0, 0), 2)
    yield 2.0, cast(Frame, cv2.addWeighted(larger, 1.8, blurred, -0.8, 0)), plain
    low, high = np.percentile(grey, (2, 98))
    stretched = np.clip((grey.astype(np.float32) - low) * (255 / max(1.0, high - low)), 0, 255).astype(np.uint8)
    yield 1.0, cast(Frame, cv2.GaussianBlur(stretched, (3, 3), 0)), plain


def _try(detector: Any, picture: Frame, scale: float) -> tuple[Decoded | None, bool]:
    try:
        text, quad, _ = detector.detectAndDecode(picture)
    except (cv2.error, UnicodeDecodeError):  # raised on some foreign codes
        return None, True
    if quad is None or len(quad) == 0:
        return None, False
    points = np.asarray(quad, dtype=float).reshape(-1, 2)[:4] / scale
    corners = cast(tuple[Corner, Corner, Corner, Corner], tuple((float(x), float(y)) for x, y in points))
    return (Decoded(text, corners) if text and len(corners) == 4 else None), True


def _grey(frame: Frame) -> Frame:
    return frame if frame.ndim == 2 else cast(Frame, cv2.cvtColor(frame, cv2.COLOR_BGR2GRAY))
