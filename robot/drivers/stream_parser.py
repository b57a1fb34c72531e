"""Frames out of a stream of bytes, and the text that the firmware prints between them.

A frame is 19 | N | (id data…)+ | checksum, the sum of all of it 0 modulo 256. The byte 19 also occurs inside data, so
a frame counts only if length, ids and checksum are right; if not, the search goes on at the byte *after* the false
header, so that one lost byte costs one frame.
"""

import re
from dataclasses import dataclass, field
from typing import Any

from .open_interface import FRAME_LENGTH, HEADER, ID_OFFSETS, PAYLOAD

LONGEST_TEXT = 400
_PRINTABLE_TAIL = re.compile(rb"[\t\x20-\x7e]*\Z")
_BATTERY = re.compile(r"^bat:\s.*\bmV (?P<mv>-?\d+)\s+mA (?P<ma>-?\d+)\b.*\bmAH (?P<mah>\d+)\b")


@dataclass(frozen=True, slots=True)
class BatteryText:
    """What a `bat:` line says, printed every second while the base charges and the interface is off."""

    voltage_mv: int
    current_ma: int
    charge_mah: int


@dataclass
class StreamParser:
    """Feed it bytes as they come; ask it for frames, and for the lines in between."""

    corrupt: int = 0
    """Candidates with the right length byte whose ids or checksum were wrong."""
    lines: list[str] = field(default_factory=list)
    _waiting: bytearray = field(default_factory=bytearray)
    _text: bytearray = field(default_factory=bytearray)

    def feed(self, data: bytes) -> list[tuple[Any, ...]]:
        """The complete frames, oldest first, each as its values in the order of `open_interface.FIELDS`."""
        self._waiting += data
        frames = []
        while self._skip_to_header():
            if len(self._waiting) < FRAME_LENGTH:
                break
            if self._is_frame():
                frames.append(PAYLOAD.unpack_from(self._waiting, 2))
                del self._waiting[:FRAME_LENGTH]
            else:
                self.corrupt += 1
                self._set_aside(1)
        return frames

    def take_lines(self) -> list[str]:
        """The text lines since the last call."""
        lines, self.lines = self.lines, []
        return lines

    def _skip_to_header(self) -> bool:
        """Whether a header stands at the front; everything before it is text or noise."""
        while self._waiting:
            at = self._waiting.find(HEADER)
            if at < 0:
                self._set_aside(len(self._waiting))
                return False
            if at:
                self._set_aside(at)
            if len(self._waiting) < 2 or self._waiting[1] == FRAME_LENGTH - 3:
                return True
            self._set_aside(1)
        return False

    def _is_frame(self) -> bool:
        waiting = self._waiting
        return sum(waiting[:FRAME_LENGTH]) & 0xFF == 0 and all(waiting[2 + at] == packet for at, packet in ID_OFFSETS)

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


def battery_text(line: str) -> BatteryText | None:
    """The figures of a `bat:` line, None for any other."""
    found = _BATTERY.match(line)
    return BatteryText(int(found["mv"]), int(found["ma"]), int(found["mah"])) if found else None
