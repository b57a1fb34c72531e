"""Attempts, one after the other, to make a silent base speak: a table, and who goes through it.

Start alone; then with pulses on BRC, in case it sleeps; then a stream without packet 35, which some old firmware never
answers; then at 19200 baud; then Reset, which takes the base five seconds. Then again from the pulses on.
"""

from collections import deque
from dataclasses import dataclass

from robot.drivers.create2 import open_interface as oi

SILENT_S = 1.0
"""Without a frame for so long the base is started again; a stream has one every 15 ms."""
DOWN_S = 60.0
"""Without a frame for so long the base counts as gone: people are to be told."""


@dataclass(frozen=True)
class Pulse:
    """A low pulse on BRC."""


@dataclass(frozen=True)
class Start:
    """Start, and ask for this stream."""

    stream: oi.StreamLayout = oi.FULL_STREAM


@dataclass(frozen=True)
class Send:
    """These bytes, with silence after them."""

    data: bytes
    gap_s: float = 0.0


@dataclass(frozen=True)
class Listen:
    """Go on at this speed of the line."""

    baud: int


Act = Pulse | Start | Send | Listen


@dataclass(frozen=True)
class Step:
    """Acts, each so many seconds after the step began, and how long to wait until the next step."""

    name: str
    acts: tuple[tuple[float, Act], ...]
    wait_s: float


START = Step("start", ((0.0, Start()),), 1.0)
WAKE = Step("wake by BRC", ((0.0, Pulse()), (1.1, Start())), 2.1)
START_WITHOUT_MODE = Step("stream without packet 35", ((0.0, Start(oi.WITHOUT_MODE)),), 1.0)
AT_19200 = Step(
    "at 19200 baud",
    (
        (0.0, Listen(oi.SLOW_BAUD)),
        (0.05, Send(oi.FILLING + bytes((oi.Opcode.START,)))),
        (0.15, Send(oi.baud_command())),
        (0.25, Listen(oi.BAUD)),
        (0.4, Start()),
    ),
    1.4,
)
RESET_BYTES = bytes((oi.Opcode.RESET,))
RESET = Step("reset", ((0.0, Send(RESET_BYTES)), (5.0, Start())), 6.0)

WITH_LINE = (START, WAKE, WAKE, WAKE, START_WITHOUT_MODE, AT_19200, RESET)
WITHOUT_LINE = (START, START, START, START, START_WITHOUT_MODE, AT_19200, RESET)


class StartLadder:
    """Climbs while the base is silent; `due` gives the acts whose time has come."""

    def __init__(self) -> None:
        self._rung = 0
        self._acts: deque[tuple[float, Act]] = deque()
        self._next_s = 0.0
        self.step: Step | None = None
        """The step under way; None while the base speaks."""

    def due(self, wired: bool, now: float) -> list[Act]:
        """To be called only while the base is silent."""
        if now >= self._next_s:
            self._begin(WITH_LINE if wired else WITHOUT_LINE, now)
        acts = []
        while self._acts and self._acts[0][0] <= now:
            acts.append(self._acts.popleft()[1])
        return acts

    def _begin(self, ladder: tuple[Step, ...], now: float) -> None:
        self.step = ladder[self._rung]
        self._rung = self._rung + 1 if self._rung + 1 < len(ladder) else 1
        self._acts = deque((now + after_s, act) for after_s, act in self.step.acts)
        self._next_s = now + self.step.wait_s

    def heard(self) -> Step | None:
        """The base speaks: which step did it, if it was silent before."""
        step, self.step = self.step, None
        self._rung, self._next_s = 0, 0.0
        self._acts.clear()
        return step
