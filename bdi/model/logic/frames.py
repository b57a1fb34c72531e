"""Data of compiled code: frames of variables, internal actions, questions."""

import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

from bdi.language.terms import AND, NOT, OR, Atom, Structure, Term, Var, is_internal
from bdi.language.unify import renamed, resolve, variables_in

Frame: TypeAlias = list[Any]  # a value for each variable of a plan; None until it is met
Test: TypeAlias = Callable[[Frame], Any]  # fills the frame and answers True, or None
Build: TypeAlias = Callable[[Frame], Any]
LONGEST_PROOF = 100_000  # calls; a step of a proof takes three to five


class Builtin(Protocol):
    """An internal action or function as compiled code calls it."""

    lazy: frozenset[int]  # arguments handed over as questions, not as values
    named: bool  # whether the variables of the plan, by name, come first

    def ask(self, args: tuple[Any, ...]) -> "bool | Iterator[Any]": ...


@contextmanager
def deep_stack() -> Iterator[None]:
    """Let Python functions call each other more deeply. Their frames are on the heap (CPython 3.11 and later)."""
    usual = sys.getrecursionlimit()
    sys.setrecursionlimit(max(usual, LONGEST_PROOF))
    try:
        yield
    finally:
        sys.setrecursionlimit(usual)


@dataclass(frozen=True, slots=True)
class Known:
    """Facts about the slots of a frame at one place of a program, before it runs."""

    filled: frozenset[Var] = frozenset()  # certainly not None
    met: frozenset[Var] = frozenset()  # perhaps not None

    def after(self, term: Term) -> "Known":
        """Return the facts once this formula has come true."""
        return Known(self.filled | filled_by(term), self.met | frozenset(variables_in(term)))

    def among(self, variables: Iterable[Var]) -> "Known":
        new = frozenset(variables)
        return Known(self.filled | new, self.met | new)


def filled_by(term: Term) -> frozenset[Var]:
    """The variables whose slots are certainly filled once the formula has come true."""
    key = term.predicate if isinstance(term, Atom | Structure) else None
    if key is NOT:
        return frozenset()
    if isinstance(term, Structure) and key in (AND, OR):
        left, right = (filled_by(part) for part in term.args)
        return left | right if key is AND else left & right
    if key is not None and is_internal(key.name):
        return frozenset()
    return frozenset(variables_in(term))


class Scope:
    """Which variable lives in which slot."""

    def __init__(self, first: int = 0) -> None:
        self.slots: dict[Var, int] = {}
        self.size = first

    def slot(self, variable: Var) -> int:
        found = self.slots.get(variable)
        if found is None:
            found = self.slots[variable] = self.size
            self.size += 1
        return found

    def add_all(self, variables: Iterable[Var]) -> None:
        for variable in variables:
            self.slot(variable)


class Asker(Protocol):
    def ask_within(self, ask: Callable[[], Any]) -> Any: ...
    def ask_deeply(self, ask: Callable[[], Any]) -> Any: ...


class Question:
    """A formula handed to an internal action, such as the second argument of `.findall`.

    `solve(*values, collect)` calls `collect` with the values of all variables concerned for every answer.
    """

    __slots__ = ("_asker", "_build", "_now", "_solve", "_values")

    def __init__(
        self,
        solve: Callable[..., Any],
        build: Callable[..., Term],
        now: Callable[..., Term],
        values: tuple[Any, ...],
        asker: "Asker",
    ) -> None:
        self._solve = solve
        self._build = build
        self._now = now
        self._values = values
        self._asker = asker

    def answers(self, template: "Question") -> list[Term]:
        """The template once for every way in which the formula is true."""
        build = template._build

        def ask() -> list[Term]:
            found: list[Term] = []
            self._solve(*self._values, lambda *values: found.append(renamed(build(*values), {})))
            return found

        answers: list[Term] = self._asker.ask_within(ask)
        return answers

    def first(self) -> bool:
        """Return whether the formula is true, whatever its variables."""
        return self._asker.ask_within(lambda: self._solve(*self._values, lambda *values: True)) is not None

    def bind_first(self) -> bool:
        """Return whether it is true; the variables that it was asked with keep what the first answer says."""
        return self._asker.ask_deeply(lambda: self._solve(*self._values, lambda *values: True)) is not None

    def term(self) -> Term:
        """The formula with what is known of its variables."""
        return resolve(self._now(*self._values))
