"""The serial cable to the base: opened again when it was pulled, written to in order and with the pauses it needs."""

from collections import deque
from collections.abc import Callable

import serial

from robot.core.errors import RobotError
from robot.drivers.create2.link_health import LinkHealth
from robot.drivers.create2.open_interface import BAUD, FILLING
from robot.drivers.create2.serial_port import SerialPort

RETRY_S = 1.0
READ_AT_ONCE = 4096
TIMEOUTS = 3
"""So many writes in a row that time out are a cable that takes nothing."""
Chunk = Callable[[bytes, float], None]
"""Bytes and when they passed."""


def _nobody(_: bytes, __: float) -> None:
    """No listener."""


class Cable:
    """Raises PortAbsent or PortBusy at once if the first opening fails; later it tries again every second."""

    def __init__(self, open_port: Callable[[], SerialPort], lost: Callable[[], None]) -> None:
        """`lost` is called when the port fails."""
        self._open_port, self._lost = open_port, lost
        self.port: SerialPort | None = open_port()
        self._outgoing: deque[tuple[bytes, float]] = deque()
        self._quiet_until_s = 0.0
        self._next_try_s = 0.0
        self._timeouts = 0
        self.heard: Chunk = _nobody
        self.sent: Chunk = _nobody
        self.health = LinkHealth()

    @property
    def is_open(self) -> bool:
        return self.port is not None

    def read(self, now: float) -> bytes:
        """Read the bytes that have arrived; open the port again when it is time to."""
        if self.port is None and not self._reopened(now):
            return b""
        try:
            data = self.port.read(READ_AT_ONCE) if self.port else b""
        except OSError as error:
            self._lose(str(error), now)
            return b""
        if data:
            self.heard(data, now)
        return data

    def send(self, data: bytes, now: float, gap_after_s: float = 0.0) -> None:
        """At once, or behind what still waits. Nothing is kept for a port that is not open."""
        if self.port is not None:
            self._outgoing.append((data, gap_after_s))
            self.flush(now)

    def flush(self, now: float) -> None:
        """Write what is due."""
        while self._outgoing and self.port is not None and now >= self._quiet_until_s:
            data, gap_s = self._outgoing.popleft()
            self._write(data, now)
            self._quiet_until_s = now + gap_s

    def _write(self, data: bytes, now: float) -> None:
        try:
            if self.port is not None:
                # Behind a write that timed out the base may wait for the rest of a command.
                self.port.write(FILLING + data if self._timeouts else data)
                self._timeouts = 0
                self.sent(data, now)
        except serial.SerialTimeoutException as error:
            # It also comes when the processor was taken from us for so long, and all bytes have gone out.
            self._timeouts += 1
            if self._timeouts >= TIMEOUTS:
                self._lose(str(error), now)
        except OSError as error:
            # Half a command may have gone out: the next start fills it up.
            self._lose(str(error), now)

    def speak_at(self, baud: int, now: float) -> None:
        """Change the speed of this end of the line."""
        try:
            if self.port is not None and self.port.baudrate != baud:
                self.port.baudrate = baud
        except OSError as error:
            self._lose(str(error), now)

    def forget(self) -> None:
        """Discard the bytes that still wait to be sent."""
        self._outgoing.clear()

    def close(self, last: bytes, now: float) -> None:
        """For ever, after these last bytes."""
        self._write(last, now)
        if self.port is not None:
            self.port.close()
        self.port = None
        self._next_try_s = float("inf")

    def _reopened(self, now: float) -> bool:
        if now < self._next_try_s:
            return False
        self._next_try_s = now + RETRY_S
        try:
            self.port = self._open_port()
        except (RobotError, OSError) as error:
            self.health.problem = str(error)
            return False
        self.health.problem = None
        self.health.reconnections += 1
        self.speak_at(BAUD, now)
        return True

    def _lose(self, problem: str, now: float) -> None:
        if self.port is not None:
            self.port.close()
        self.port, self._timeouts = None, 0
        self._outgoing.clear()
        self.health.problem = problem
        self._next_try_s = now + RETRY_S
        self._lost()
