"""A black box as lines for a person: frames of the base as what changed in them, commands by their names."""

import struct
from collections.abc import Iterable, Iterator

from robot.drive_loop.black_box import Row
from robot.drivers.create2.open_interface import Opcode
from robot.drivers.create2.stream_parser import StreamParser

RESTLESS = frozenset(
    {"left_count", "right_count", "voltage_mv", "current_ma", "charge_mah", "temperature_c", "stasis", "left_motor_ma"}
    | {"right_motor_ma", "light_bumpers"}
)
"""They change in almost every frame; --raw shows them, as bytes."""


def table(found: Iterable[Row], raw: bool = False) -> Iterator[str]:
    """Seconds before the end, kind, what: one line each. What only says again what was said is left out."""
    rows = list(found)
    end_s = max((row.at_s for row in rows), default=0.0)
    frames, sent = Frames(), ""
    for row in rows:
        what = _raw(row) if raw else _words(row, frames)
        if row.kind == "sent":
            # A speed is sent again ten times a second.
            sent, what = what, "" if what == sent and not raw else what
        if what:
            yield f"{row.at_s - end_s:9.3f} s  {row.kind:10} {what}"


class Frames:
    """Remembers the frame before."""

    def __init__(self) -> None:
        self._parser = StreamParser()
        self._before: dict[str, int] = {}

    def changes(self, data: bytes) -> str:
        """`mode 2, bumps_and_drops 1`: the fields that differ from the frame before, the text of the firmware too."""
        said = []
        for values in self._parser.feed(data):
            new = {name: value for name, value in values.items() if name not in RESTLESS}
            said += [f"{name} {value}" for name, value in new.items() if self._before.get(name) != value]
            self._before |= new
        return ", ".join(said + [repr(line) for line in self._parser.take_lines()])


def _raw(row: Row) -> str:
    return row.data.hex(" ") if isinstance(row.data, bytes) else _plain(row.data)


def _words(row: Row, frames: Frames) -> str:
    if not isinstance(row.data, bytes):
        return _plain(row.data)
    return frames.changes(row.data) if row.kind == "heard" else command(row.data)


def _plain(data: object) -> str:
    return ", ".join(map(str, data)) if isinstance(data, list | tuple) else str(data)


def command(data: bytes) -> str:
    """`drive_direct left 100 right 100`; bytes that we do not send are shown as they are."""
    if len(data) == 5 and data[0] == Opcode.DRIVE_DIRECT:
        right, left = struct.unpack(">hh", data[1:])
        return f"drive_direct left {left} right {right}"
    try:
        name = Opcode(data[0]).name.lower()
    except (ValueError, IndexError):
        return data.hex(" ")
    rest = data[1:].replace(bytes((data[0],)), b"")
    return f"{name} {data[1:].hex(' ')}" if rest else name
