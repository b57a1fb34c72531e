"""Stopping the base when no daemon does: bytes straight into the port, past the process that holds it.

A daemon that hangs still holds its lock on the port, and the base drives on, since drive commands latch. So this opens
the device itself, without asking for the lock. `deploy/stop-base` sends the same bytes from a shell.
"""

import os
import termios
import tty

from robot.core.errors import PortAbsent
from robot.drivers.create2.open_interface import Opcode, drive_direct
from robot.drivers.interfaces import STOP

OUR_LONGEST_COMMAND = len(drive_direct(STOP))
STOP_BYTES = drive_direct(STOP) * 2 + bytes((Opcode.START,)) * OUR_LONGEST_COMMAND
"""Twice stop: the first may be eaten by a command that was left half said. Then Passive, in which it may charge; often
enough to be heard behind any half command."""


def stop_base(port: str) -> None:
    """Raises PortAbsent when there is no such device, or when it takes no bytes."""
    try:
        handle = os.open(port, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        try:
            _set_up(handle)
            os.write(handle, STOP_BYTES)
            termios.tcdrain(handle)
        finally:
            os.close(handle)
    except (OSError, termios.error) as error:
        raise PortAbsent(port, str(getattr(error, "strerror", None) or error)) from None


def _set_up(handle: int) -> None:
    """115,200 baud, no translation of bytes."""
    tty.setraw(handle, termios.TCSANOW)
    attributes = termios.tcgetattr(handle)
    attributes[4] = attributes[5] = termios.B115200
    termios.tcsetattr(handle, termios.TCSANOW, attributes)
