"""Awake or asleep: five idle minutes send the robot to sleep, a pulse on the BRC pin or the charger wakes it.

Source [S] unless marked [F] (field report) or [A] (assumption).
"""

from . import firmware_text
from .faults import Faults

SLEEP_AFTER_S = 300.0
BRC_PULSE_S = 0.05


class Wakefulness:
    """Its methods give the text that the firmware prints meanwhile."""

    def __init__(self, faults: Faults, now: float) -> None:
        self.asleep = False
        self._faults = faults
        self._idle_since_s = now
        self._slept_at_s = now
        self._brc_low_since_s: float | None = None

    def stir(self, now: float) -> None:
        """Something happened: the five minutes begin again."""
        self._idle_since_s = now

    def is_tired(self, now: float) -> bool:
        return now - self._idle_since_s >= SLEEP_AFTER_S and not self._faults.never_sleeps

    def sleep(self, now: float) -> bytes:
        self.asleep, self._slept_at_s = True, now
        return firmware_text.SLEEP

    def wake(self, cause: str, now: float) -> bytes:
        """Awake, with the interface Off."""
        if not self.asleep:
            return b""
        self.asleep = False
        return firmware_text.wakeup(cause, now - self._slept_at_s)

    def brc(self, low: bool, now: float) -> bytes:
        """The BRC pin. A low pulse of 50 ms or more wakes the robot and restarts its five minutes."""
        if low:
            self._brc_low_since_s = now if self._brc_low_since_s is None else self._brc_low_since_s
            return b""
        since_s, self._brc_low_since_s = self._brc_low_since_s, None
        if since_s is None or now - since_s < BRC_PULSE_S or self._faults.brc_dead:
            return b""
        self.stir(now)
        return self.wake(firmware_text.KEY_WAKEUP, now)
