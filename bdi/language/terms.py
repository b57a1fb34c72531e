"""The values of AgentSpeak.

An atom is interned, a structure is a tuple of (predicate, arguments, annotations): both compare and hash in C.
Numbers are Python numbers (doubles in meaning, kept as `int` where they are whole); a string of the program is a
`String`, so that plain `str` stays free to mean "text to be parsed".
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias, Union
from weakref import WeakValueDictionary

LARGEST_EXACT = 2**53  # beyond it a double no longer holds every whole number


class Predicate:
    """Name, arity, negation and namespace: what beliefs and plans are filed under. One object for each."""

    __slots__ = ("__weakref__", "arity", "atom", "name", "namespace", "negated")

    def __init__(self, name: str, arity: int, negated: bool, namespace: str) -> None:
        self.name = name
        self.arity = arity
        self.negated = negated
        self.namespace = namespace
        self.atom: Atom | None = None  # set once an atom of this name is used

    def __str__(self) -> str:
        prefix = f"{self.namespace}::" if self.namespace else ""
        return f"{prefix}{'~' if self.negated else ''}{self.name}"

    def __repr__(self) -> str:
        return f"{self}/{self.arity}"


_predicates: WeakValueDictionary[tuple[str, int, bool, str], Predicate] = WeakValueDictionary()


def predicate(name: str, arity: int = 0, negated: bool = False, namespace: str = "") -> Predicate:
    """The one `Predicate` of these four."""
    key = (name, arity, negated, namespace)
    found = _predicates.get(key)
    if found is None:
        found = _predicates[key] = Predicate(name, arity, negated, namespace)
    return found


class Atom:
    """`post1`, `'Hello world'`: equal only to itself, so comparing and hashing cost nothing."""

    __slots__ = ("predicate",)
    args: "tuple[Term, ...]" = ()
    annots: "tuple[Term, ...]" = ()

    def __init__(self, predicate: Predicate) -> None:
        self.predicate = predicate

    @property
    def functor(self) -> str:
        return self.predicate.name

    def __str__(self) -> str:
        return show(self)

    __repr__ = __str__


def atom(name: str, negated: bool = False, namespace: str = "") -> Atom:
    """The one atom of this name."""
    return atom_of(predicate(name, 0, negated, namespace))


def atom_of(key: Predicate) -> Atom:
    if key.atom is None:
        key.atom = Atom(key)
    return key.atom


class Structure(NamedTuple):
    """`direction(post1,forward)[source(percept)]`; also an atom that carries annotations."""

    predicate: Predicate
    args: "tuple[Term, ...]"
    annots: "tuple[Term, ...]" = ()

    @property
    def functor(self) -> str:
        return self.predicate.name

    def __str__(self) -> str:
        return show(self)

    def __repr__(self) -> str:
        return show(self)


class String(str):
    """A string of the program. As a Python value it is its text; `str()` gives AgentSpeak, with the quotes."""

    __slots__ = ()

    def __str__(self) -> str:
        return f'"{str.__str__(self)}"'

    __repr__ = __str__


class List(tuple["Term", ...]):
    """`[a,b]`."""

    __slots__ = ()

    def __str__(self) -> str:
        return show(self)

    __repr__ = __str__


class OpenList(NamedTuple):
    """`[a,b|T]` whose tail is not (yet) a list."""

    items: "tuple[Term, ...]"
    tail: "Term"
    mark: None = None  # in no other term: as a bare pair, [a|b] would be equal to the list [[a],b]

    def __str__(self) -> str:
        return show(self)


class Var:
    """A variable: free while `ref` is None, otherwise a reference to its value."""

    __slots__ = ("name", "ref")

    def __init__(self, name: str = "_") -> None:
        self.name = name
        self.ref: Term | None = None

    def __str__(self) -> str:
        return show(self)

    def __repr__(self) -> str:
        return self.name


class Handle:
    """A thing that has identity and changes: a map, set or queue of the program."""

    __slots__ = ("value",)

    def __init__(self, value: Any) -> None:
        self.value = value

    def __str__(self) -> str:
        return show(self)


class Code:
    """A plan body as a value, `{ p(1); !g }`; `scope` gives its variables what they mean where it was written."""

    __slots__ = ("body", "scope")

    def __init__(self, body: Any, scope: "dict[Var, Term] | None" = None) -> None:
        self.body = body
        self.scope = scope or {}

    def __str__(self) -> str:
        return show(self)


Term: TypeAlias = Union[Atom, Structure, int, float, String, List, OpenList, Var, Handle, Code]  # noqa: UP007
Literal: TypeAlias = Atom | Structure

# Makes a named tuple of a plain one in half the time: make(Structure, (predicate, args, annots)).
make = tuple.__new__

TRUE = atom("true")
FALSE = atom("false")

# Operators are structures too, so that formulas can be terms. The names cannot be written as functors.
OPERATORS = {"+", "-", "*", "/", "div", "mod", "**", "<", "<=", ">", ">=", "==", "\\==", "=", "=..", "&", "|", "[]"}
ARITHMETIC = frozenset(predicate(name, 2) for name in ("+", "-", "*", "/", "div", "mod", "**"))
NEGATIVE = predicate("-", 1)
POSITIVE = predicate("+", 1)
NOT = predicate("not", 1)
AND = predicate("&", 2)
OR = predicate("|", 2)
THIS_SPACE = "this_ns"  # how a program names the namespace that it is read into; `::x` is this_ns::x
DEFAULT_SPACE = "default"  # how the namespace without a name is called
PRIVATE_SPACE = "#"  # begins the name of a local namespace: no text can say it
IN_SPACE = predicate("::", 2)  # NS::p(X), n::X: a literal whose namespace or name is a variable
ANNOTATED = predicate("[]", 1)  # X[a]: the literal that X is, with these annotations added
RELATIONS = frozenset(predicate(name, 2) for name in ("<", "<=", ">", ">=", "==", "\\==", "=", "=.."))
INTERNAL = "."  # internal actions are structures whose name has a dot: `.print(X)`, `courier.distance(A,B,D)`


def is_internal(name: str) -> bool:
    """Return whether this names an internal action or a function, by its form. 'in.quotes' is a name like any other."""
    return INTERNAL in name and name != "=.." and not name.startswith("'")


def structure(name: str, *args: Term, annots: tuple[Term, ...] = (), negated: bool = False) -> Literal:
    """`structure("p", 1)` is `p(1)`; without arguments and annotations the atom."""
    key = predicate(name, len(args), negated)
    return Structure(key, args, annots) if args or annots else atom_of(key)


def literal_of(key: Predicate, args: tuple[Term, ...], annots: tuple[Term, ...] = ()) -> Literal:
    return Structure(key, args, annots) if args or annots else atom_of(key)


def plain(key: Predicate) -> Predicate:
    """The predicate without its namespace."""
    return predicate(key.name, key.arity, key.negated) if key.namespace else key


def space_of(key: Predicate) -> Atom:
    """The name of its namespace, as a term."""
    return atom(key.namespace or DEFAULT_SPACE)


def in_space(space: Term, inner: Term) -> Literal:
    """`space::inner`; as long as one of them is a variable, a term that waits for it."""
    if type(space) is Atom and isinstance(inner, Atom | Structure):
        key, name = inner.predicate, space.functor
        if key not in (IN_SPACE, ANNOTATED) and not key.namespace:
            own = predicate(key.name, key.arity, key.negated, "" if name == DEFAULT_SPACE else name)
            return literal_of(own, inner.args, inner.annots)
    return Structure(IN_SPACE, (space, inner))


def annotated(inner: Term, annots: tuple[Term, ...]) -> Term:
    """`inner[annots]`; as long as that is a variable, a term that waits for it."""
    if isinstance(inner, Structure) and inner.predicate is IN_SPACE:
        return in_space(inner.args[0], annotated(inner.args[1], annots))
    if isinstance(inner, Atom | Structure):
        new = [annot for annot in annots if annot not in inner.annots]
        return literal_of(inner.predicate, inner.args, (*inner.annots, *new))
    return Structure(ANNOTATED, (inner,), annots)


def number(value: float) -> int | float:
    """A double, kept as `int` where it is whole and exact, so that 6/2 is 3."""
    if type(value) is int:
        return value if -LARGEST_EXACT <= value <= LARGEST_EXACT else float(value)
    if value.is_integer() and -LARGEST_EXACT <= value <= LARGEST_EXACT:
        return int(value)
    return value


# ---- terms as text -------------------------------------------------------------------------------------------------


def show(term: object) -> str:
    """A term as AgentSpeak, without spaces."""
    shower = _SHOW.get(type(term))
    return shower(term) if shower else str(term)


def _show_name(key: Predicate) -> str:
    space = f"{key.namespace}::" if key.namespace else ""
    return f"{space}{'~' if key.negated else ''}{key.name}"


def _show_structure(term: Structure) -> str:
    key, args, annots = term
    if key is ANNOTATED:
        return show(args[0]) + (_show_annots(annots) if annots else "")
    if key.name in OPERATORS and not key.negated:
        if key.arity == 2:
            return f"({_operand(key, args[0])}{_spaced(key.name)}{_operand(key, args[1])})"
        if key.arity == 1:
            return f"({key.name}{show(args[0])})"
    if key is NOT:
        return f"not ({show(args[0])})"
    if key is IN_SPACE:
        return f"{show(args[0])}::{show(args[1])}"
    text = _show_name(key)
    if args:
        text += "(" + ",".join(map(show, args)) + ")"
    if annots:
        text += _show_annots(annots)
    return text


def _show_annots(annots: tuple[Term, ...]) -> str:
    last = annots[-1]
    return show(OpenList((*annots[:-1], *last.items), last.tail) if type(last) is OpenList else List(annots))


def _operand(key: Predicate, term: Term) -> str:
    """`not` binds less than anything but & and |"""
    loose = type(term) is Structure and term.predicate is NOT and key is not AND and key is not OR
    return f"({show(term)})" if loose else show(term)


def _spaced(operator: str) -> str:
    return f" {operator} " if operator.isalpha() or operator in "&|" else operator


def _show_number(value: float) -> str:
    """Format a double as the language does: whole ones without a point, very large and small ones as 1.0E20."""
    if math.isnan(value):
        return "NaN"
    if math.isinf(value):
        return "Infinity" if value > 0 else "-Infinity"
    if value.is_integer() and abs(value) < 2**63:
        return str(int(value))
    if 1e-3 <= abs(value) < 1e7:
        return repr(value)
    return _scientific(value)


def _scientific(value: float) -> str:
    """Shortest digits that read back as the same double, one of them before the point."""
    sign = "-" if value < 0 else ""
    mantissa, _, exponent = repr(abs(value)).partition("e")
    whole, _, fraction = mantissa.partition(".")
    digits = (whole + fraction).lstrip("0")
    power = int(exponent or 0) + len(whole) - 1
    if whole == "0":
        power = int(exponent or 0) - (len(fraction) - len(fraction.lstrip("0"))) - 1
    digits = digits.rstrip("0") or "0"
    return f"{sign}{digits[0]}.{digits[1:] or '0'}E{power}"


def _show_open_list(term: OpenList) -> str:
    return "[" + ",".join(map(show, term.items)) + "|" + show(term.tail) + "]"


def _show_var(term: Var) -> str:
    return term.name if term.ref is None else show(term.ref)


_SHOW: dict[type, Any] = {
    Atom: lambda term: _show_name(term.predicate),
    Structure: _show_structure,
    int: str,
    float: _show_number,
    String: String.__str__,
    List: lambda term: "[" + ",".join(map(show, term)) + "]",
    OpenList: _show_open_list,
    Var: _show_var,
    Handle: lambda term: show_handle(term.value),
}


def show_by(kind: type, text_of: Callable[[Any], str]) -> None:
    """Register the notation of a kind of value that is defined in a higher module."""
    _SHOW[kind] = text_of


def show_handle(value: object) -> str:
    if isinstance(value, dict):
        return "{" + ",".join(f"{show(k)}->{show(v)}" for k, v in value.items()) + "}"
    if isinstance(value, (set, frozenset)):
        return "{" + ",".join(map(show, value)) + "}"
    if hasattr(value, "__iter__"):
        return "[" + ",".join(map(show, value)) + "]"
    return str(value)
