"""The words of the Create 2: commands as bytes, sensor packets as fields.

Source: iRobot Create 2 Open Interface Specification, 2016-08-10. Big-endian, two's complement.
"""

import struct
from collections.abc import Sequence
from enum import IntEnum

from robot.drivers.interfaces import Note, WheelSpeeds

BAUD = 115200
SLOW_BAUD = 19200
"""What a base speaks at when Clean was held at power-off, or BRC pulsed low three times."""
HEADER = 19
FILLING = bytes(40)
"""Who died in the middle of a command left the base waiting for its data, for ever. Zeros fill any command that we send
(a drive command becomes a stop) and mean nothing by themselves."""
LONGEST_FILLING = bytes(2 + 2 * 255)
"""As many as the longest command of the base can still be waiting for: a song whose length was no length."""


class Opcode(IntEnum):
    """Only what this driver sends."""

    RESET = 7
    START = 128
    BAUD = 129
    SAFE = 131
    FULL = 132
    LEDS = 139
    SONG = 140
    PLAY = 141
    SEEK_DOCK = 143
    DRIVE_DIRECT = 145
    STREAM = 148


STREAMED: dict[int, tuple[str, str]] = {
    7: ("B", "bumps_and_drops"),
    9: ("B", "cliff_left"),
    10: ("B", "cliff_front_left"),
    11: ("B", "cliff_front_right"),
    12: ("B", "cliff_right"),
    14: ("B", "over_currents"),
    17: ("B", "ir_omni"),
    18: ("B", "buttons"),
    21: ("B", "charging_state"),
    22: ("H", "voltage_mv"),
    23: ("h", "current_ma"),
    24: ("b", "temperature_c"),
    25: ("H", "charge_mah"),
    26: ("H", "capacity_mah"),
    34: ("B", "chargers"),
    35: ("B", "mode"),
    37: ("B", "song_playing"),
    43: ("h", "left_count"),
    44: ("h", "right_count"),
    45: ("B", "light_bumpers"),
    52: ("B", "ir_left"),
    53: ("B", "ir_right"),
    54: ("h", "left_motor_ma"),
    55: ("h", "right_motor_ma"),
    58: ("B", "stasis"),
}
"""The 25 packets asked for: 33 data bytes in a frame of 61, 5.3 ms of every 15."""

LARGEST: dict[str, int] = {
    "bumps_and_drops": 15,
    "cliff_left": 1,
    "cliff_front_left": 1,
    "cliff_front_right": 1,
    "cliff_right": 1,
    "over_currents": 29,
    "charging_state": 6,
    "chargers": 3,
    "song_playing": 1,
    "light_bumpers": 127,
    "stasis": 3,
}
"""The checksum is 8 bits: two bits turned over at the same place cancel out. What no base says is not believed."""


class StreamLayout:
    """Which packets a stream has, compiled: each value stands behind its id."""

    def __init__(self, ids: Sequence[int]) -> None:
        codes = [f"x{STREAMED[packet][0]}" for packet in ids]
        self.ids = tuple(ids)
        self.fields = tuple(STREAMED[packet][1] for packet in ids)
        self.payload = struct.Struct(">" + "".join(codes))
        """Everything between length byte and checksum."""
        self.frame_length = 2 + self.payload.size + 1
        self._id_offsets = [(2 + struct.calcsize(">" + "".join(codes[:i])), packet) for i, packet in enumerate(ids)]
        self._bounded = [(i, LARGEST[name]) for i, name in enumerate(self.fields) if name in LARGEST]

    def command(self) -> bytes:
        """Asks the base for this stream."""
        return bytes((Opcode.STREAM, len(self.ids), *self.ids))

    def read(self, data: bytearray) -> dict[str, int] | None:
        """The values of the frame at the front of `data` by field; None if it is no sound frame of this layout."""
        if sum(data[: self.frame_length]) & 0xFF or any(data[at] != packet for at, packet in self._id_offsets):
            return None
        values = self.payload.unpack_from(data, 2)
        if any(values[i] > largest for i, largest in self._bounded):
            return None
        return dict(zip(self.fields, values, strict=True))


MODE_PACKET = 35
FULL_STREAM = StreamLayout(tuple(STREAMED))
WITHOUT_MODE = StreamLayout([packet for packet in STREAMED if packet != MODE_PACKET])
"""For old firmware that never answers packet 35 (pycreate2 issue 1)."""


def baud_command(code: int = 11) -> bytes:
    """From now on speak at this speed; 11 is 115200."""
    return bytes((Opcode.BAUD, code))


def drive_direct(speeds: WheelSpeeds) -> bytes:
    """Right wheel first; whole mm/s, −500 to 500."""
    return struct.pack(">Bhh", Opcode.DRIVE_DIRECT, round(speeds.right_mm_s), round(speeds.left_mm_s))


def song(notes: tuple[Note, ...], number: int = 0) -> bytes:
    """Store up to 16 notes as song `number`; durations count in 1/64 s."""
    short = notes[:16]
    pairs = (byte for note, duration_s in short for byte in (note & 0x7F, min(255, max(1, round(duration_s * 64)))))
    return bytes((Opcode.SONG, number, len(short), *pairs))


def play(number: int = 0) -> bytes:
    return bytes((Opcode.PLAY, number))


def leds(colour: float, brightness: float) -> bytes:
    """The power light alone: colour 0 green to 1 red."""
    return bytes((Opcode.LEDS, 0, round(255 * colour), round(255 * brightness)))
