"""The BRC pin: a low pulse wakes the base and resets its five minutes to sleep.

Three pulses of 50 to 500 ms each would switch the base to 19200 baud, so each of ours lasts a second.
"""

from contextlib import suppress
from typing import Any, Protocol

import serial

from robot.drivers.create2.serial_port import open_serial

PULSE_S = 1.0
EVERY_S = 60.0
WITHOUT_LINE_EVERY_S = 240.0


class WakeUpLine(Protocol):
    """The device that is wired to BRC."""

    def low(self, on: bool) -> None:
        """Pull the line low, or let it go."""
        ...

    @property
    def wired(self) -> bool:
        """Return whether a pulse can reach the base, as far as is known."""
        ...


class NoWakeUpLine:
    """Nothing is wired to BRC."""

    wired = False

    def low(self, on: bool) -> None:
        """Nothing happens, and that is known."""


class SerialRts:
    """BRC on RTS, as in the official USB cable. It opens the port itself, since the line belongs to the port."""

    def __init__(self, url: str) -> None:
        self._url = url
        self._port: serial.SerialBase | None = None
        self.wired = True

    def open(self) -> serial.SerialBase:
        """For `Create2`. Raises PortAbsent or PortBusy."""
        self._port = open_serial(self._url)
        return self._port

    def low(self, on: bool) -> None:
        """RTS on is low at the plug. A port without RTS (ENOTTY on a pseudo-terminal) wakes no base, and is known
        to."""
        if self._port is None or not self.wired:
            return
        try:
            self._port.rts = on
        except serial.PortNotOpenError:
            return
        except OSError:
            self.wired = False


class GpioWakeUpLine:
    """BRC on a pin of the computer; `pin` is a gpiozero DigitalOutputDevice whose `on` pulls BRC low."""

    wired = True

    def __init__(self, pin: Any) -> None:
        self._pin = pin

    def low(self, on: bool) -> None:
        with suppress(OSError):
            self._pin.on() if on else self._pin.off()


class KeepAwake:
    """Left alone in Passive the base sleeps after five minutes: pulses on BRC prevent it, or being stirred."""

    def __init__(self, line: WakeUpLine) -> None:
        self._line = line
        self._low_since_s: float | None = None
        self._pulsed_s = self._stirred_s = 0.0

    @property
    def wired(self) -> bool:
        return self._line.wired

    def pulse(self, now: float) -> None:
        """Pull the line low; `step` lets it go."""
        self._low_since_s = self._pulsed_s = now
        self._line.low(True)

    def step(self, idle: bool, docked: bool, now: float) -> bool:
        """Return whether the base is to be stirred with Safe and Passive: nothing is wired, and its sleep is near.

        `idle`: in Passive, and the wheels stand. On the dock nothing is ever sent but pulses: it would end the charge.
        """
        if self._low_since_s is not None and now - self._low_since_s >= PULSE_S:
            self._low_since_s = None
            self._line.low(False)
        if not idle:
            self._pulsed_s = self._stirred_s = now
            return False
        if self._line.wired:
            if self._low_since_s is None and now - self._pulsed_s >= EVERY_S:
                self.pulse(now)
            return False
        if docked or now - self._stirred_s < WITHOUT_LINE_EVERY_S:
            self._stirred_s = now if docked else self._stirred_s
            return False
        self._stirred_s = now
        return True
