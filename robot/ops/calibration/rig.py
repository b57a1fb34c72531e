"""A robot on the bench: wheels that turn for as long as they are told, and encoders that are counted meanwhile."""

from collections.abc import Callable
from dataclasses import dataclass

from robot.core.errors import RobotError
from robot.drivers.create2.odometry import counts_between
from robot.drivers.interfaces import STOP, Base, BaseState, Mode, WheelSpeeds

TICK_S = 0.01
AWAKE_WITHIN_S = 5.0
STANDS_AFTER_S = 0.6
"""Ten time constants of the wheels."""


class CalibrationFailed(RobotError):
    """The measurement cannot be made, or is worth nothing: what was seen, and what to do."""


@dataclass(frozen=True)
class Counts:
    """Counts of both encoders since the rig was made; forwards is positive."""

    left: int = 0
    right: int = 0

    @property
    def ahead(self) -> float:
        return (self.left + self.right) / 2

    @property
    def turned(self) -> int:
        """To the left is positive."""
        return self.right - self.left


class Rig:
    """`let_pass(seconds)` waits or steps a simulated world, and says what time it is then.

    Stops for a touch, a drop, a cliff: the technician stands beside it and may forget a foot in the way.
    """

    def __init__(self, base: Base, let_pass: Callable[[float], float]) -> None:
        self._base, self._let_pass = base, let_pass
        self._last: BaseState | None = None
        self.counts = Counts()

    def wake(self) -> None:
        """In Safe mode, and heard. Raises CalibrationFailed."""
        self.run(STOP, lambda: self._last is not None, AWAKE_WITHIN_S, "The base says nothing: is it switched on?")
        self._base.set_mode(Mode.SAFE, self._let_pass(0.0))
        self.run(STOP, self._is_safe, AWAKE_WITHIN_S, "The base does not go to Safe mode: take it off its dock.")

    def _is_safe(self) -> bool:
        return self._last is not None and self._last.mode in {Mode.SAFE, Mode.UNKNOWN}

    def run(self, speeds: WheelSpeeds, enough: Callable[[], bool], limit_s: float, otherwise: str) -> None:
        """Drive until `enough`, then stand. Raises CalibrationFailed: `otherwise` past the limit, or stopped."""
        until_s = self._let_pass(0.0) + limit_s
        try:
            while not enough():
                now = self._tick(speeds)
                if now > until_s:
                    raise CalibrationFailed(otherwise)
        finally:
            self.stand()

    def stand(self) -> None:
        """Until the wheels have come to rest; what they still count belongs to the run."""
        until_s = self._let_pass(0.0) + STANDS_AFTER_S
        while self._tick(STOP, safely=False) < until_s:
            pass

    def _tick(self, speeds: WheelSpeeds, safely: bool = True) -> float:
        now = self._let_pass(TICK_S)
        state = self._base.poll(now)
        if state is not None:
            self._count(state)
            if safely and not speeds.still:
                _check(state)
        self._base.drive(speeds, now)
        return now

    def _count(self, state: BaseState) -> None:
        old, self._last = self._last or state, state
        left = counts_between(old.left_count, state.left_count)
        right = counts_between(old.right_count, state.right_count)
        self.counts = Counts(self.counts.left + left, self.counts.right + right)


def _check(state: BaseState) -> None:
    for touched, what in ((state.bump, "it touched something"), (state.wheel_drop, "a wheel hung in the air")):
        if touched:
            raise CalibrationFailed(f"Stopped: {what}. Make room, and begin again.")
    if state.cliff:
        raise CalibrationFailed("Stopped: it stands before a drop. Begin again elsewhere.")
