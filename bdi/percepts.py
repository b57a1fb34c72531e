"""What is perceived now, compared with what was: only the difference costs time."""

from collections.abc import Iterable
from operator import attrgetter
from typing import Any, TypeAlias

from bdi.beliefs import PERCEPT
from bdi.intentions import Event
from bdi.mind import Mind
from bdi.parser import literal_from
from bdi.plans import relevant
from bdi.syntax import Trigger
from bdi.terms import Literal, Term, show

REMEMBERED_TEXTS = 20_000  # percepts and messages given as text are parsed once; then the memory starts again


class Percept:
    """A percept with everything that adding and removing it needs, looked up once."""

    __slots__ = ("added", "annots", "literal", "relation", "removed", "text")

    def __init__(self, literal: Literal, mind: Mind) -> None:
        self.literal = literal
        self.text = show(literal)
        self.relation = mind.beliefs.relation(literal.predicate)
        self.annots = (*literal.annots, PERCEPT)
        self.added = _event(Trigger.BELIEF_ADDED, literal, mind)
        self.removed = _event(Trigger.BELIEF_REMOVED, literal, mind)


def _event(trigger: Trigger, literal: Literal, mind: Mind) -> Event:
    """An event of the world never changes, so that every time the percept comes or goes it is the same."""
    return Event(trigger, literal, relevant(mind.library.options(trigger, literal.predicate), literal))


_text = attrgetter("text")


Change: TypeAlias = tuple[frozenset[Any], list[Percept], list[Percept]]  # what is perceived now; gone of it; new in it


class Percepts:
    """What is perceived, in the notation in which it came: text, or terms, or (once both were met) always terms."""

    def __init__(self, mind: Mind) -> None:
        self.now: frozenset[Any] = frozenset()
        self._mind = mind
        self._known: dict[Any, Percept] = {}  # by text or term
        self._notations: set[str] = set()
        self._mixed = False  # whether one percept may come written in several ways

    def change(self, percepts: Iterable[Term | str]) -> Change | None:
        """None if all is as before. Raises AgentSpeakSyntaxError and NotALiteral.

        Nothing is changed until `now` is set to the first of the answer.
        """
        now = frozenset(map(self._canonical, percepts) if self._mixed else percepts)
        if now == self.now:
            return None
        known, look_up = self._known, self._percept
        new = [known.get(percept) or look_up(percept) for percept in now - self.now]
        gone = [known.get(percept) or look_up(percept) for percept in self.now - now]
        if self._mixed and any(type(percept) is str for percept in now):
            return self.change(now)
        # By text: a set has another order in every run, and equal inputs must give equal runs.
        if len(new) > 1:
            new.sort(key=_text)
        if len(gone) > 1:
            gone.sort(key=_text)
        return now, gone, new

    def forget_plans(self) -> None:
        """The plans have changed: look them up again."""
        self._known.clear()

    def _percept(self, percept: Term | str) -> Percept:
        """Looked up by text or term."""
        known = self._known.get(percept)
        if known is None:
            literal = literal_from(percept)
            if len(self._known) >= REMEMBERED_TEXTS:
                self._known.clear()
            known = self._known[percept] = Percept(literal, self._mind)
            self._note_notation(percept, known.text)
        return known

    def _note_notation(self, percept: Term | str, text: str) -> None:
        """The same percept in two notations must stay one percept: from then on terms are compared, not texts."""
        notation = "term" if type(percept) is not str else "text" if text == percept else "free text"
        self._notations.add(notation)
        if not self._mixed and (len(self._notations) > 1 or notation == "free text"):
            self._mixed = True
            self.now = frozenset(map(self._canonical, self.now))

    def _canonical(self, percept: Term | str) -> Literal:
        return self._percept(percept).literal
