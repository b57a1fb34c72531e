"""Markers out of frames: decode with guard, check against the map, and say where the marker is as the robot sees it.

The camera looks to the left, so that right in the picture is ahead of the robot. Distance comes from the height of the
printed code, which a turned sheet does not change.
"""

import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass

from .interfaces import BodyShape, Camera, CameraReport, Frame, Sighting
from .qr_decoders import Decoded, Decoder, best_decoder

HANDOVER_PREFIX = "CM1:"
MARKER_SIZE_MM = 80.0
AGREE, OUT_OF = 2, 3
"""Equal reads that accept, of how many looks: a torn code that reads as another post would send the robot astray."""


@dataclass(frozen=True, slots=True)
class Optics:
    """A pinhole camera without distortion."""

    field_of_view_deg: float = 60.0

    def focal_px(self, width_px: int) -> float:
        return width_px / 2 / math.tan(math.radians(self.field_of_view_deg) / 2)


class MarkerReader:
    """Finds markers of known posts, and hand-over codes, in one frame. Everything else is foreign and ignored."""

    def __init__(
        self,
        posts: Iterable[str],
        optics: Optics | None = None,
        shape: BodyShape | None = None,
        decode: Decoder | None = None,
    ) -> None:
        self._posts = frozenset(posts)
        self._optics, self._shape = optics or Optics(), shape or BodyShape()
        self._decode = decode or best_decoder()

    def look(self, frame: Frame, now: float) -> tuple[Sighting, ...]:
        """What is in this frame; `text` is a post's name or begins with `CM1:`."""
        known = (code for code in self._decode(frame) if self._is_known(code.text))
        width_px = frame.shape[1]
        return tuple(self._sighting(code, width_px, now) for code in known)

    def _is_known(self, text: str) -> bool:
        return text in self._posts or text.startswith(HANDOVER_PREFIX)

    def _sighting(self, code: Decoded, width_px: int, now: float) -> Sighting:
        (x0, y0), (x1, y1), (x2, y2), (x3, y3) = code.corners
        left_px, right_px = math.dist((x0, y0), (x3, y3)), math.dist((x1, y1), (x2, y2))
        height_px = max(1.0, (left_px + right_px) / 2)
        focal_px = self._optics.focal_px(width_px)
        away_mm = focal_px * MARKER_SIZE_MM / height_px
        middle_px = (x0 + x1 + x2 + x3) / 4
        width_seen_px = (math.dist((x0, y0), (x1, y1)) + math.dist((x3, y3), (x2, y2))) / 2
        turned_rad = math.acos(min(1.0, width_seen_px / height_px))
        return Sighting(
            code.text,
            now,
            self._shape.camera_ahead_mm + (middle_px - width_px / 2) / focal_px * away_mm,
            self._shape.camera_left_mm + away_mm,
            math.copysign(turned_rad, left_px - right_px),
        )


class MarkerWatch:
    """Looks again and again; a text counts when two of the last three looks agree on it."""

    def __init__(self, camera: Camera, reader: MarkerReader, now: float = 0.0) -> None:
        self._camera, self._reader = camera, reader
        self._looks: deque[frozenset[str]] = deque(maxlen=OUT_OF)
        self._frame_at_s = now

    def tick(self, now: float) -> CameraReport:
        """One look. Without a new frame the report is empty but for the age of the last one."""
        there_is_one, frame = self._camera.read()
        if not there_is_one or frame is None:
            return CameraReport(frame_age_s=now - self._frame_at_s)
        self._frame_at_s = now
        sightings = self._reader.look(frame, now)
        self._looks.append(frozenset(sighting.text for sighting in sightings))
        accepted = [sighting for sighting in sightings if self._agreed(sighting.text)]
        codes = tuple(sighting for sighting in accepted if sighting.text.startswith(HANDOVER_PREFIX))
        posts = tuple(sighting for sighting in accepted if not sighting.text.startswith(HANDOVER_PREFIX))
        return CameraReport(posts, codes)

    def _agreed(self, text: str) -> bool:
        return sum(text in look for look in self._looks) >= AGREE
