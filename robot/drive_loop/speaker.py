"""The base's speaker: one tune after another.

A base that plays ignores the command to play another tune [Open Interface, Play]. An unheard "yes, put it in",
lost because a "no" was just being played, is mail that the robot believes aboard and is not.
"""

from collections import deque

from robot.drivers.interfaces import Base, BaseState, Note

MOST_WAITING = 4
"""More than these would be heard long after what they tell of; the oldest goes first."""
ANSWER_S = 0.1
"""The base says that it plays some frames after it was told to."""

Tune = tuple[Note, ...]


class Speaker:
    """`say` at any time, `tick` with every frame."""

    def __init__(self, base: Base) -> None:
        self._base = base
        self._waiting: deque[Tune] = deque(maxlen=MOST_WAITING)
        self._plays_until_s = 0.0

    def say(self, tune: Tune) -> None:
        self._waiting.append(tune)

    def tick(self, state: BaseState | None, now: float) -> None:
        """Begin with the next tune when the base is silent; one that says nothing is taken to be when ours is over."""
        plays = state is not None and state.song_playing
        if not self._waiting or plays or now < self._plays_until_s:
            return
        tune = self._waiting.popleft()
        self._base.play(tune, now)
        self._plays_until_s = now + sum(length_s for _, length_s in tune) + ANSWER_S
