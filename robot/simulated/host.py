"""The computer that a simulated robot thinks with: it is well until a switch says otherwise."""

from collections.abc import Callable
from datetime import datetime

from .faults import Faults

JUMP_S = 3600.0
FREE_MB, FULL_MB = 20_000.0, 5.0


class SimulatedHost:
    """Behind the same door as the real one; see `robot.host`."""

    def __init__(self, faults: Faults, utc: Callable[[], datetime]) -> None:
        self._faults, self._utc = faults, utc

    def under_voltage(self) -> bool:
        return self._faults.under_voltage

    def utc_s(self) -> float:
        return self._utc().timestamp() + (JUMP_S if self._faults.clock_jump else 0.0)

    def disk_free_mb(self) -> float:
        return FULL_MB if self._faults.disk_full else FREE_MB
