"""The cable to the base: any pyserial URL, opened so that no write blocks for long and no second program joins in."""

from contextlib import suppress
from typing import Protocol

import serial

from ..errors import PortAbsent, PortBusy
from .open_interface import BAUD

WRITE_TIMEOUT_S = 0.2


class SerialPort(Protocol):
    """What the driver needs of a port. `read` returns what has arrived, at once."""

    def read(self, size: int = 1) -> bytes: ...

    def write(self, data: bytes, /) -> int | None: ...

    def close(self) -> None: ...


class WakeUpLine(Protocol):
    """The BRC pin: the end of a low pulse of 50 ms or more wakes the base and resets its five minutes to sleep."""

    def low(self, on: bool) -> None: ...


class NoWakeUpLine:
    """Nothing is wired to BRC (or the port has no RTS, as a pseudo-terminal)."""

    def low(self, on: bool) -> None:
        """Nothing happens, and that is known."""


class RtsWakeUpLine:
    """BRC on RTS, as in the official USB cable."""

    def __init__(self, port: serial.SerialBase) -> None:
        self._port = port

    def low(self, on: bool) -> None:
        """Pull the line low, or let it go. A port without RTS (ENOTTY on a pseudo-terminal) wakes nobody."""
        with suppress(OSError):
            self._port.rts = on


def open_serial(url: str) -> serial.SerialBase:
    """Raises PortAbsent or PortBusy."""
    try:
        return serial.serial_for_url(url, baudrate=BAUD, timeout=0, write_timeout=WRITE_TIMEOUT_S, exclusive=True)
    except (OSError, ValueError) as error:
        if "exclusively lock" in str(error) or getattr(error, "errno", None) == 16:
            raise PortBusy(url) from None
        raise PortAbsent(url, _short(error)) from None


def _short(error: Exception) -> str:
    """pyserial repeats itself: `[Errno 2] could not open port X: [Errno 2] No such file or directory: 'X'`."""
    return str(error).rsplit("] ", 1)[-1].split(": '", 1)[0]
