"""What the grammar says about terms and formulas."""

from dataclasses import dataclass
from typing import Any

from lark import Token, Transformer, v_args
from lark.tree import Meta

from bdi.errors import (
    Place,
)
from bdi.syntax import (
    Body,
    variables_of,
)
from bdi.terms import (
    AND,
    NEGATIVE,
    NOT,
    OR,
    POSITIVE,
    Code,
    List,
    Literal,
    OpenList,
    String,
    Structure,
    Term,
    Var,
    literal_of,
    number,
    predicate,
)


@dataclass(frozen=True, slots=True)
class Braces:
    """Arguments or annotations on their way to the literal that they belong to."""

    annotations: bool
    terms: tuple[Term, ...]


class Marked:
    """A part of a plan on its way to the plan."""

    def __init__(self, kind: str, value: Any) -> None:
        self.kind = kind
        self.value = value


@v_args(inline=True)
class Terms(Transformer[Token, Any]):
    """Builds terms bottom-up. One variable object for each name within a clause."""

    def __init__(self, text: str, source: str) -> None:
        super().__init__(visit_tokens=False)
        self.lines = text.split("\n")
        self.source = source
        self.variables: dict[str, Var] = {}

    def place(self, meta: Meta) -> Place:
        if meta.empty:
            return Place(self.source)
        return Place(self.source, meta.line, meta.column, self.lines[meta.line - 1])

    def either(self, left: Term, right: Term) -> Term:
        return Structure(OR, (left, right))

    def both(self, left: Term, right: Term) -> Term:
        return Structure(AND, (left, right))

    def negated(self, formula: Term) -> Term:
        return Structure(NOT, (formula,))

    def operation(self, left: Term, sign: Token, right: Term) -> Term:
        return Structure(predicate(str(sign), 2), (left, right))

    def signed(self, sign: Token, term: Term) -> Term:
        return Structure(NEGATIVE if sign == "-" else POSITIVE, (term,))

    def number(self, token: Token) -> Term:
        return number(float(token)) if any(mark in token for mark in ".eE") else number(int(token))

    def string(self, token: Token) -> Term:
        return String(_unescaped(token[1:-1]))

    def variable(self, token: Token, annots: Braces | None = None) -> Term:
        if token == "_":  # noqa: S105 — the unnamed variable
            return Var("_")
        return self.variables.setdefault(str(token), Var(str(token)))

    def literal(self, *children: Any) -> Literal:
        negated = children[0] == "~"
        name, *braces = children[1:] if negated else children
        space, _, plain = name.rpartition("::")
        if name.startswith("'"):
            space, plain = "", str(name)  # 'x' is not x: the quotes belong to the name
        return _literal(plain, braces, negated, space)

    def internal(self, name: Token, *braces: Braces) -> Term:
        return _literal(str(name), list(braces))

    def arguments(self, *terms: Term) -> Braces:
        return Braces(False, terms)

    def annotations(self, terms: Term) -> Braces:
        # [a|T] is kept whole, as the last annotation.
        return Braces(True, tuple(terms) if isinstance(terms, List) else (terms,))

    def sequence(self, *children: Any) -> Term:
        if children and isinstance(children[-1], Marked):
            return OpenList(children[:-1], children[-1].value)
        return List(children)

    def tail(self, term: Term) -> Marked:
        return Marked("tail", term)

    @v_args(meta=True)
    def code(self, meta: Meta, children: list[Body]) -> Term:
        return Code(children[0], {variable: variable for variable in variables_of(children[0])})


def _literal(name: str, braces: list[Braces], negated: bool = False, space: str = "") -> Literal:
    args = next((brace.terms for brace in braces if not brace.annotations), ())
    annots = next((brace.terms for brace in braces if brace.annotations), ())
    return literal_of(predicate(name, len(args), negated, space), args, annots)


_ESCAPES = {"n": "\n", "t": "\t", "r": "\r"}


def _unescaped(text: str) -> str:
    if "\\" not in text:
        return text
    parts = iter(text)
    return "".join((_ESCAPES.get(after := next(parts, ""), after)) if char == "\\" else char for char in parts)
