"""Types of terms: `.atom`, `.ground`, `.type`, …; and terms with fresh variables."""

from collections import deque
from collections.abc import Callable

from bdi.builtin.arguments import alternatives, bind
from bdi.builtin.kinds import ANY, LITERAL, OUT
from bdi.builtin.table import Answer, internal_action
from bdi.builtin.terms.containers import OrderedMap, OrderedSet
from bdi.language.syntax import Rule
from bdi.language.terms import Atom, Code, Handle, List, OpenList, String, Structure, Term, Var, atom
from bdi.language.unify import is_ground, renamed
from bdi.model.logic import HasLogic


def _holds(value: Term, kind: type) -> bool:
    return isinstance(value, Handle) and isinstance(value.value, kind)


# From the most special to the most general: the order in which `.type` gives them.
TYPES: dict[str, Callable[[Term], bool]] = {
    "number": lambda term: isinstance(term, int | float),
    "atom": lambda term: isinstance(term, Atom),
    "literal": lambda term: LITERAL.holds is not None and LITERAL.holds(term),
    "string": lambda term: isinstance(term, String),
    "list": lambda term: isinstance(term, List | OpenList),
    "set": lambda term: _holds(term, OrderedSet),
    "map": lambda term: _holds(term, OrderedMap),
    "structure": lambda term: isinstance(term, Structure | List | OpenList | Atom),
    "rule": lambda term: isinstance(term, Code) and isinstance(term.body, Rule),
    "plan": lambda term: isinstance(term, Code) and not isinstance(term.body, Rule),
    "queue": lambda term: _holds(term, deque),
    "ground": is_ground,
    "free": lambda term: isinstance(term, Var),
}


def _register_type(name: str) -> None:
    holds = TYPES[name]
    internal_action(name, ANY)(lambda mind, term: holds(term))


for _name in ("number", "atom", "literal", "string", "list", "structure", "ground"):
    _register_type(_name)


@internal_action("type", ANY, OUT)
def type_of(mind: HasLogic, term: Term, result: Term) -> Answer:
    """Every type that it has."""
    return alternatives(mind, (((result, atom(name)),) for name, holds in TYPES.items() if holds(term)))


@internal_action("copy_term", ANY, OUT)
def copy_term(mind: HasLogic, term: Term, copy: Term) -> Answer:
    return bind(mind, copy, renamed(term, {}))


@internal_action("rename_apart", ANY, OUT)
def rename_apart(mind: HasLogic, term: Term, copy: Term) -> Answer:
    """The term with fresh variables."""
    return bind(mind, copy, renamed(term, {}))
