"""The cable to the base: any pyserial URL, opened so that no write blocks for long and no second program joins in."""

import select
import time
from typing import Any, Protocol

import serial

from robot.core.errors import PortAbsent, PortBusy
from robot.drivers.create2.open_interface import BAUD

WRITE_TIMEOUT_S = 0.05
"""The drive loop writes, and must not wait for a cable that takes nothing."""


class SerialPort(Protocol):
    """The interface of a port that the driver needs. `read` returns what has arrived, at once."""

    baudrate: int

    def read(self, size: int = 1) -> bytes: ...

    def write(self, data: bytes, /) -> int | None: ...

    def close(self) -> None: ...


def open_serial(url: str) -> serial.SerialBase:
    """Raises PortAbsent or PortBusy."""
    try:
        port = serial.serial_for_url(
            url, baudrate=BAUD, timeout=0, write_timeout=WRITE_TIMEOUT_S, exclusive=True, do_not_open=True
        )
        # pyserial pulls RTS on opening, and RTS is BRC: held low it would hold off the base's own buttons.
        port.rts = False
        port.open()
    except (OSError, ValueError) as error:
        if "exclusively lock" in str(error) or getattr(error, "errno", None) == 16:
            raise PortBusy(url) from None
        raise PortAbsent(url, _short(error)) from None
    return port


def wait_for_bytes(port: Any, at_most_s: float) -> None:
    """Until something has arrived, or so long at most. A port without a descriptor is looked at every 5 ms."""
    try:
        select.select([port], [], [], at_most_s)
    except (OSError, ValueError, TypeError):  # closed by now, a URL without descriptor, or no port at all
        time.sleep(min(at_most_s, 0.005))


def _short(error: Exception) -> str:
    """pyserial repeats itself: `[Errno 2] could not open port X: [Errno 2] No such file or directory: 'X'`."""
    return str(error).rsplit("] ", 1)[-1].split(": '", 1)[0]
