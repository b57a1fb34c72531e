"""Percepts compared with those of the cycle before: only the difference costs time."""

from collections.abc import Iterable
from operator import attrgetter
from typing import Any, TypeAlias

from bdi.language.parser import literal_from
from bdi.language.syntax import Trigger
from bdi.language.terms import Literal, Term, literal_of, show
from bdi.language.unify import FIXED, is_ground, renamed
from bdi.model.beliefs import PERCEPT, Belief
from bdi.model.intentions import Event, event_of
from bdi.model.mind import Mind
from bdi.model.plans import relevant

FROM_PERCEPT = (PERCEPT,)
REMEMBERED_TEXTS = 20_000  # percepts and messages given as text are parsed once; then the memory starts again


class Percept:
    """A percept with everything that adding and removing it needs, looked up once."""

    __slots__ = ("added", "annots", "args", "belief", "literal", "open", "plain", "relation", "removed", "text")

    def __init__(self, literal: Literal, mind: Mind) -> None:
        self.literal = literal
        self.text = show(literal)
        self.relation = mind.beliefs.relation(literal.predicate)
        self.args = literal.args
        self.annots = (*literal.annots, PERCEPT)
        self.plain = all(type(arg) in FIXED for arg in literal.args)
        self.belief = Belief(literal.args, self.annots)  # reused while the percept is its only source
        self.open = not is_ground(literal)
        perceived = literal_of(literal.predicate, literal.args, self.annots)
        self.added = _event(Trigger.BELIEF_ADDED, perceived, mind)
        self.removed = _event(Trigger.BELIEF_REMOVED, perceived, mind)

    def appear(self) -> bool:
        """Believe it. False if nothing is new."""
        relation = self.relation
        if self.open:
            self.added, self.removed = _again(self.added), _again(self.removed)
        if not self.plain or relation.by_first is not None or self.args in relation.facts:
            return relation.add(self.args, self.annots)
        self.belief.annots = self.annots
        relation.facts[self.args] = self.belief
        return True

    def vanish(self) -> bool:
        """Forget it, as far as it was perceived. False if it was not."""
        relation, belief = self.relation, self.belief
        if (
            relation.by_first is not None
            or relation.facts.get(self.args) is not belief
            or belief.annots is not self.annots
        ):
            return relation.take_back(self.args, FROM_PERCEPT)
        del relation.facts[self.args]
        return True


def _event(trigger: Trigger, literal: Literal, mind: Mind) -> Event:
    """An event of the world never changes, so that every time the percept comes or goes it is the same."""
    return event_of(trigger, literal, relevant(mind.library.options(trigger, literal.predicate), literal))


def _again(event: Event) -> Event:
    """The event with variables of its own: what a plan has found out about the last one is forgotten."""
    return event_of(event.trigger, renamed(event.literal, {}), event.options)  # type: ignore[arg-type]


def _set_of(percepts: Iterable[Term | str]) -> frozenset[Any]:
    if isinstance(percepts, str):  # whose items would be its letters
        raise TypeError(f"percepts are a set: {{{percepts!r}}}, not {percepts!r}")
    return frozenset(percepts)


_text = attrgetter("text")


def _written(percept: Term | str) -> str:
    return percept if type(percept) is str else show(percept)


Change: TypeAlias = tuple[frozenset[Any], list[Percept], list[Percept]]  # what is perceived now; gone of it; new in it


class Percepts:
    """The current percepts, in the notation in which they came: text, terms, or (once both were met) always terms."""

    def __init__(self, mind: Mind) -> None:
        self.now: frozenset[Any] = frozenset()
        self._mind = mind
        self._known: dict[Any, Percept] = {}  # by text or term
        self._notations: set[str] = set()
        self._mixed = False  # whether one percept may come written in several ways
        self._annotated = False  # whether two percepts may be one belief

    def change(self, percepts: Iterable[Term | str]) -> Change | None:
        """Compare with the percepts of before; None if they are equal. Raises AgentSpeakSyntaxError and NotALiteral.

        Nothing is changed until `now` is set to the first of the answer.
        """
        before = self.now
        now: frozenset[Any] = percepts if type(percepts) is frozenset else _set_of(percepts)
        if self._mixed:
            now = frozenset(map(self._canonical, now))
        if now == before:
            return None
        new, gone = now - before, before - now
        appeared = self._in_order(new) if new else []
        vanished = self._in_order(gone) if gone else []
        if vanished and self._annotated:
            appeared = sorted([*appeared, *self._uncovered(vanished, now & before)], key=_text)
        if self._mixed and any(type(percept) is str for percept in now):
            return self.change(now)
        return now, vanished, appeared

    def _uncovered(self, vanished: list[Percept], staying: frozenset[Any]) -> list[Percept]:
        """p(1) and p(1)[a] are one belief: when one of them vanishes, the other is perceived anew."""
        gone = {(percept.relation, percept.args) for percept in vanished}
        return [percept for percept in map(self._percept, staying) if (percept.relation, percept.args) in gone]

    def _in_order(self, percepts: frozenset[Any]) -> list[Percept]:
        """Sort by text: a set has another order in every run, and equal inputs must give equal runs."""
        if len(percepts) == 1:
            (percept,) = percepts
            return [self._known.get(percept) or self._percept(percept)]
        if not self._mixed and set(map(type, percepts)) == {str}:  # each is written as it would be shown
            texts = sorted(percepts)
            found = list(map(self._known.get, texts))
            return list(map(self._percept, texts)) if None in found else found  # type: ignore[return-value]
        known = list(map(self._known.get, percepts))
        if None in known:  # met in order, too: beliefs are listed as their predicates were met
            known = list(map(self._percept, sorted(percepts, key=_written)))
        return sorted(known, key=_text)  # type: ignore[arg-type]

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
            self._annotated = self._annotated or bool(literal.annots)
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
