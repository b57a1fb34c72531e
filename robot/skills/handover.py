"""Waiting for mail to change hands: a code held up to the camera, or the Spot button pressed twice."""

from collections.abc import Callable, Iterable
from hmac import compare_digest
from typing import ClassVar

from protocol.proofs import ShownCode
from robot.skills.interfaces import Done, Play, Running, Step, View
from robot.skills.tunes import REFUSED

TWICE_WITHIN_S = 2.0
FORGET_WRONG_S = 3.0
"""A wrong code that is still held up is refused again only after so long without it."""


class WaitHandover:
    """Done(shown=the code) when it matches, Done() when Spot was pressed twice; else no_one_came.

    It does not say that a code was right: the caller does, once the hand-over is written down.
    """

    name: ClassVar[str] = "wait_handover"
    moves: ClassVar[bool] = False
    on_timeout: ClassVar[str] = "no_one_came"

    def __init__(
        self,
        verifiers: Callable[[], Iterable[str]],
        limit_s: float = 600.0,
        spot_counts: Callable[[], bool] = lambda: True,
    ) -> None:
        """`verifiers` says which texts open at the moment it is asked, each by its SHA-256 (lower-case hex): a code may
        be replaced or expire while the robot waits. `spot_counts`: whether the button opens too, at that moment."""
        self._verifiers, self._spot_counts = verifiers, spot_counts
        self.limit_s = limit_s
        self.refused = 0

    def start(self, view: View, now: float) -> None:
        """See `interfaces.Skill.start`."""
        self._seen_s = now
        self._wrong: tuple[str, float] | None = None
        self._spot_down = bool(view.base and view.base.spot_pressed)
        self._pressed_s: float | None = None

    def step(self, view: View, now: float) -> Step:
        """See `interfaces.Skill.step`."""
        code = view.code
        if code is not None and code.at_s > self._seen_s:
            self._seen_s = code.at_s
            shown = ShownCode.of(code.text)
            if self._opens(shown.sha256):
                return Done(shown=shown)
            return self._refuse(code.text, now)
        if self._pressed_twice(view, now):
            return Done() if self._spot_counts() else self._say_no()
        return Running()

    def _opens(self, verifier: str) -> bool:
        """Compared with each of them to the end: the time that it takes tells nothing."""
        return True in [compare_digest(verifier, known) for known in self._verifiers()]

    def _refuse(self, text: str, now: float) -> Step:
        """Told once by sound, however long it is held up."""
        known = self._wrong is not None and self._wrong[0] == text and now - self._wrong[1] < FORGET_WRONG_S
        self._wrong = (text, now)
        return Running() if known else self._say_no()

    def _say_no(self) -> Step:
        self.refused += 1
        return Running(requests=(Play(REFUSED),))

    def _pressed_twice(self, view: View, now: float) -> bool:
        down = bool(view.base and view.base.spot_pressed)
        pressed, self._spot_down = down and not self._spot_down, down
        if not pressed:
            return False
        twice = self._pressed_s is not None and now - self._pressed_s <= TWICE_WITHIN_S
        self._pressed_s = now
        return twice
