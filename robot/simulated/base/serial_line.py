"""The cable between the host and the byte machine: a pseudo-terminal for real pyserial, or memory for stepped tests.

Neither ever blocks the world: what the host does not read is lost when the buffer is full, as on a UART. Unplugging
closes the robot's end: pyserial then fails as it does for a pulled USB cable.
"""

import contextlib
import errno
import os
import pty
import select
import termios
import threading
import tty
from pathlib import Path
from random import Random
from typing import Protocol

import serial

from robot.simulated.faults import Faults

BUFFER_BYTES = 4096  # what the operating system keeps for a reader that is late
CHUNK = 4096
TERMIOS_SPEED = 5  # index of the output speed in tcgetattr's answer
SPEEDS = {
    getattr(termios, f"B{baud}"): baud for baud in (300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200)
}


class SerialLine(Protocol):
    """The robot's end of the cable."""

    def receive(self, baud: int) -> bytes:
        """Return what the host has sent since last asked; noise if its speed is not `baud`."""
        ...

    def send(self, data: bytes, baud: int) -> None:
        """To the host, as far as it reads."""
        ...

    def close(self) -> None:
        """Pull the plug."""
        ...

    def plug_in(self) -> None:
        """Put it in again: the host meets a new port, as after a pulled USB cable."""
        ...


class PtyLine:
    """A pseudo-terminal; the host opens `path` with pyserial. `link` is an optional stable name for it."""

    def __init__(self, random: Random, link: Path | None = None) -> None:
        self._random = random
        self._link = link
        self._open = False
        # Others pull the cable while the world's thread talks: it must not write to a descriptor that is closed by
        # then, or is another file's.
        self._in_use = threading.Lock()
        self.plug_in()

    def plug_in(self) -> None:
        with self._in_use:
            if not self._open:
                self._plug_in()

    def _plug_in(self) -> None:
        self._open = True
        self._master, self._slave = pty.openpty()
        tty.setraw(self._slave)
        _set_speed(self._slave, termios.B115200)
        os.set_blocking(self._master, False)
        self.path = os.ttyname(self._slave)
        if self._link:
            if self._link.is_symlink():  # of a world that was killed; any other file is not ours
                self._link.unlink()
            self._link.symlink_to(self.path)

    def wait(self, at_most_s: float) -> None:
        """Until the host has sent something, or so long at most."""
        if self._open:
            select.select([self._master], [], [], at_most_s)

    def receive(self, baud: int) -> bytes:
        with self._in_use, contextlib.suppress(BlockingIOError):
            if self._open:
                data = os.read(self._master, CHUNK)
                return data if self._same_speed(baud) else garbled(data, self._random)
        return b""

    def send(self, data: bytes, baud: int) -> None:
        with self._in_use, contextlib.suppress(BlockingIOError):
            if self._open:
                os.write(self._master, data if self._same_speed(baud) else garbled(data, self._random))

    def _same_speed(self, baud: int) -> bool:
        return SPEEDS.get(termios.tcgetattr(self._master)[TERMIOS_SPEED]) == baud

    def close(self) -> None:
        with self._in_use:
            if self._open:
                self._close()

    def _close(self) -> None:
        self._open = False
        os.close(self._master)
        os.close(self._slave)
        if self._link:
            self._link.unlink(missing_ok=True)


def _set_speed(descriptor: int, speed: int) -> None:
    settings = termios.tcgetattr(descriptor)
    settings[4] = settings[5] = speed
    termios.tcsetattr(descriptor, termios.TCSANOW, settings)


def garbled(data: bytes, random: Random) -> bytes:
    """Return the bytes that arrive when the two ends run at different speeds."""
    return random.randbytes(len(data))


class MemoryLine:
    """The cable without a pseudo-terminal: `port` is what the host holds."""

    def __init__(self, random: Random) -> None:
        self.port = MemoryPort()
        self._random = random

    def receive(self, baud: int) -> bytes:
        data = bytes(self.port.sent)
        self.port.sent.clear()
        return data if self.port.baudrate == baud else garbled(data, self._random)

    def send(self, data: bytes, baud: int) -> None:
        room = BUFFER_BYTES - len(self.port.received)
        self.port.received += (data if self.port.baudrate == baud else garbled(data, self._random))[:room]

    def close(self) -> None:
        self.port.unplugged = True

    def plug_in(self) -> None:
        if self.port.unplugged:
            self.port = MemoryPort()


class MemoryPort:
    """The part of pyserial's `Serial` that a driver needs, for stepped time: a read never waits.

    After an unplug it fails as pyserial on a real port does; RTS and DTR fail as they do on a pseudo-terminal.
    """

    def __init__(self) -> None:
        self.port = "memory"
        self.baudrate = 115200
        self.timeout: float | None = 0.0
        self.is_open = True
        self.unplugged = False
        self.sent = bytearray()
        self.received = bytearray()

    @property
    def in_waiting(self) -> int:
        self._check()
        if self.unplugged:
            raise OSError(errno.EIO, "Input/output error")
        return len(self.received)

    def read(self, size: int = 1) -> bytes:
        """At most `size` bytes, fewer when fewer have come."""
        self._check()
        if self.unplugged:
            raise serial.SerialException("device reports readiness to read but returned no data (device disconnected?)")
        data = bytes(self.received[:size])
        del self.received[:size]
        return data

    def write(self, data: bytes) -> int:
        self._check()
        if self.unplugged:
            raise serial.SerialException("write failed: [Errno 5] Input/output error")
        self.sent += data
        return len(data)

    def flush(self) -> None:
        self._check()

    def reset_input_buffer(self) -> None:
        self._check()
        self.received.clear()

    def reset_output_buffer(self) -> None:
        self._check()

    def close(self) -> None:
        self.is_open = False

    @property
    def rts(self) -> bool:
        return True

    @rts.setter
    def rts(self, _: bool) -> None:
        raise OSError(errno.ENOTTY, "Inappropriate ioctl for device")

    def _check(self) -> None:
        if not self.is_open:
            raise serial.PortNotOpenError


def spoiled(data: bytes, faults: Faults, random: Random) -> bytes:
    """The same bytes with some lost and some bits turned over."""
    if not faults.drop_byte and not faults.flip_byte:
        return data
    kept = bytearray()
    for byte in data:
        if random.random() < faults.drop_byte:
            continue
        kept.append(byte ^ (1 << random.randrange(8)) if random.random() < faults.flip_byte else byte)
    return bytes(kept)


def thinned(data: bytes, faults: Faults, random: Random) -> bytes:
    """Return the bytes that reach the robot: some are lost."""
    if not faults.drop_sent_byte:
        return data
    return bytes(byte for byte in data if random.random() >= faults.drop_sent_byte)
