"""`.wait` for an event or a formula, with or without an end."""

from collections.abc import Callable
from typing import Protocol

from bdi.intentions import Intention
from bdi.logic import HasLogic, Question
from bdi.syntax import Trigger
from bdi.terms import Literal, Term
from bdi.unify import undo, unify


class HasTime(HasLogic, Protocol):
    """`now` in seconds, of the clock that the agent is given."""

    now: float


class Waiter:
    """An intention that waits until something happens, or until `deadline_s` (None: for ever)."""

    def __init__(
        self, intention: Intention, what: str, deadline_s: float | None, happened: Callable[[HasTime], bool]
    ) -> None:
        self.intention = intention
        self.what = what
        self.deadline_s = deadline_s
        self.wanted: tuple[Trigger, Literal] | None = None
        self.seen = False
        self.quiet = False  # whether being late is no failure
        self._happened = happened

    def notice(self, trigger: Trigger, literal: Literal, mind: HasTime) -> None:
        """An event of the agent: is it the one?"""
        if self.wanted is None or self.seen or self.wanted[0] is not trigger:
            return
        trail = mind.logic.trail
        mark = len(trail)
        if unify(self.wanted[1], literal, trail):
            del trail[mark:]
            self.seen = True
        else:
            undo(trail, mark)

    def check(self, mind: HasTime) -> bool | None:
        """True: it happened; False: too late; None: wait on."""
        if self.seen or self._happened(mind):
            return True
        if self.deadline_s is not None and mind.now >= self.deadline_s:
            return False
        return None


def event_waiter(intention: Intention, trigger: Trigger, literal: Literal, deadline_s: float | None) -> Waiter:
    """.wait("+b(X)")"""
    waiter = Waiter(intention, f"{trigger}{literal}", deadline_s, lambda mind: False)
    waiter.wanted = (trigger, literal)
    return waiter


def formula_waiter(intention: Intention, formula: Question, deadline_s: float | None) -> Waiter:
    """.wait(b(X) & X > 2)"""
    return Waiter(intention, str(formula.term()), deadline_s, lambda mind: formula.first())


def moment_of(now: float, milliseconds: Term) -> float | None:
    return now + float(milliseconds) / 1000 if isinstance(milliseconds, int | float) else None
