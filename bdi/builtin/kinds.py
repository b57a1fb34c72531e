"""Kinds of arguments of internal actions and functions: one notation for ours and for the user's own.

    @internal_action("range", ANY, WHOLE, WHOLE, optional(WHOLE))

A wrong count, or a constant of the wrong kind, is an error when the agent is made; a value of the wrong kind makes the
step fail with `error(wrong_arguments)`. `ANY` costs nothing when it is called.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from bdi.language.terms import (
    ARITHMETIC,
    NEGATIVE,
    POSITIVE,
    RELATIONS,
    Atom,
    Code,
    Handle,
    List,
    OpenList,
    String,
    Structure,
    Var,
)


@dataclass(frozen=True, slots=True)
class Kind:
    """`name` with its article ("a number"); `holds` says whether a value is one (None: everything is)."""

    name: str
    holds: Callable[[Any], bool] | None = None
    types: frozenset[type] | None = None  # quicker than `holds`, where types are all there is to look at
    lazy: bool = False  # handed over as a Question, not as a value
    optional: bool = False
    rest: bool = False  # this one, any number of times
    out: bool = False  # unified with the result


def kind(name: str, *types: type) -> Kind:
    """Values of these types."""
    wanted = frozenset(types)
    return Kind(name, lambda value: type(value) in wanted, wanted)


def optional(of: Kind) -> Kind:
    return replace(of, optional=True)


def rest(of: Kind) -> Kind:
    return replace(of, rest=True, optional=True)


def _is_literal(value: Any) -> bool:
    return type(value) is Atom or (type(value) is Structure and value.predicate not in _OPERATORS)


_OPERATORS = RELATIONS | ARITHMETIC | {NEGATIVE, POSITIVE}

ANY = Kind("anything")
OUT = Kind("an answer", out=True)
FORMULA = Kind("a formula", lazy=True)
NUMBER = kind("a number", int, float)
WHOLE = kind("a whole number", int)
STRING = kind("a string", String)
ATOM = kind("an atom", Atom)
LIST = kind("a list", List)
LISTS = kind("a list or a variable", List, OpenList, Var)
ITEMS = Kind("a list, set or queue", lambda value: type(value) in (List, Handle))
SEQUENCE = kind("a list or string", List, String)
COLLECTION = kind("a list, string, map, set or queue", List, String, Handle)
LITERAL = Kind("a literal", _is_literal)
LITERALS = Kind("a literal or a list", lambda value: type(value) is List or _is_literal(value))
GOAL = Kind("a goal", lambda value: type(value) is Var or _is_literal(value))
VARIABLE = kind("a variable", Var)
TIME_SPAN = Kind("milliseconds", lambda value: type(value) in (int, float) and value >= 0)
EVENT = kind("an event, as {+!g(X)} or a string", Code, String)


def counts(takes: tuple[Kind, ...]) -> tuple[int, int | None]:
    """Return how many arguments at least, and at most (None: any number)."""
    least = sum(1 for each in takes if not each.optional)
    return least, None if takes and takes[-1].rest else len(takes)


def at_place(takes: tuple[Kind, ...], place: int) -> Kind:
    return takes[min(place, len(takes) - 1)]
