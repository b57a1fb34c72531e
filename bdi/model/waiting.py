"""`.wait` for an event or a formula, with or without an end."""

from collections.abc import Callable
from typing import NamedTuple, Protocol

from bdi.language.syntax import Trigger
from bdi.language.terms import Literal, String, Structure, Term, atom, number, predicate, structure
from bdi.language.unify import undo, unify
from bdi.model.intentions import Intention, State
from bdi.model.logic import HasLogic, Question


class HasTime(HasLogic, Protocol):
    """`now` in seconds, of the clock that the agent is given."""

    now: float


class Deadline(NamedTuple):
    """The end of the time for a goal; one that is not hard only raises an event."""

    moment_s: float
    milliseconds: float
    is_hard: bool


class Moment(float):
    """The end of `.wait(MS)`, in seconds of the agent's clock."""

    milliseconds: Term = 0


def moment_after(now: float, milliseconds: float) -> Moment:
    moment = Moment(now + milliseconds / 1000)
    moment.milliseconds = milliseconds
    return moment


def reason_of(intention: Intention) -> Term | None:
    """Return what it waits for: action(drive(uc)), wait(500)[time(500)], wait("+b(X)"), ask; or None."""
    awaited = intention.waits_for
    if intention.state is State.ACTION:
        return structure("action", awaited)
    if intention.state is State.ANSWER:
        return atom("ask")
    if isinstance(awaited, Moment):
        return Structure(WAIT, (awaited.milliseconds,), (structure("time", awaited.milliseconds),))
    return Structure(WAIT, (String(awaited.what),)) if isinstance(awaited, Waiter) else None


WAIT = predicate("wait", 1)


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
        self.elapsed: Term | None = None  # gets the milliseconds that it took; then being late is no failure
        self.since_s = 0.0
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
        """Return True if it happened, False if it is too late, None to wait on."""
        if self.seen or self._happened(mind):
            return True
        if self.deadline_s is not None and mind.now >= self.deadline_s:
            return False
        return None

    def tell_elapsed(self, mind: HasTime) -> bool:
        if self.elapsed is None:
            return True
        took_ms = number(round((mind.now - self.since_s) * 1000, 3))
        unified = unify(self.elapsed, took_ms, mind.logic.trail)
        mind.logic.trail.clear()
        return unified


def event_waiter(intention: Intention, trigger: Trigger, literal: Literal, deadline_s: float | None) -> Waiter:
    """.wait("+b(X)")"""
    waiter = Waiter(intention, f"{trigger}{literal}", deadline_s, lambda mind: False)
    waiter.wanted = (trigger, literal)
    return waiter


def formula_waiter(intention: Intention, formula: Question, deadline_s: float | None) -> Waiter:
    """.wait(b(X) & X > 2)"""

    def happened(mind: HasTime) -> bool:
        trail = mind.logic.trail
        if formula.bind_first():
            trail.clear()
            return True
        undo(trail, 0)
        return False

    return Waiter(intention, str(formula.term()), deadline_s, happened)


def moment_of(now: float, milliseconds: Term) -> float | None:
    return now + float(milliseconds) / 1000 if isinstance(milliseconds, int | float) else None
