"""The frame of a formula: which variable lives in which slot, and what is known of the slots."""

import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

from bdi.terms import (
    AND,
    INTERNAL,
    NOT,
    OR,
    TRUE,
    Atom,
    Structure,
    Term,
    Var,
)
from bdi.unify import (
    resolve,
    variables_in,
)

Frame: TypeAlias = list[Any]
Solve: TypeAlias = Callable[[Frame], bool]
Build: TypeAlias = Callable[[Frame], Term]
Match: TypeAlias = Callable[[Frame, Term], bool]
LONGEST_PROOF = 100_000  # calls; a step of a proof takes three to five
DEEPEST_QUESTIONS = 100  # `.findall` within `.findall` of the same place
RULE_SLOTS = 2  # a rule's frame begins with what comes after the call, and the caller's frame


class Builtin(Protocol):
    """What `logic` needs to know of an internal action or function: how to call it."""

    lazy: frozenset[int]  # arguments handed over as questions, not as values
    named: bool  # whether the variables of the plan, by name, come first

    def ask(self, args: tuple[Any, ...]) -> "bool | Iterator[Any]": ...


@dataclass(frozen=True, slots=True)
class Known:
    """What is known of the slots at one place of a program, before it runs."""

    filled: frozenset[Var] = frozenset()  # certainly not None
    met: frozenset[Var] = frozenset()  # perhaps not None

    def after(self, term: Term) -> "Known":
        """Once this formula has come true."""
        return Known(self.filled | filled_by(term), self.met | frozenset(variables_in(term)))

    def among(self, variables: Iterable[Var]) -> "Known":
        new = frozenset(variables)
        return Known(self.filled | new, self.met | new)


@contextmanager
def deep_stack() -> Iterator[None]:
    """Let Python functions call each other more deeply. Their frames are on the heap (CPython 3.11 and later)."""
    usual = sys.getrecursionlimit()
    sys.setrecursionlimit(max(usual, LONGEST_PROOF))
    try:
        yield
    finally:
        sys.setrecursionlimit(usual)


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


class Question:
    """A formula handed to an internal action, such as the second argument of `.findall`, with the frame it is about."""

    __slots__ = ("_answers", "build", "frame", "mark")

    def __init__(self, frame: Frame, build: Build, answers: Callable[[Frame, Build], list[Term]]) -> None:
        self.frame = frame
        self.build = build
        self._answers = answers

    def answers(self, template: "Question") -> list[Term]:
        """The template once for every way in which the formula is true."""
        return self._answers(self.frame, template.build)

    def first(self) -> bool:
        """Whether the formula is true, whatever its variables."""
        return bool(self._answers(self.frame, lambda frame: TRUE))

    def term(self) -> Term:
        return resolve(self.build(self.frame))


def filled_by(term: Term) -> frozenset[Var]:
    """The variables whose slots are certainly filled once the formula has come true."""
    key = term.predicate if isinstance(term, Atom | Structure) else None
    if key is NOT:
        return frozenset()
    if isinstance(term, Structure) and key in (AND, OR):
        left, right = (filled_by(part) for part in term.args)
        return left | right if key is AND else left & right
    if key is not None and key.name.startswith(INTERNAL):
        return frozenset()
    return frozenset(variables_in(term))


def succeed(frame: Frame) -> bool:
    return True


def fail(frame: Frame) -> bool:
    return False


def proved(frame: Frame) -> bool:
    """The end of a rule: go on where it was called."""
    answer: bool = frame[0](frame[1])
    return answer
