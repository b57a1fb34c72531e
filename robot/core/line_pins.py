"""The three pins of the line sensor as they are, without majority or meaning: for doctor and calibration."""

import time
from collections.abc import Callable, Sequence
from typing import Any

from gpiozero import DigitalInputDevice

from robot.core.config import LineSettings

PIN_NAMES = ("left", "centre", "right")
LOOKS_HZ = 200.0


def open_pins(line: LineSettings, pin_factory: Any) -> tuple[Any, ...]:
    """Left, centre, right; `value` is 1 when the pin is high. The caller that opens them closes them."""
    opened: list[Any] = []
    try:
        for pin in (line.left_pin, line.centre_pin, line.right_pin):
            opened.append(DigitalInputDevice(pin, pull_up=None, active_state=True, pin_factory=pin_factory))
    except BaseException:
        for device in opened:
            device.close()
        raise
    return tuple(opened)


class PinWatch:
    """Counts what the pins do."""

    def __init__(self, devices: Sequence[Any]) -> None:
        self._devices = devices
        self._looks = 0
        self._high = [0, 0, 0]
        self._last: list[int] = []
        self.changes = [0, 0, 0]

    def look(self, for_s: float, enough: Callable[[], bool] = lambda: False) -> None:
        """For so long, or until there is enough."""
        until_s = time.monotonic() + for_s
        while time.monotonic() < until_s and not enough():
            self.take([device.value for device in self._devices])
            time.sleep(1 / LOOKS_HZ)

    def take(self, levels: list[int]) -> None:
        """One look."""
        for i, level in enumerate(levels):
            self._high[i] += level
            self.changes[i] += bool(self._last) and level != self._last[i]
        self._last, self._looks = levels, self._looks + 1

    @property
    def high_shares(self) -> list[float]:
        """Of the looks, each pin for itself."""
        return [high / self._looks if self._looks else 0.0 for high in self._high]
