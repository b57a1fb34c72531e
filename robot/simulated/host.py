"""The computer that a simulated robot thinks with: it is well until a switch says otherwise."""

from protocol.clock import Clock
from robot.simulated.faults import Faults

JUMP_S = 3600.0
FREE_MB, FULL_MB = 20_000.0, 5.0


class SimulatedHost:
    """Behind the same door as the real one; see `robot.ops.host`."""

    def __init__(self, faults: Faults, clock: Clock) -> None:
        self._faults, self._clock = faults, clock

    def under_voltage(self) -> bool:
        return self._faults.under_voltage

    def clock_ahead_s(self) -> float:
        jump_s = JUMP_S if self._faults.clock_jump else 0.0
        return self._clock.utc().timestamp() - self._clock.now() + jump_s

    def disk_free_mb(self) -> float:
        return FULL_MB if self._faults.disk_full else FREE_MB
