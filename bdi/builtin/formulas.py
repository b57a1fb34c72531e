"""Formulas that are asked, and kinds of terms: `.findall`, `.count`, `.ground`, …"""

from collections.abc import Callable

from bdi.builtin.arguments import bind, unique
from bdi.builtin.table import Answer, internal_action
from bdi.logic import HasLogic, Question
from bdi.mind import Mind
from bdi.terms import Atom, List, OpenList, String, Structure, Term, atom
from bdi.unify import deref, is_ground, renamed, unify


@internal_action("findall", 3, lazy=(0, 1))
def findall(mind: HasLogic, template: Question, formula: Question, result: Term) -> Answer:
    return bind(mind, result, List(formula.answers(template)))


@internal_action("setof", 3, lazy=(0, 1))
def setof(mind: HasLogic, template: Question, formula: Question, result: Term) -> Answer:
    return bind(mind, result, unique(formula.answers(template)))


@internal_action("count", 2, lazy=(0,))
def count(mind: HasLogic, formula: Question, result: Term) -> Answer:
    return bind(mind, result, len(formula.answers(formula)))


@internal_action("eval", 2, lazy=(1,))
def evaluate(mind: Mind, result: Term, formula: Question) -> Answer:
    return unify(result, atom("true" if formula.first() else "false"), mind.logic.trail)


KINDS: dict[str, Callable[[Term], bool]] = {
    "atom": lambda term: isinstance(term, Atom),
    "structure": lambda term: isinstance(term, Structure | List | OpenList | Atom),
    "literal": lambda term: isinstance(term, Structure | Atom),
    "list": lambda term: isinstance(term, List),
    "number": lambda term: isinstance(term, int | float),
    "string": lambda term: isinstance(term, String),
    "ground": is_ground,
}


def _register_kind(name: str, holds: Callable[[Term], bool]) -> None:
    internal_action(name, 1)(lambda mind, term: holds(deref(term)))


for _name, _holds in KINDS.items():
    _register_kind(_name, _holds)


@internal_action("copy_term", 2)
def copy_term(mind: HasLogic, term: Term, copy: Term) -> Answer:
    return bind(mind, copy, renamed(term, {}))
