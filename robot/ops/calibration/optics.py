"""The camera's field of view, from one marker at a measured distance."""

import math
from collections.abc import Iterable
from statistics import median

from robot.drivers.camera.marker_pose import Optics, code_pose
from robot.drivers.camera.marker_reader import MARKER_SIZE_MM
from robot.drivers.camera.qr_decoders import best_decoder, grey_of
from robot.drivers.interfaces import Frame
from robot.ops.calibration.rig import CalibrationFailed

FEWEST = 3


def field_of_view_deg(frames: Iterable[Frame], distance_mm: float, assumed: Optics | None = None) -> float:
    """From the lens to the sheet, at right angles. Raises CalibrationFailed.

    How far a marker of known size seems away goes with the focal length: the assumed one is corrected by what the
    distance really is.
    """
    assumed = assumed or Optics()
    found = [_focal_px(frame, distance_mm, assumed) for frame in frames]
    seen = [pair for pair in found if pair is not None]
    if len(seen) < FEWEST:
        raise CalibrationFailed("No marker was read: hold one up, 80 mm wide, straight before the lens, in good light.")
    focal_px, width_px = median(focal for focal, _ in seen), seen[0][1]
    return math.degrees(2 * math.atan(width_px / 2 / focal_px))


def _focal_px(frame: Frame, distance_mm: float, assumed: Optics) -> tuple[float, int] | None:
    grey, width_px = grey_of(frame), frame.shape[1]
    for code in best_decoder()(frame):
        pose = code_pose(grey, code.text, code.corners, MARKER_SIZE_MM, assumed)
        if pose is not None and pose.away_mm > 0:
            return assumed.focal_px(width_px) * distance_mm / pose.away_mm, width_px
    return None
