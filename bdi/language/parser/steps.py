"""Formulas as steps of a plan."""

from typing import NamedTuple

from bdi.language.errors import (
    AgentSpeakSyntaxError,
    Place,
)
from bdi.language.syntax import (
    Body,
    Does,
    Simple,
    Step,
)
from bdi.language.terms import (
    AND,
    NEGATIVE,
    NOT,
    OR,
    POSITIVE,
    RELATIONS,
    Atom,
    Code,
    Structure,
    Term,
    Var,
    is_internal,
    predicate,
)

NO_LITERALS = RELATIONS | {AND, OR, NOT, NEGATIVE, POSITIVE} | {predicate(name, 2) for name in "+-*/"}


_BELIEF_STEPS = {
    (POSITIVE,): Does.ADD,
    (POSITIVE, POSITIVE): Does.ADD_APART,
    (NEGATIVE,): Does.REMOVE,
    (NEGATIVE, NEGATIVE): Does.REMOVE_APART,
    (NEGATIVE, POSITIVE): Does.UPDATE,
}


def step_of(term: Term, place: Place) -> Simple:
    """Return the kind of step that a formula is: signs make it a change of belief."""
    signs, inner = [], term
    while isinstance(inner, Structure) and inner.predicate in (NEGATIVE, POSITIVE):
        signs.append(inner.predicate)
        inner = inner.args[0]
    if signs:
        if tuple(signs) not in _BELIEF_STEPS:
            raise AgentSpeakSyntaxError(f"{term} is no step of a plan", place, ("+b", "-b", "-+b", "++b", "--b"))
        return Simple(_BELIEF_STEPS[tuple(signs)], believed(inner, place), place)
    return Simple(_deed_of(term, place), term, place)


class Run(NamedTuple):
    """Steps that count as one until the body around them is built."""

    steps: tuple[Step, ...]


def run_together(term: Term) -> list[Term]:
    """a + b - c, where a is no number, is meant as a; +b; -c."""
    signed: list[Term] = []
    while isinstance(term, Structure) and term.predicate in _JOINED:
        signed.append(Structure(_JOINED[term.predicate], (term.args[1],)))
        term = term.args[0]
    is_deed = isinstance(term, Atom | Structure) and (
        term.predicate not in NO_LITERALS or term.predicate in _JOINED.values()
    )
    return [term, *reversed(signed)] if is_deed else [term]


_JOINED = {predicate("+", 2): POSITIVE, predicate("-", 2): NEGATIVE}


def _deed_of(term: Term, place: Place) -> Does:
    if isinstance(term, Var | Code):
        return Does.VARIABLE
    if isinstance(term, Atom | Structure):
        if term.predicate in RELATIONS or term.predicate in (AND, OR, NOT) or term.functor in ("true", "false"):
            return Does.CONSTRAINT
        if is_internal(term.functor):
            return Does.INTERNAL
        if term.predicate not in NO_LITERALS:
            return Does.ACTION
    raise AgentSpeakSyntaxError(f"{term} is no step of a plan", place, ("an action", "a goal", "a belief"))


def believed(term: Term, place: Place) -> Term:
    """Check that this can be added and removed: a belief, `{ plan }` or `{ rule }`."""
    good = isinstance(term, Var | Code) or (
        isinstance(term, Atom | Structure) and term.predicate not in NO_LITERALS and not is_internal(term.functor)
    )
    if not good:
        raise AgentSpeakSyntaxError(f"{term} cannot be believed", place, ("a name",))
    return term


def branch_of(step: Step | Run) -> Body:
    """A branch of a fork: `(a; b)` counts as its steps."""
    return Body(step.steps if isinstance(step, Run) else (step,))
