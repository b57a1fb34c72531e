"""The machine's clock, believed as long as it goes on as it went.

What is done by time cannot always be undone: an order expires, a notice is given up, a name is taken out of a record.
A wall clock may leap (a wrong answer of a time server, a machine that was paused), and may leap back some seconds
later. So it is compared with one that cannot be set, and a leap is believed only after it has lasted; until then time
goes on from before the leap, for everything, and what cannot be undone holds on (`holds_on`). Small steps, as time
servers make them, are followed at once. Sleep of the machine is no leap: both clocks go on through it.

See docs/decisions/0077-a-leap-of-the-clock-has-to-last.md.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Final

import structlog

from protocol.clock import Clock

STEP_S: Final = 10.0
"""So far both may drift apart within RENEWED_AFTER_S, and it is no leap."""
RENEWED_AFTER_S: Final = 60.0
LONGEST_SILENCE: Final = timedelta(hours=1)
"""After a longer one than that between the last record and a start, the clock alone does not say whether it is true."""

_SINCE_BOOT: Final[int | None] = getattr(time, "CLOCK_BOOTTIME", None)

log = structlog.get_logger(__name__)


def since_boot_s() -> float:
    """Seconds that cannot be set, and that go on while the machine sleeps where the system has such a clock."""
    return time.monotonic() if _SINCE_BOOT is None else time.clock_gettime(_SINCE_BOOT)


@dataclass(frozen=True)
class _Leap:
    """The wall clock is `ahead_s` of the steady one since `since_s` of that."""

    ahead_s: float
    since_s: float


class TrustedClock:
    """The machine's own time without its leaps; one that lasts for `settles_s` is believed.

    It sees what it is asked for: the service asks it every second (`app.orders.timer`).
    """

    def __init__(
        self,
        settles_s: float,
        wall: Callable[[], float] = time.time,
        steady: Callable[[], float] = since_boot_s,
    ) -> None:
        self._settles_s, self._wall, self._steady = settles_s, wall, steady
        self._steady_s, self._wall_s = steady(), wall()
        """A moment in which they were believed."""
        self._settled_from_s = self._steady_s
        self._leap: _Leap | None = None

    def now(self) -> float:
        return time.monotonic()

    def real_s(self, duration_s: float) -> float:
        return duration_s

    def utc(self) -> datetime:
        return datetime.fromtimestamp(self._look()[1], UTC)

    @property
    def is_settled(self) -> bool:
        """Tell if the clock goes on as it went, and has for long enough after a start that it may be wrong from."""
        steady_s, _, leapt_s = self._look()
        return not leapt_s and steady_s >= self._settled_from_s

    @property
    def leapt_s(self) -> float:
        """Return how far the machine's clock is ahead of this one (or behind: below 0) by a leap that is not believed
        yet."""
        return self._look()[2]

    def compare_with_records(self, last: datetime | None) -> None:
        """At the start, when there is nothing else to compare with: `last` is the time of the newest record.

        A service that stood still for days and a clock that is days ahead look alike; so it is waited and seen.
        """
        apart = timedelta() if last is None else self.utc() - last
        if not timedelta(seconds=-STEP_S) <= apart <= LONGEST_SILENCE:
            self._settled_from_s = self._steady() + self._settles_s
            known = {"ahead_of_records_s": round(apart.total_seconds()), "holds_on_s": self._settles_s}
            log.warning("clock_not_confirmed_by_records", **known)

    def _look(self) -> tuple[float, float, float]:
        """Steady time, the time that is believed, and how far the machine's is ahead of it by a leap."""
        steady_s, wall_s = self._steady(), self._wall()
        believed_s = self._wall_s + steady_s - self._steady_s
        leapt_s = wall_s - believed_s
        if abs(leapt_s) > STEP_S and not self._has_lasted(steady_s, wall_s - steady_s, leapt_s):
            return steady_s, believed_s, leapt_s
        if self._leap is not None:
            log.warning("clock_leap_is_over", believed=abs(leapt_s) > STEP_S, leapt_s=round(leapt_s))
            self._leap = None
        if abs(leapt_s) > STEP_S or steady_s - self._steady_s > RENEWED_AFTER_S:
            self._steady_s, self._wall_s = steady_s, wall_s
        return steady_s, wall_s, 0.0

    def _has_lasted(self, steady_s: float, ahead_s: float, leapt_s: float) -> bool:
        if self._leap is None or abs(ahead_s - self._leap.ahead_s) > STEP_S:  # it has leapt, or once more
            self._leap = _Leap(ahead_s, steady_s)
            log.warning("clock_has_leapt", leapt_s=round(leapt_s), believed_after_s=self._settles_s)
        return steady_s - self._leap.since_s >= self._settles_s


def holds_on(clock: Clock) -> bool:
    """Tell if nothing irrevocable may be done by this clock now."""
    return isinstance(clock, TrustedClock) and not clock.is_settled
