"""The serial cable to the base: opened again when it was pulled, written to in order and with the pauses it needs."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from ..errors import RobotError
from .serial_port import SerialPort
from .stream_parser import BatteryText

RETRY_S = 1.0
READ_AT_ONCE = 4096


@dataclass
class LinkHealth:
    """What a maintainer asks about the cable."""

    frames: int = 0
    starts: int = 0
    reconnections: int = 0
    problem: str | None = None
    """Why the port cannot be used now."""
    battery_text: BatteryText | None = None
    firmware_lines: tuple[str, ...] = ()
    """The last few lines that the firmware printed."""


class Cable:
    """Raises PortAbsent or PortBusy at once if the first opening fails; later it tries again every second."""

    def __init__(self, open_port: Callable[[], SerialPort], lost: Callable[[], None]) -> None:
        """`lost` is called when the port fails."""
        self._open_port, self._lost = open_port, lost
        self._port: SerialPort | None = open_port()
        self._outgoing: deque[tuple[bytes, float]] = deque()
        self._quiet_until_s = 0.0
        self._next_try_s = 0.0
        self.health = LinkHealth()

    @property
    def is_open(self) -> bool:
        return self._port is not None

    def read(self, now: float) -> bytes:
        """What has arrived; opens the port again when it is time to."""
        if self._port is None and not self._reopened(now):
            return b""
        try:
            return self._port.read(READ_AT_ONCE) if self._port else b""
        except OSError as error:
            self._lose(str(error), now)
            return b""

    def send(self, data: bytes, now: float, gap_after_s: float = 0.0) -> None:
        """At once, or behind what still waits. Nothing is kept for a port that is not open."""
        if self._port is not None:
            self._outgoing.append((data, gap_after_s))
            self.flush(now)

    def flush(self, now: float) -> None:
        """Write what is due."""
        while self._outgoing and self._port is not None and now >= self._quiet_until_s:
            data, gap_s = self._outgoing.popleft()
            try:
                self._port.write(data)
            except OSError as error:
                self._lose(str(error), now)
            self._quiet_until_s = now + gap_s

    def forget(self) -> None:
        """What still waits is not sent any more."""
        self._outgoing.clear()

    def close(self, last: bytes) -> None:
        """For ever, after these last bytes."""
        if self._port is None:
            return
        try:
            self._port.write(last)
            self._port.close()
        except OSError:
            # Unplugged at the very end: nothing is left to be told.
            pass
        self._port = None

    def _reopened(self, now: float) -> bool:
        if now < self._next_try_s:
            return False
        self._next_try_s = now + RETRY_S
        try:
            self._port = self._open_port()
        except (RobotError, OSError) as error:
            self.health.problem = str(error)
            return False
        self.health.problem = None
        self.health.reconnections += 1
        return True

    def _lose(self, problem: str, now: float) -> None:
        if self._port is not None:
            self._port.close()
        self._port = None
        self._outgoing.clear()
        self.health.problem = problem
        self._next_try_s = now + RETRY_S
        self._lost()
