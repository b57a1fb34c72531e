"""Switches of the byte machine that begin at a moment and last: frozen, mute on the dock, a slow line."""

from robot.simulated.faults import Faults

FAST_BAUD, SLOW_BAUD = 115200, 19200
MUTE_AFTER_S = 30.0


class Quirks:
    """`tick` once in each slot."""

    def __init__(self, faults: Faults, now: float) -> None:
        self._faults = faults
        self._frozen_until_s = now
        self._docked_since_s: float | None = None
        self._slow_line = False
        self.mute = False

    def is_frozen(self, now: float) -> bool:
        return self._faults.frozen or now < self._frozen_until_s

    def tick(self, now: float, on_charger: bool) -> int | None:
        """The speed that the line is set to now, if it changes."""
        faults = self._faults
        if faults.freeze_s:
            self._frozen_until_s, faults.freeze_s = now + faults.freeze_s, 0.0
        if not on_charger:
            self._docked_since_s = None
        elif self._docked_since_s is None:
            self._docked_since_s = now
        self.mute = self.mute or self._is_mute_now(now)
        if faults.slow_line is self._slow_line:
            return None
        self._slow_line = faults.slow_line
        return SLOW_BAUD if faults.slow_line else FAST_BAUD

    def _is_mute_now(self, now: float) -> bool:
        since_s = self._docked_since_s
        return self._faults.dock_mute and since_s is not None and now - since_s >= MUTE_AFTER_S

    def reset(self) -> None:
        self.mute, self._docked_since_s = False, None
