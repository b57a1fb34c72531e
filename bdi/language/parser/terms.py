"""The actions of the grammar for terms and formulas."""

from functools import cmp_to_key
from typing import Any, NamedTuple

from bdi.language.errors import (
    AgentSpeakSyntaxError,
    Place,
)
from bdi.language.parser.places import Places
from bdi.language.syntax import (
    Body,
    Plan,
    Rule,
    variables_of,
)
from bdi.language.terms import (
    AND,
    NEGATIVE,
    NOT,
    OPERATORS,
    OR,
    POSITIVE,
    THIS_SPACE,
    Code,
    List,
    Literal,
    OpenList,
    String,
    Structure,
    Term,
    Var,
    annotated,
    atom,
    in_space,
    literal_of,
    number,
    predicate,
)
from bdi.language.unify import compare

MOST_DIGITS = 15  # of a whole number that is surely exact


class Braces(NamedTuple):
    """Arguments or annotations on their way to the literal that they belong to."""

    annotations: bool
    terms: tuple[Term, ...]


class Marked(NamedTuple):
    """A part of a plan or list on its way there."""

    kind: str
    value: Any


class Terms:
    """Builds terms bottom-up. One variable object for each name within a clause."""

    def __init__(self, text: str, source: str) -> None:
        self.places = Places(text, source)
        self.at = 0  # where what is being built begins
        self.variables: dict[str, Var] = {}

    @property
    def place(self) -> Place:
        return self.places.at(self.at)

    def either(self, left: Term, right: Term) -> Term:
        return Structure(OR, (left, right))

    def both(self, left: Term, right: Term) -> Term:
        return Structure(AND, (left, right))

    def negated(self, formula: Term) -> Term:
        return Structure(NOT, (formula,))

    def operation(self, left: Term, sign: str, right: Term) -> Term:
        return Structure(predicate(sign, 2), (left, right))

    def signed(self, sign: str, term: Term) -> Term:
        return Structure(NEGATIVE if sign == "-" else POSITIVE, (term,))

    def number(self, digits: str) -> Term:
        if len(digits) <= MOST_DIGITS and digits.isdecimal():
            return int(digits)
        value = float(digits)
        if value == float("inf"):
            raise AgentSpeakSyntaxError("this number is too large", self.place)
        return number(value)

    def string(self, quoted: str) -> Term:
        return String(self._unescaped(quoted[1:-1]))

    def _unescaped(self, text: str) -> str:
        if "\\" not in text:
            return text
        chars = iter(text)
        return "".join(self._escape(next(chars)) if char == "\\" else char for char in chars)

    def _escape(self, char: str) -> str:
        if char not in ESCAPES:
            raise AgentSpeakSyntaxError(
                f"there is no escape \\{char}", self.place, tuple(f"\\{each}" for each in ESCAPES)
            )
        return ESCAPES[char]

    def variable(self, name: str, annots: Braces | None = None) -> Term:
        variable = self._variable(name)
        return annotated(variable, annots.terms) if annots else variable

    def _variable(self, name: str) -> Term:
        if "::" in name:
            space, _, name = name.partition("::")
            return in_space(self._space(space or THIS_SPACE), self._variable(name))
        if name == "_":
            return Var("_")
        return self.variables.setdefault(name, Var(name))

    def _space(self, name: str) -> Term:
        """NS, or a name"""
        return atom(name) if name[0].islower() else self._variable(name)

    def literal(self, *children: Any) -> Literal:
        negated = children[0] == "~"
        name, *braces = children[1:] if negated else children
        space, plain = "", name
        if "::" in name and not name.startswith("'"):  # 'x' is not x: the quotes belong to the name
            space, _, plain = name.partition("::")
            space = space or THIS_SPACE
        if plain.startswith("~"):
            negated, plain = True, plain[1:]
        if plain in OPERATORS and braces:
            raise AgentSpeakSyntaxError(f"'{plain}' is an operator and cannot be a name", self.place, ("a name",))
        if space and not space[0].islower():
            return in_space(self._space(space), _literal(plain, braces, negated))
        return _literal(plain, braces, negated, space)

    def internal(self, name: str, *braces: Braces) -> Term:
        return _literal(name, list(braces))

    def arguments(self, *terms: Term) -> Braces:
        return Braces(False, terms)

    def annotations(self, terms: Term) -> Braces:
        # [a|T] is kept whole, as the last annotation.
        return Braces(True, tuple(terms) if isinstance(terms, List) else (terms,))

    def sequence(self, *children: Any) -> Term:
        if children and isinstance(children[-1], Marked):
            tail = children[-1].value
            return OpenList(children[:-1], tail)
        return List(children)

    def tail(self, term: Term) -> Marked:
        return Marked("tail", term)

    def code(self, quoted: Body | Plan | Rule) -> Term:
        return Code(quoted, {variable: variable for variable in variables_of(quoted)})


def _literal(name: str, braces: list[Braces], negated: bool = False, space: str = "") -> Literal:
    args = next((brace.terms for brace in braces if not brace.annotations), ())
    annots = _in_order(next((brace.terms for brace in braces if brace.annotations), ()))
    return literal_of(predicate(name, len(args), negated, space), args, annots)


def _in_order(annots: tuple[Term, ...]) -> tuple[Term, ...]:
    """Sort in standard order, as annotations are shown; a last `|T` stays last."""
    if len(annots) < 2:
        return annots
    tail = annots[-1:] if isinstance(annots[-1], OpenList) else ()
    return (*sorted(annots[: len(annots) - len(tail)], key=cmp_to_key(compare)), *tail)


ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "b": "\b", "f": "\f", '"': '"', "'": "'", "\\": "\\"}
