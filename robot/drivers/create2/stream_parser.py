"""Frames out of a stream of bytes, and the text that the firmware prints between them.

A frame is 19 | N | (id data…)+ | checksum, the sum of all of it 0 modulo 256. The byte 19 also occurs inside data, so
a frame counts only if length, ids, checksum and the range of each value are right; if not, the search goes on at the
byte *after* the false header, so that one lost byte costs one frame.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

from robot.drivers.create2.open_interface import FULL_STREAM, HEADER, WITHOUT_MODE, StreamLayout

LONGEST_TEXT = 400
_PRINTABLE_TAIL = re.compile(rb"[\t\x20-\x7e]*\Z")


@dataclass
class StreamParser:
    """Feed it bytes as they come; ask it for frames, and for the lines in between."""

    layouts: Sequence[StreamLayout] = (FULL_STREAM, WITHOUT_MODE)
    corrupt: int = 0
    """Candidates with the right length byte whose ids, checksum or values were wrong."""
    lines: list[str] = field(default_factory=list)
    _waiting: bytearray = field(default_factory=bytearray)
    _text: bytearray = field(default_factory=bytearray)

    def __post_init__(self) -> None:
        self._by_length = {layout.frame_length - 3: layout for layout in self.layouts}

    def feed(self, data: bytes) -> list[dict[str, int]]:
        """The complete frames, oldest first, each as its values by the names of `open_interface.STREAMED`."""
        self._waiting += data
        frames = []
        while layout := self._skip_to_header():
            if len(self._waiting) < layout.frame_length:
                break
            values = layout.read(self._waiting)
            if values is None:
                self.corrupt += 1
                self._set_aside(1)
            else:
                frames.append(values)
                del self._waiting[: layout.frame_length]
        return frames

    def take_lines(self) -> list[str]:
        """The text lines since the last call."""
        lines, self.lines = self.lines, []
        return lines

    def take_corrupt(self) -> int:
        """Return how many candidates were wrong since the last call."""
        corrupt, self.corrupt = self.corrupt, 0
        return corrupt

    def _skip_to_header(self) -> StreamLayout | None:
        """The layout that header and length at the front promise; everything before them is text or noise."""
        while self._waiting:
            at = self._waiting.find(HEADER)
            if at < 0:
                self._set_aside(len(self._waiting))
                return None
            if at:
                self._set_aside(at)
            if len(self._waiting) < 2:
                return None
            if layout := self._by_length.get(self._waiting[1]):
                return layout
            self._set_aside(1)
        return None

    def _set_aside(self, count: int) -> None:
        self._text += self._waiting[:count]
        del self._waiting[:count]
        *complete, rest = bytes(self._text).split(b"\n")
        self._text = bytearray(rest[-LONGEST_TEXT:])
        for raw in complete:
            # Noise of a torn frame may stand before the text on the same line.
            found = _PRINTABLE_TAIL.search(raw.rstrip(b"\r"))
            if found and found.group().strip():
                self.lines.append(found.group().decode("ascii").strip())
