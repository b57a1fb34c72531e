"""Output on the serial line: packets, and the text that the firmware prints among them."""

from collections import deque
from collections.abc import Iterable

SLOT_S = 0.015
BITS_PER_BYTE = 10


class Transmitter:
    """Bytes wait here until the line takes them: 172 in a slot of 15 ms at 115200 baud, 28 at 19200."""

    def __init__(self) -> None:
        self._out = bytearray()
        self._room = 0
        self._part_of_a_byte = 0.0
        self._printing: deque[tuple[float, bytes]] = deque()

    def say(self, data: bytes) -> None:
        self._out += data

    def frame(self, data: bytes) -> None:
        """A frame of the stream. What does not fit into the slot is lost, so that too long a list gives only noise."""
        self._out += data[: max(0, self._room - len(self._out))]

    def begin_slot(self, baud: int) -> None:
        """Whole bytes only; where a byte takes longer than a slot (300 and 600 baud) its parts are added up."""
        exact = baud / BITS_PER_BYTE * SLOT_S
        if exact < 1:
            exact += self._part_of_a_byte
        self._room = int(exact)
        self._part_of_a_byte = exact - self._room

    def print_later(self, texts: Iterable[tuple[float, bytes]]) -> float:
        """(time, text) each; replaces what was to be printed before. Returns the time of the last."""
        self._printing = deque(texts)
        return self._printing[-1][0]

    def print_due(self, now: float) -> None:
        while self._printing and self._printing[0][0] <= now:
            self.say(self._printing.popleft()[1])

    @property
    def waiting(self) -> bool:
        return bool(self._out) and self._room > 0

    def take(self) -> bytes:
        """The bytes that are on the wire since last asked: what the slot still has room for."""
        data = bytes(self._out[: self._room])
        del self._out[: self._room]
        self._room -= len(data)
        return data
