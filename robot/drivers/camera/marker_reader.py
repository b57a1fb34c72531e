"""Markers out of frames: decode with guard, check against the map, and say where the marker is as the robot sees it.

The camera looks to the left, so that right in the picture is ahead of the robot.
"""

from collections import deque
from collections.abc import Iterable, Mapping

from maps.bays import MARKER_SIZE_M
from robot.drivers.camera.april_tags import TagDetector
from robot.drivers.camera.frozen_picture import FrozenPicture
from robot.drivers.camera.marker_pose import Optics, SheetPose, code_pose, tag_pose
from robot.drivers.camera.qr_decoders import Decoded, Decoder, best_decoder, grey_of
from robot.drivers.interfaces import BodyShape, Camera, CameraReport, Fix, Frame, Sighting

HANDOVER_PREFIX = "CM1:"
LONGEST_CODE = 200
"""Characters; what is longer is none of our hand-over codes."""
MARKER_SIZE_MM = MARKER_SIZE_M * 1000
AGREE, OUT_OF = 2, 3
"""Equal reads that accept, of how many looks: a torn code that reads as another post would send the robot astray."""
FIXES_KEPT = 8
POSES_KEPT = 16
"""Before a robot that stands a code has the same few corners again and again, and its place takes longest to find."""


class MarkerReader:
    """Finds markers of known posts, and hand-over codes, in one frame. Everything else is foreign and ignored."""

    def __init__(
        self,
        posts: Iterable[str],
        optics: Optics | None = None,
        shape: BodyShape | None = None,
        decode: Decoder | None = None,
        tags: Mapping[int, str] | None = None,
    ) -> None:
        """With `tags` (number → post, see `maps.tags`) AprilTags are looked for where no code of ours is read."""
        self._posts = frozenset(posts)
        self._optics, self._shape = optics or Optics(), shape or BodyShape()
        self._decode = decode or best_decoder()
        self._tags = TagDetector(tags) if tags else None
        self._poses: dict[Decoded, SheetPose | None] = {}

    def look(self, frame: Frame, now: float) -> tuple[Sighting, ...]:
        """Return the markers in this frame; `text` is a post's name or begins with `CM1:`."""
        grey = grey_of(frame)
        known = [code for code in self._decode(grey) if self._is_known(code.text)]
        if known or self._tags is None:
            return tuple(self._sighting(code, self._pose_of(grey, code), now) for code in known)
        seen = [(tag, tag_pose(grey, tag.corners, self._tags.size_mm, self._optics)) for tag in self._tags.read(grey)]
        return tuple(self._sighting(tag, pose, now) for tag, pose in seen if tag.text in self._posts)

    def _is_known(self, text: str) -> bool:
        return text in self._posts or (text.startswith(HANDOVER_PREFIX) and len(text) <= LONGEST_CODE)

    def _pose_of(self, grey: Frame, code: Decoded) -> SheetPose | None:
        """Of a marker; where a hand-over code is held does not matter."""
        if code.text not in self._posts:
            return None
        if code not in self._poses:
            if len(self._poses) >= POSES_KEPT:
                self._poses.clear()
            self._poses[code] = code_pose(grey, code.text, code.corners, MARKER_SIZE_MM, self._optics)
        return self._poses[code]

    def _sighting(self, code: Decoded, pose: SheetPose | None, now: float) -> Sighting:
        if pose is None:
            return Sighting(code.text, now)
        ahead_mm = self._shape.camera_ahead_mm + pose.right_mm
        left_mm = self._shape.camera_left_mm + pose.away_mm
        # Turned to the left, the robot sees what is on its left from farther ahead: the right edge comes nearer.
        return Sighting(code.text, now, ahead_mm, left_mm, pose.turned_rad, pose.accuracy_mm, pose.accuracy_rad)


class MarkerWatch:
    """Looks again and again; a text counts when two of the last three looks agree on it. A position source."""

    def __init__(self, camera: Camera, reader: MarkerReader, now: float = 0.0) -> None:
        self._camera, self._reader = camera, reader
        self._looks: deque[frozenset[str]] = deque(maxlen=OUT_OF)
        self._fixes: deque[Fix] = deque(maxlen=FIXES_KEPT)
        self._frame_at_s = now
        self._frozen = FrozenPicture()

    def tick(self, now: float) -> CameraReport:
        """One look. Without a new frame, or with the same again, the report holds nothing but its age."""
        there_is_one, frame = self._camera.read()
        if not there_is_one or frame is None:
            return CameraReport(frame_age_s=now - self._frame_at_s)
        self._frame_at_s = now
        if frozen_s := self._frozen.age_s(frame, now):
            return CameraReport(frozen_s=frozen_s)
        sightings = self._reader.look(frame, now)
        self._looks.append(frozenset(sighting.text for sighting in sightings))
        accepted = [sighting for sighting in sightings if self._agreed(sighting.text)]
        codes = tuple(sighting for sighting in accepted if sighting.text.startswith(HANDOVER_PREFIX))
        posts = tuple(sighting for sighting in accepted if not sighting.text.startswith(HANDOVER_PREFIX))
        self._fixes.extend(sighting.fix for sighting in posts)
        return CameraReport(posts, codes)

    def fixes(self, now: float) -> tuple[Fix, ...]:
        """See `interfaces.PositionSource`; may be called from another thread than `tick`."""
        found = []
        while self._fixes:
            found.append(self._fixes.popleft())
        return tuple(found)

    def _agreed(self, text: str) -> bool:
        return sum(text in look for look in self._looks) >= AGREE
