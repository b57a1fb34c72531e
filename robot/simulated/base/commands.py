"""The commands of the Open Interface as data: how many bytes each has, and in which modes it acts.

Source: iRobot Create 2 Open Interface Specification, rev. 2016-08-10 ([S] below). Opcodes that are not here, those
removed since the Create 1 (147, 151 to 158) among them, are ignored one byte at a time ([A], an assumption).
"""

from dataclasses import dataclass
from enum import IntEnum


class Mode(IntEnum):
    """Packet 35. Figures of [S]."""

    OFF = 0
    PASSIVE = 1
    SAFE = 2
    FULL = 3


EVERY = frozenset(Mode)
PSF = frozenset((Mode.PASSIVE, Mode.SAFE, Mode.FULL))
SF = frozenset((Mode.SAFE, Mode.FULL))


@dataclass(frozen=True)
class Command:
    """`size` data bytes follow the opcode, and `each` more for every one counted in data byte `counted_in`."""

    name: str
    size: int
    modes: frozenset[Mode]
    counted_in: int | None = None
    each: int = 1

    def missing(self, data: bytes | bytearray) -> int:
        """Return how many data bytes are still to come; the robot waits for them for ever [S]."""
        counted = 0
        if self.counted_in is not None and len(data) > self.counted_in:
            counted = self.each * data[self.counted_in]
        return self.size + counted - len(data)


START = 128
RESET = 7
COMMANDS: dict[int, Command] = {
    RESET: Command("reset", 0, EVERY),
    START: Command("start", 0, EVERY),
    129: Command("baud", 1, PSF),
    130: Command("control", 0, PSF),
    131: Command("safe", 0, PSF),
    132: Command("full", 0, PSF),
    133: Command("power", 0, PSF),
    134: Command("spot", 0, PSF),
    135: Command("clean", 0, PSF),
    136: Command("max", 0, PSF),
    137: Command("drive", 4, SF),
    138: Command("motors", 1, SF),
    139: Command("leds", 3, SF),
    140: Command("song", 2, PSF, counted_in=1, each=2),
    141: Command("play", 1, SF),
    142: Command("sensors", 1, PSF),
    143: Command("seek_dock", 0, PSF),
    144: Command("pwm_motors", 3, SF),
    145: Command("drive_direct", 4, SF),
    146: Command("drive_pwm", 4, SF),
    148: Command("stream", 1, PSF, counted_in=0),
    149: Command("query_list", 1, PSF, counted_in=0),
    150: Command("pause_resume", 1, PSF),
    162: Command("scheduling_leds", 2, SF),
    163: Command("digit_leds_raw", 4, SF),
    164: Command("digit_leds_ascii", 4, SF),
    165: Command("buttons", 1, PSF),
    167: Command("schedule", 15, PSF),
    168: Command("set_day_time", 3, PSF),
    173: Command("stop", 0, PSF),
}

# Code of the Baud command → bits per second [S].
BAUD_CODES = (300, 600, 1200, 2400, 4800, 9600, 14400, 19200, 28800, 38400, 57600, 115200)


class CommandParser:
    """Byte after byte into commands. What is missing is waited for, for ever [S]."""

    def __init__(self) -> None:
        self._pending = bytearray()

    def eat(self, byte: int, mode: Mode) -> tuple[int, bytes] | None:
        """The opcode and the data of a command that is complete now. In Off only Start and Reset mean anything."""
        if not self._pending and (byte not in COMMANDS or (mode is Mode.OFF and byte not in (START, RESET))):
            return None
        self._pending.append(byte)
        opcode, data = self._pending[0], bytes(self._pending[1:])
        if COMMANDS[opcode].missing(data) > 0:
            return None
        self._pending.clear()
        return opcode, data

    def forget(self) -> None:
        self._pending.clear()
