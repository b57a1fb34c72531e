"""What leaves the robot on its serial line: packets, and the text that the firmware prints among them."""

from collections import deque
from collections.abc import Iterable

SLOT_BYTES = 172
"""What 115200 baud carries in one slot of 15 ms."""


class Transmitter:
    """Bytes wait here until the line takes them."""

    def __init__(self) -> None:
        self._out = bytearray()
        self._printing: deque[tuple[float, bytes]] = deque()

    def say(self, data: bytes) -> None:
        self._out += data

    def frame(self, data: bytes) -> None:
        """A frame of the stream. What does not fit into its slot is lost, so that too long a list gives only noise."""
        self._out += data[:SLOT_BYTES]

    def print_later(self, texts: Iterable[tuple[float, bytes]]) -> float:
        """(time, text) each; replaces what was to be printed before. Returns the time of the last."""
        self._printing = deque(texts)
        return self._printing[-1][0]

    def print_due(self, now: float) -> None:
        while self._printing and self._printing[0][0] <= now:
            self.say(self._printing.popleft()[1])

    @property
    def waiting(self) -> bool:
        return bool(self._out)

    def take(self) -> bytes:
        """The bytes that are on the wire since last asked."""
        data = bytes(self._out)
        self._out.clear()
        return data
