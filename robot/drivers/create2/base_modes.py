"""The mode of the base: which mode was asked for, which one the base reports, and when to ask again."""

from robot.drivers.create2 import open_interface as oi
from robot.drivers.interfaces import BaseState, Mode

MODE_RETRY_S = 0.5
MODE_KNOWN_AFTER_S = 0.06
"""Older frames may have been on their way when the base was started."""
OPCODES = {Mode.PASSIVE: oi.Opcode.START, Mode.SAFE: oi.Opcode.SAFE, Mode.FULL: oi.Opcode.FULL}
TELLING = {1: 0, 4: 1}
"""Reported number → how much too high this firmware counts. A base that is Off streams nothing, so 1 is never Off plus
one; and there is no mode 4."""


class ModeKeeper:
    """The mode that is wanted is kept up: a base that fell back to Passive is taken again."""

    def __init__(self) -> None:
        self.wanted = Mode.PASSIVE
        self._asked_s = 0.0
        self._offset: int | None = None
        self._started_s = 0.0
        self._doubted = False
        self.doubtful = False
        """The base is to be sent Start once more: it does not say that the last one was heard."""

    def started(self, now: float) -> None:
        """The base has been sent Start: it is in Passive, and has to be asked for anything else again."""
        self._offset = None
        self._doubted = self.doubtful = False
        self._started_s, self._asked_s = now, now - MODE_RETRY_S

    def read(self, reported: int | None, now: float) -> Mode:
        """Some firmware reports every mode one too high; just after a start it must be Passive: that tells.

        Unless the start was lost on a base that was in Safe: so before that is believed it is sent a second one.
        `reported` is None if the firmware does not tell its mode at all.
        """
        if self._offset is None and now - self._started_s < MODE_KNOWN_AFTER_S:
            return Mode.UNKNOWN
        if reported is None:
            self._offset = 0
            return Mode.UNKNOWN
        if self._offset is None and reported == Mode.SAFE and not self._doubted:
            self._doubted = self.doubtful = True
            self._started_s = now
            return Mode.UNKNOWN
        if self._offset is None:
            self._offset = 1 if reported == Mode.SAFE else 0
        self._offset = TELLING.get(reported, self._offset)
        number = reported - self._offset
        return Mode(number) if number in OPCODES else Mode.UNKNOWN

    @property
    def known(self) -> bool:
        """Return whether the base can be asked for a mode: it has answered the start."""
        return self._offset is not None

    def asked(self, mode: Mode, now: float) -> None:
        self.wanted, self._asked_s = mode, now

    def lost(self, state: BaseState, standing: bool, now: float) -> bool:
        """Return whether to ask again: the mode is another, and the reason for its fall is gone.

        An odd number says nothing: then only wheels that stand although they should turn show that the mode is lost.
        """
        if self.wanted is Mode.PASSIVE or not self.known or now - self._asked_s < MODE_RETRY_S:
            return False
        if self.wanted is Mode.SAFE and (state.cliff or state.wheel_drop or state.docked):
            return False
        return standing if state.mode is Mode.UNKNOWN else state.mode is not self.wanted
