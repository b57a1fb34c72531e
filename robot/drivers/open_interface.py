"""The words of the Create 2: commands as bytes, sensor packets as fields.

Source: iRobot Create 2 Open Interface Specification, 2016-08-10. Big-endian, two's complement.
"""

import struct
from enum import IntEnum

from .interfaces import Note, WheelSpeeds

BAUD = 115200
FRAME_PERIOD_S = 0.015
HEADER = 19
MAX_WHEEL_MM_S = 500


class Opcode(IntEnum):
    """Only what this driver sends."""

    RESET = 7
    START = 128
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

IDS = tuple(STREAMED)
FIELDS = tuple(name for _, name in STREAMED.values())
PAYLOAD = struct.Struct(">" + "".join(f"x{kind}" for kind, _ in STREAMED.values()))
"""Everything between length byte and checksum: each value behind its id."""
ID_OFFSETS = tuple(
    (struct.calcsize(">" + "".join(f"x{STREAMED[before][0]}" for before in IDS[:i])), packet)
    for i, packet in enumerate(IDS)
)
FRAME_LENGTH = 2 + PAYLOAD.size + 1


def start_stream() -> bytes:
    return bytes((Opcode.STREAM, len(IDS), *IDS))


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
