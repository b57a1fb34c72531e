"""AprilTags 36h11, printed below the QR code where `camera.april_tags` is set: a post whose code is torn is still read.

A tag holds a number and nothing else; which post that is says one table, `maps.tags.tag_numbers`.
"""

from collections.abc import Mapping
from typing import Any, cast

import cv2
import numpy as np

from maps.tags import TAG_SIZE_MM
from robot.drivers.camera.qr_decoders import Corners, Decoded
from robot.drivers.interfaces import Frame

CORRECTED = 0.2
"""Share of the 5 bits that could be mended which are: one. Others would be read out of bricks and posters."""


class TagDetector:
    """Reads the tags of the table; every other one is foreign."""

    size_mm = TAG_SIZE_MM

    def __init__(self, posts: Mapping[int, str]) -> None:
        self._posts = dict(posts)
        parameters = cv2.aruco.DetectorParameters()
        parameters.errorCorrectionRate = CORRECTED
        parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
        family = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
        self._detector = cv2.aruco.ArucoDetector(family, parameters)

    def read(self, grey: Frame) -> tuple[Decoded, ...]:
        """Known tags as if they were codes: the post's name and the corners of the black square."""
        try:
            squares, numbers, _ = self._detector.detectMarkers(grey)
        except cv2.error:  # a decoder's own fault must not stop the robot
            return ()
        if not squares:
            return ()
        found = zip(numbers.ravel(), squares, strict=True)
        return tuple(
            Decoded(self._posts[int(number)], _corners(square))
            for number, square in found
            if int(number) in self._posts
        )


def _corners(square: Any) -> Corners:
    return cast(Corners, tuple((float(x), float(y)) for x, y in np.asarray(square).reshape(4, 2)))
