"""Where a marker sheet is before the camera.

A decoder gives a code's four corners in whole pixels, often one or two off. But once the text is read, the whole
pattern is known: it is laid over the picture and shifted until it fits best (`cv2.findTransformECC`), which finds the
corners to a tenth of a pixel, in bad light too. From these four come distance, place and angle.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple, cast

import cv2
import numpy as np
from numpy.typing import NDArray

from maps.sheets import marker_code
from robot.drivers.camera.qr_decoders import Corners
from robot.drivers.interfaces import Frame

Points = NDArray[np.float64]

PX_PER_MODULE = 3  # of the pattern that is laid over
QUIET = 1  # modules of paper around it
ENDS = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_MAX_ITER, 8, 1e-4)
FITS = 0.6
"""Correlation from which the pattern is believed to lie on its picture: 0.9 in low light, below 0.3 beside it."""
MARGIN_PX = 20
FITTED_PX, DETECTED_PX, WHOLE_PX = 0.15, 0.3, 1.0
"""Standard deviation of a corner: fitted, as a tag's detector gives it, as a QR decoder gives it (measured)."""


@dataclass(frozen=True, slots=True)
class Optics:
    """A pinhole camera without distortion."""

    field_of_view_deg: float = 60.0

    def focal_px(self, width_px: int) -> float:
        return width_px / 2 / math.tan(math.radians(self.field_of_view_deg) / 2)


class SheetPose(NamedTuple):
    """The middle of a code before the lens. `turned_rad` is positive where its right edge is the nearer one.

    The accuracies are standard deviations, of the distance and of the angle.
    """

    away_mm: float
    right_mm: float
    turned_rad: float
    accuracy_mm: float
    accuracy_rad: float


def code_pose(grey: Frame, text: str, corners: Corners, size_mm: float, optics: Optics) -> SheetPose | None:
    """None where the corners are not those of a flat sheet in front of the lens."""
    there = np.array(corners)
    if not _is_convex(there):
        return None
    fitted = _fitted(grey, text, there)
    if fitted is None:
        return _pose(there, grey.shape, size_mm, optics, WHOLE_PX)
    return _pose(fitted, grey.shape, size_mm, optics, FITTED_PX)


def tag_pose(grey: Frame, corners: Corners, size_mm: float, optics: Optics) -> SheetPose | None:
    """As `code_pose`, for a tag whose corners come to a fraction of a pixel."""
    there = np.array(corners)
    return _pose(there, grey.shape, size_mm, optics, DETECTED_PX) if _is_convex(there) else None


def _is_convex(corners: Points) -> bool:
    return bool(np.isfinite(corners).all()) and cv2.isContourConvex(corners.astype(np.float32))


@lru_cache(maxsize=64)
def _pattern(text: str) -> Frame:
    """The sheet's code as a camera would see it close by. Making one costs milliseconds, so it is kept."""
    modules = np.array([list(row) for row in marker_code(text).matrix], np.uint8)
    ink = np.kron(np.pad(modules, QUIET), np.ones((PX_PER_MODULE, PX_PER_MODULE)))
    return cast(Frame, cv2.GaussianBlur((230 - 200 * ink).astype(np.uint8), (0, 0), PX_PER_MODULE / 4))


def _fitted(grey: Frame, text: str, corners: Points) -> Points | None:
    """The corners, where the pattern of this text fits best; None where it does not fit."""
    pattern = _pattern(text)
    low, high = QUIET * PX_PER_MODULE - 0.5, len(pattern) - QUIET * PX_PER_MODULE - 0.5
    square = np.array(((low, low), (high, low), (high, high), (low, high)), np.float32)
    left, top = (int(max(0.0, value - MARGIN_PX)) for value in corners.min(axis=0))
    right, bottom = (int(value + MARGIN_PX) for value in corners.max(axis=0))
    part = grey[top:bottom, left:right]
    guess = cv2.getPerspectiveTransform(square, (corners - (left, top)).astype(np.float32)).astype(np.float32)
    try:
        fits, found = cv2.findTransformECC(pattern, part, guess, cv2.MOTION_HOMOGRAPHY, ENDS)
    except cv2.error:  # it did not converge
        return None
    if fits < FITS:
        return None
    return cast(Points, np.add(cv2.perspectiveTransform(square[None], found)[0], (left, top), dtype=np.float64))


def _pose(
    corners: Points, shape: tuple[int, ...], size_mm: float, optics: Optics, corner_px: float
) -> SheetPose | None:
    height, width = shape[:2]
    focal, half = optics.focal_px(width), size_mm / 2
    lens = np.array(((focal, 0, (width - 1) / 2), (0, focal, (height - 1) / 2), (0, 0, 1)))
    printed = np.array(((-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)))
    try:
        _, turns, places, _ = cv2.solvePnPGeneric(printed, corners, lens, None, flags=cv2.SOLVEPNP_IPPE)
    except cv2.error:
        return None
    if not len(turns) or places[0][2, 0] <= 0:
        return None
    # Of two poses that look alike the better comes first.
    sheet = cv2.Rodrigues(turns[0])[0]
    right_mm, _, away_mm = (float(value) for value in places[0].ravel())
    turned_rad = math.atan2(-sheet[2, 0], sheet[0, 0])
    return SheetPose(away_mm, right_mm, turned_rad, *_accuracy(away_mm, turned_rad, size_mm, focal, corner_px))


def _accuracy(
    away_mm: float, turned_rad: float, size_mm: float, focal_px: float, corner_px: float
) -> tuple[float, float]:
    """An edge that is off by a share of its length is away by that share more or less.

    The angle is how much farther one edge is than the other; seen from aslant the foreshortening tells as well.
    """
    edge_mm = away_mm * corner_px * away_mm / (focal_px * size_mm)
    by_distance = edge_mm * math.sqrt(2) / size_mm
    by_width = edge_mm / away_mm / max(0.01, abs(math.sin(turned_rad)))
    return max(1.0, edge_mm), min(by_distance, by_width)
