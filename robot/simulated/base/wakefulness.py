"""Awake or asleep: five idle minutes send the robot to sleep, a pulse on the BRC pin or the charger wakes it.

Source [S] unless marked [F] (field report) or [A] (assumption).
"""

from robot.simulated.base import firmware_text
from robot.simulated.faults import Faults

SLEEP_AFTER_S = 300.0
BRC_PULSE_S = 0.05
SHORT_PULSE_S = 0.5
PULSES_TO_19200 = 3
BETWEEN_PULSES_S = 2.0  # [A]


class Wakefulness:
    """Its methods give the text that the firmware prints meanwhile."""

    def __init__(self, faults: Faults, now: float) -> None:
        self.asleep = False
        self._faults = faults
        self._idle_since_s = now
        self._slept_at_s = now
        self._brc_low_since_s: float | None = None
        self._short_pulses: list[float] = []

    def stir(self, now: float) -> None:
        """Something happened: the five minutes begin again."""
        self._idle_since_s = now

    def is_tired(self, now: float) -> bool:
        after_s = self._faults.sleep_after_s or SLEEP_AFTER_S
        return now - self._idle_since_s >= after_s and not self._faults.never_sleeps

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
        self._count(now - since_s, now)
        if not (self._faults.brc_only_wakes and not self.asleep):
            self.stir(now)
        return self.wake(firmware_text.KEY_WAKEUP, now)

    def _count(self, length_s: float, now: float) -> None:
        recent = [at_s for at_s in self._short_pulses if now - at_s < BETWEEN_PULSES_S]
        self._short_pulses = [*recent, now] if length_s <= SHORT_PULSE_S else []

    def wants_19200(self) -> bool:
        """Three short pulses in a row ask for the slow line."""
        if len(self._short_pulses) < PULSES_TO_19200:
            return False
        self._short_pulses = []
        return True
