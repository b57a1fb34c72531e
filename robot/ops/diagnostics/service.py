"""Live diagnostics of the mind: at most twice a second, between two of its cycles, never in its way.

Without a watcher, a tick of the mind costs one comparison and the agent has no listener. With one, each
tick may add lines to a bounded list; twice a second they become one report, which the link takes when it has sent the
one before. A slow link makes reports rarer, and the oldest lines are dropped; what was dropped is counted.
"""

import time
from collections import deque
from collections.abc import Callable, Mapping
from datetime import datetime
from itertools import islice
from typing import Final, Protocol

from bdi import TraceEntry
from protocol.diagnostics import MAX_DIAGNOSTICS_BYTES, Diagnostics, IntentionReport, LeftOut, TraceLine
from robot.agent.mind import Mind
from robot.ops.diagnostics.senses import sensors, timings
from robot.ops.diagnostics.thoughts import intention_told, line_told, short
from robot.ops.runners import Lag

EVERY_S: Final = 0.5
"""Machine's time: a network does not get faster with a simulated clock."""
LOOPS_EVERY: Final = 10
"""Insights: the loops' punctuality is told with each tenth."""
MOST_LINES: Final = 150
MOST_BELIEFS: Final = 400
MOST_INTENTIONS: Final = 20
MOST_EVENTS: Final = 20


class Outlet(Protocol):
    """The link, as far as diagnostics are concerned."""

    def has_room_for_diagnostics(self) -> bool:
        """Return whether it is online and has sent the one before."""
        ...

    def tell_diagnostics(self, diagnostics: Callable[[], Diagnostics]) -> None:
        """Sent when its turn comes; `diagnostics` is called in the link's thread."""
        ...


class DiagnosticsReporter:
    """`watch` may be called by any thread; `look` is called after each tick of the mind, by the mind's own."""

    def __init__(
        self,
        mind: Mind,
        outlet: Outlet,
        lags: Mapping[str, Lag],
        utc: Callable[[], datetime],
        stopwatch: Callable[[], float] = time.monotonic,
    ) -> None:
        """`stopwatch`: seconds of the machine, since no person watches faster because a simulated clock runs faster."""
        self._mind, self._outlet, self._lags = mind, outlet, lags
        self._utc, self._stopwatch = utc, stopwatch
        self._until_s = 0.0
        self._whole = False
        self._is_watched = False
        self._next_s = 0.0
        self._number = 0
        self._lines: deque[TraceLine] = deque(maxlen=MOST_LINES)
        self._dropped = 0
        self._beliefs: dict[str, None] = {}

    def watch(self, for_s: float, whole: bool) -> None:
        """Collect reports for a watcher, for so long."""
        self._whole = self._whole or whole
        self._until_s = self._stopwatch() + for_s

    def look(self, _: float) -> None:
        """Between two ticks of the mind."""
        if not self._until_s:
            return
        now_s = self._stopwatch()
        if now_s > self._until_s:
            self._end()
        elif not self._is_watched:
            self._begin()
        elif now_s >= self._next_s and self._outlet.has_room_for_diagnostics():
            self._next_s = now_s + EVERY_S
            self._tell()

    def _begin(self) -> None:
        self._is_watched, self._whole = True, True
        self._mind.agent.listen(self._hear, explain=True)

    def _end(self) -> None:
        self._until_s, self._is_watched = 0.0, False
        self._mind.agent.stop_listening(self._hear)
        self._lines.clear()
        self._dropped = 0

    def _hear(self, entry: TraceEntry) -> None:
        self._dropped += len(self._lines) == MOST_LINES
        self._lines.append(line_told(entry))

    def _tell(self) -> None:
        whole, self._whole = self._whole, False
        self._number = 1 if whole else self._number + 1
        came, went, unseen = self._changes(whole)
        agent = self._mind.agent
        intentions = [intention_told(agent, one) for one in islice(agent.intentions.values(), MOST_INTENTIONS)]
        diagnostics = Diagnostics(
            number=self._number,
            at=self._utc(),
            cycle=agent.cycles,
            whole=whole,
            sensors=sensors(self._mind.hands.body.view),
            intentions=tuple(intentions),
            events=tuple(short(str(event)) for event in islice(agent.events, MOST_EVENTS)),
            came=came,
            went=went,
            trace=tuple(self._lines),
            left_out=LeftOut(
                beliefs=unseen, trace=self._dropped, intentions=max(0, len(agent.intentions) - MOST_INTENTIONS)
            ),
        )
        self._lines.clear()
        self._dropped = 0
        self._outlet.tell_diagnostics(lambda: within_bounds(self._with_loops(diagnostics)))

    def _with_loops(self, diagnostics: Diagnostics) -> Diagnostics:
        """In the link's thread, and rarely: thousands of lags are sorted for it."""
        if diagnostics.number % LOOPS_EVERY != 1:
            return diagnostics
        return diagnostics.model_copy(update={"loops": timings(self._lags)})

    def _changes(self, whole: bool) -> tuple[tuple[str, ...], tuple[str, ...], int]:
        """Return what has come and gone since the last report, and how many beliefs are not looked at."""
        beliefs = self._mind.agent.beliefs
        now = dict.fromkeys(short(str(one)) for one in islice(beliefs, MOST_BELIEFS))
        before, self._beliefs = ({} if whole else self._beliefs), now
        unseen = len(beliefs) - MOST_BELIEFS if len(now) == MOST_BELIEFS else 0
        came, went = (one for one in now if one not in before), (one for one in before if one not in now)
        return tuple(came), tuple(went), max(0, unseen)


def within_bounds(diagnostics: Diagnostics) -> Diagnostics:
    """The same with less in it, if it is too large: the oldest half of the trace, again; then of the intentions, of
    the beliefs. How much is left out is said."""
    while len(diagnostics.model_dump_json().encode()) > MAX_DIAGNOSTICS_BYTES:
        diagnostics = _with_less(diagnostics)
    return diagnostics


def _with_less(diagnostics: Diagnostics) -> Diagnostics:
    left_out = diagnostics.left_out
    if cut := (len(diagnostics.trace) + 1) // 2:
        less = left_out.model_copy(update={"trace": left_out.trace + cut})
        return diagnostics.model_copy(update={"trace": diagnostics.trace[cut:], "left_out": less})
    if cut := (len(diagnostics.intentions) + 1) // 2:
        less = left_out.model_copy(update={"intentions": left_out.intentions + cut})
        return diagnostics.model_copy(update={"intentions": _first(diagnostics.intentions, cut), "left_out": less})
    came, went = diagnostics.came[: len(diagnostics.came) // 2], diagnostics.went[: len(diagnostics.went) // 2]
    fewer = len(diagnostics.came) + len(diagnostics.went) - len(came) - len(went)
    less = left_out.model_copy(update={"beliefs": left_out.beliefs + fewer})
    return diagnostics.model_copy(update={"came": came, "went": went, "left_out": less})


def _first(intentions: tuple[IntentionReport, ...], cut: int) -> tuple[IntentionReport, ...]:
    return intentions[: len(intentions) - cut]
