"""What a program is made of, as the parser hands it over. Formulas are terms (see the operators in `terms`)."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TypeAlias

from bdi.errors import Place
from bdi.terms import Literal, Term, Var, show
from bdi.unify import variables_in


class Trigger(StrEnum):
    """What happened: belief, achievement goal or test goal, gained or lost."""

    BELIEF_ADDED = "+"
    BELIEF_REMOVED = "-"
    GOAL_ADDED = "+!"
    GOAL_FAILED = "-!"
    TEST_ADDED = "+?"
    TEST_FAILED = "-?"
    GOAL_STATE = "^!"
    TEST_STATE = "^?"


# By themselves for what runs in every cycle: reading a member off its Enum takes 90 ns in CPython 3.11.
BELIEF_ADDED, BELIEF_REMOVED, GOAL_ADDED = Trigger.BELIEF_ADDED, Trigger.BELIEF_REMOVED, Trigger.GOAL_ADDED


class Does(StrEnum):
    """What one step of a plan body does; the value is how it is written."""

    ACTION = ""
    INTERNAL = "."
    CONSTRAINT = "="
    ACHIEVE = "!"  # !g
    ACHIEVE_APART = "!!"  # !!g
    TEST = "?"  # ?g
    ADD = "+"  # +b
    ADD_APART = "++"  # ++b
    ADD_FIRST = "+<"  # +<b
    ADD_LAST = "+>"  # +>b
    REMOVE = "-"  # -b
    REMOVE_APART = "--"  # --b
    UPDATE = "-+"  # -+b
    VARIABLE = "X"  # a plan body held by a variable


@dataclass(frozen=True, slots=True)
class Simple:
    """`!g(X)`, `+b`, `p(1)`, `X > 2`: one step with one term."""

    does: Does
    term: Term
    place: Place

    def __str__(self) -> str:
        mark = "" if self.does in _UNMARKED else self.does.value
        return f"{mark}{show(self.term)}"


_UNMARKED = frozenset({Does.ACTION, Does.INTERNAL, Does.CONSTRAINT, Does.VARIABLE})


@dataclass(frozen=True, slots=True)
class If:
    """`if (c) {..} elif (d) {..} else {..}`; an elif is an If in the other branch."""

    condition: Term
    then: "Body"
    otherwise: "Body"
    place: Place

    def __str__(self) -> str:
        other = f" else {{{self.otherwise}}}" if self.otherwise.steps else ""
        return f"if ({show(self.condition)}) {{{self.then}}}{other}"


@dataclass(frozen=True, slots=True)
class While:
    """`while (c) {..}`."""

    condition: Term
    body: "Body"
    place: Place

    def __str__(self) -> str:
        return f"while ({show(self.condition)}) {{{self.body}}}"


@dataclass(frozen=True, slots=True)
class For:
    """`for (c) {..}`: once for every answer."""

    condition: Term
    body: "Body"
    place: Place

    def __str__(self) -> str:
        return f"for ({show(self.condition)}) {{{self.body}}}"


@dataclass(frozen=True, slots=True)
class Fork:
    """`a |&| b` waits for all branches, `a ||| b` for the first."""

    wait_for_all: bool
    branches: tuple["Body", ...]
    place: Place

    def __str__(self) -> str:
        mark = " |&| " if self.wait_for_all else " ||| "
        return mark.join(f"({branch})" for branch in self.branches)


Step: TypeAlias = Simple | If | While | For | Fork


@dataclass(frozen=True, slots=True)
class Body:
    steps: tuple[Step, ...] = ()

    def __str__(self) -> str:
        return "; ".join(map(str, self.steps))


@dataclass(frozen=True, slots=True)
class Plan:
    """`@label trigger : context <: condition <- body. { subplans }`. `head` may be a variable: `+!G`."""

    label: Literal
    trigger: Trigger
    head: Literal | Var
    context: Term | None
    body: Body
    place: Place
    condition: Term | None = None
    subplans: tuple["Plan", ...] = ()

    def has(self, annotation: str) -> bool:
        """Whether the label carries this annotation, as `@label[atomic]`."""
        return any(getattr(annot, "functor", "") == annotation for annot in self.label.annots)

    def __str__(self) -> str:
        context = f" : {show(self.context)}" if self.context is not None else ""
        body = f" <- {self.body}" if self.body.steps else ""
        return f"@{show(self.label)} {self.trigger}{show(self.head)}{context}{body}."


@dataclass(frozen=True, slots=True)
class Rule:
    """`head :- formula.`"""

    head: Literal
    formula: Term
    place: Place

    def __str__(self) -> str:
        return f"{show(self.head)} :- {show(self.formula)}."


@dataclass(frozen=True, slots=True)
class Directive:
    """`{ include("safety.asl") }`; the parser's caller carries it out."""

    term: Literal
    place: Place


@dataclass(frozen=True, slots=True)
class Belief:
    literal: Literal
    place: Place


@dataclass(frozen=True, slots=True)
class Goal:
    literal: Literal
    place: Place


Clause: TypeAlias = Belief | Rule | Goal | Plan | Directive


@dataclass(frozen=True, slots=True)
class Program:
    """A parsed program with its includes in place. Order within each kind is the order of the source."""

    source: str
    beliefs: tuple[Belief | Rule, ...] = ()
    goals: tuple[Goal, ...] = ()
    plans: tuple[Plan, ...] = ()
    sources: tuple[str, ...] = field(default=())


def variables_of(body: Body) -> dict[Var, None]:
    """The variables of a plan body, in order of appearance."""
    found: dict[Var, None] = {}
    for term in _terms_of(body):
        variables_in(term, found)
    return found


def _terms_of(body: Body) -> Iterator[Term]:
    for step in body.steps:
        if isinstance(step, Simple):
            yield step.term
        elif isinstance(step, Fork):
            for branch in step.branches:
                yield from _terms_of(branch)
        else:
            yield step.condition
            for inner in (step.then, step.otherwise) if isinstance(step, If) else (step.body,):
                yield from _terms_of(inner)
