"""The base's speaker: one tune after another.

A base that plays ignores the command to play another tune, and in Passive it ignores all of them [Open Interface,
Play]. An unheard "yes, put it in", lost because a "no" was just being played or because the base has just been
started, is mail that the robot believes aboard and is not.
"""

from collections import deque

from robot.drivers.interfaces import Base, BaseState, Mode, Note

MOST_WAITING = 4
"""More than these would be heard long after what they tell of; the oldest goes first."""
ANSWER_S = 0.1
"""The base says that it plays some frames after it was told to."""
STALE_S = 5.0
"""What could not be told for so long is not told at all: in a dock the base stays in Passive for hours."""
PLAYS_IN = frozenset({Mode.SAFE, Mode.FULL, Mode.UNKNOWN})

Tune = tuple[Note, ...]


class Speaker:
    """`say` at any time, `tick` with every frame."""

    def __init__(self, base: Base) -> None:
        self._base = base
        self._waiting: deque[tuple[float, Tune]] = deque(maxlen=MOST_WAITING)
        self._plays_until_s = 0.0

    def say(self, tune: Tune, now: float) -> None:
        self._waiting.append((now, tune))

    def tick(self, state: BaseState | None, now: float) -> None:
        """Begin with the next tune when the base can play it; one that says nothing of tunes is taken to be when ours
        is over."""
        while self._waiting and now - self._waiting[0][0] > STALE_S:
            self._waiting.popleft()
        is_ready = state is not None and state.mode in PLAYS_IN and not state.song_playing
        if not self._waiting or not is_ready or now < self._plays_until_s:
            return
        _, tune = self._waiting.popleft()
        self._base.play(tune, now)
        self._plays_until_s = now + sum(length_s for _, length_s in tune) + ANSWER_S
