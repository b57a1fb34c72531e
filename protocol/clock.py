"""The time that server and robot agree on. Time is an argument everywhere else; here is where it comes from.

A `RealClock` is the machine's. A `SharedClock` lives in a small file that several processes map into memory: one scaled
time for a simulated demonstration, faster than the machine's and slowed down by a process that cannot keep up. It
never jumps and never runs backwards: only its speed changes.
"""

import asyncio
import fcntl
import mmap
import struct
import time
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Protocol

_LAYOUT = struct.Struct(
    "<Qdddd"
)  # writes so far (odd: being written), anchor real s, anchor scaled s, speed, UTC at scaled 0


class Clock(Protocol):
    """Monotonic seconds for durations, UTC for records."""

    def now(self) -> float:
        """Seconds that never run backwards; only differences mean anything."""
        ...

    def utc(self) -> datetime:
        """The time for records."""
        ...

    def real_s(self, duration_s: float) -> float:
        """Return the duration on the machine's clock of `duration_s` on this one, at the present speed."""
        ...


class RealClock:
    """The machine's own time."""

    def now(self) -> float:
        return time.monotonic()

    def utc(self) -> datetime:
        return datetime.now(UTC)

    def real_s(self, duration_s: float) -> float:
        return duration_s


@dataclass
class SteppedClock:
    """Moves only when told to: for tests, and for a world that is stepped."""

    now_s: float = 0.0
    started_at: datetime = datetime(2026, 1, 5, 9, 0, tzinfo=UTC)

    def now(self) -> float:
        return self.now_s

    def utc(self) -> datetime:
        return self.started_at + timedelta(seconds=self.now_s)

    def real_s(self, duration_s: float) -> float:
        return duration_s

    def advance(self, duration_s: float) -> None:
        """Let `duration_s` pass."""
        self.now_s += duration_s


class SharedClock:
    """One scaled time for several processes, kept in a file of 40 bytes."""

    def __init__(self, path: Path) -> None:
        """Join the clock in `path`; FileNotFoundError if it was not made."""
        self._path = path
        with path.open("r+b") as file:
            self._memory = mmap.mmap(file.fileno(), _LAYOUT.size)

    @classmethod
    def create(cls, path: Path, speed: float, starts_at: datetime | None = None) -> "SharedClock":
        """Make a clock that starts at `starts_at`, or the machine's own time, and runs `speed` times as fast."""
        real = time.monotonic()
        utc_s = starts_at.timestamp() if starts_at else time.time()
        path.write_bytes(_LAYOUT.pack(0, real, real, speed, utc_s - real))
        return cls(path)

    def _read(self) -> tuple[float, float, float, float]:
        """The machine's time, ours, our speed, and what ours is since the epoch: all of one moment. A reader that is
        held up between two of them looks again, else it would go on at a speed that is not ours any more."""
        while True:
            before, real, scaled, speed, epoch = _LAYOUT.unpack(self._memory[: _LAYOUT.size])
            present = time.monotonic()
            if before % 2 == 0 and struct.unpack_from("<Q", self._memory)[0] == before:
                return present, scaled + (present - real) * speed, speed, epoch

    def now(self) -> float:
        return self._read()[1]

    def utc(self) -> datetime:
        _, now_s, _, epoch = self._read()
        return datetime.fromtimestamp(epoch + now_s, UTC)

    def real_s(self, duration_s: float) -> float:
        return duration_s / self.speed

    @property
    def speed(self) -> float:
        """Return the seconds that pass in one second of the machine's time."""
        return self._read()[2]

    def set_speed(self, speed: float) -> None:
        """Go on from the present moment at another speed. Several processes may: one after the other."""
        with self._path.open("rb") as file:
            fcntl.flock(file, fcntl.LOCK_EX)  # two that write at once would leave it odd, and every reader waiting
            self._change_speed(speed)

    def _change_speed(self, speed: float) -> None:
        writes, real, scaled, old_speed, epoch = _LAYOUT.unpack(self._memory[: _LAYOUT.size])
        struct.pack_into("<Q", self._memory, 0, writes + 1)
        present = time.monotonic()  # after that: no reader has a later moment at the old speed
        scaled += (present - real) * old_speed
        self._memory[: _LAYOUT.size] = _LAYOUT.pack(writes + 1, present, scaled, speed, epoch)
        struct.pack_into("<Q", self._memory, 0, writes + 2)


async def sleep(clock: Clock, duration_s: float) -> None:
    """Sleep for `duration_s` of `clock`, in short naps so that a change of speed is noticed."""
    until = clock.now() + duration_s
    while (left_s := until - clock.now()) > 0:  # noqa: ASYNC110  # no event tells of a scaled moment
        await asyncio.sleep(min(clock.real_s(left_s), 0.25))
