"""The syntax tree of a program. Formulas are terms (see the operators in `terms`)."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any, TypeAlias, TypeVar

from bdi.language.errors import Place
from bdi.language.terms import (
    ANNOTATED,
    Code,
    List,
    Literal,
    OpenList,
    Predicate,
    String,
    Structure,
    Term,
    Var,
    atom,
    show,
)
from bdi.language.unify import variables_in


class Trigger(StrEnum):
    """The kind of an event: belief, achievement goal or test goal, gained or lost."""

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
    """The kinds of steps of a plan body; the value is the notation."""

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


_ESCAPES = str.maketrans({"\\": "\\\\", '"': '\\"', "\n": "\\n", "\t": "\\t", "\r": "\\r", "\b": "\\b", "\f": "\\f"})


def written(term: Term) -> str:
    """A term as a program writes it: unlike in `show`, strings have their escapes."""
    text = show(term)
    return show(_escaped(term)) if '"' in text else text


def _escaped(term: Term) -> Term:
    if isinstance(term, String):
        return String(str.__str__(term).translate(_ESCAPES))
    if isinstance(term, Structure):
        return Structure(term.predicate, tuple(map(_escaped, term.args)), tuple(map(_escaped, term.annots)))
    if isinstance(term, List):
        return List(map(_escaped, term))
    return OpenList(tuple(map(_escaped, term.items)), _escaped(term.tail)) if isinstance(term, OpenList) else term


@dataclass(frozen=True, slots=True)
class Simple:
    """`!g(X)`, `+b`, `p(1)`, `X > 2`: one step with one term."""

    does: Does
    term: Term
    place: Place

    def __str__(self) -> str:
        mark = "" if self.does in _UNMARKED else self.does.value
        return f"{mark}{written(self.term)}"


_UNMARKED = frozenset({Does.ACTION, Does.INTERNAL, Does.CONSTRAINT, Does.VARIABLE})


@dataclass(frozen=True, slots=True)
class If:
    """`if (c) {..} elif (d) {..} else {..}`; an elif is an If in the other branch."""

    condition: Term
    then: "Body"
    otherwise: "Body"
    place: Place

    def __str__(self) -> str:
        other = ""
        if len(self.otherwise.steps) == 1 and isinstance(self.otherwise.steps[0], If):
            other = f" el{self.otherwise}"
        elif self.otherwise.steps:
            other = f" else {{{self.otherwise}}}"
        return f"if ({written(self.condition)}) {{{self.then}}}{other}"


@dataclass(frozen=True, slots=True)
class While:
    """`while (c) {..}`."""

    condition: Term
    body: "Body"
    place: Place

    def __str__(self) -> str:
        return f"while ({written(self.condition)}) {{{self.body}}}"


@dataclass(frozen=True, slots=True)
class For:
    """`for (c) {..}`: once for every answer."""

    condition: Term
    body: "Body"
    place: Place

    def __str__(self) -> str:
        return f"for ({written(self.condition)}) {{{self.body}}}"


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
    """`@label trigger : context <: condition <- body. { subplans }`. `head` may be a variable: `+!G[source(S)]`."""

    label: Literal
    trigger: Trigger
    head: Literal | Var
    context: Term | None
    body: Body
    place: Place
    condition: Term | None = None
    subplans: tuple["Plan", ...] = ()
    head_annots: tuple[Term, ...] = ()  # where the head is a variable

    def has(self, annotation: str) -> bool:
        """Return whether the label carries this annotation, as `@label[atomic]`."""
        return any(getattr(annot, "functor", "") == annotation for annot in self.label.annots)

    def __str__(self) -> str:
        label = f"@{written(self.label)} " if self.label.functor or self.label.annots else ""
        head = Structure(ANNOTATED, (self.head,), self.head_annots) if self.head_annots else self.head
        context = f" : {written(self.context)}" if self.context is not None else ""
        condition = f" <: {written(self.condition)}" if self.condition is not None else ""
        body = f" <- {self.body}" if self.body.steps else ""
        inner = f" {{ {' '.join(map(str, self.subplans))} }}" if self.subplans else ""
        return f"{label}{self.trigger}{written(head)}{context}{condition}{body}.{inner}"


@dataclass(frozen=True, slots=True)
class Rule:
    """`head :- formula.`"""

    head: Literal
    formula: Term
    place: Place

    def __str__(self) -> str:
        return f"{written(self.head)} :- {written(self.formula)}."


@dataclass(frozen=True, slots=True)
class Directive:
    """`{ include("safety.asl") }`, or `{ begin term } clauses { end }`; the parser's caller carries it out."""

    term: Literal
    place: Place
    clauses: "tuple[Clause, ...] | None" = None  # of its block; None where there is none


@dataclass(frozen=True, slots=True)
class Belief:
    literal: Literal
    place: Place


@dataclass(frozen=True, slots=True)
class Goal:
    literal: Literal
    place: Place


@dataclass(frozen=True, slots=True)
class Function:
    """`{ register_function("name", arity, "rule") }`: `name(X)` is the Y for which `rule(X,Y)` holds."""

    name: str
    arity: int
    target: Predicate  # of the rule or internal action, with the result as its last argument
    place: Place


Quoted = TypeVar("Quoted", bound="Body | Plan | Rule")  # what a value in braces can hold

Clause: TypeAlias = Belief | Rule | Goal | Plan | Directive


@dataclass(frozen=True, slots=True)
class CompatibilityWarning:
    """Something written as in older programs: `sentence` says what, `today` is what to write."""

    place: Place
    sentence: str
    today: str

    def __str__(self) -> str:
        return f"{self.place}: {self.sentence}{self.place.picture()}"


@dataclass(frozen=True, slots=True)
class Program:
    """A parsed program with its includes in place. Order within each kind is the order of the source."""

    source: str
    beliefs: tuple[Belief | Rule, ...] = ()
    goals: tuple[Goal, ...] = ()
    plans: tuple[Plan, ...] = ()
    sources: tuple[str, ...] = field(default=())
    functions: tuple[Function, ...] = ()
    namespaces: int = 0  # how many local and fresh ones it has: each is named by its number
    warnings: tuple[CompatibilityWarning, ...] = ()  # in the compatibility mode

    def joined(self, more: "Program") -> "Program":
        """Return both programs as one: the loaded one, then the one added by `.include`."""
        parts = ("beliefs", "goals", "plans", "sources", "functions")
        both = {name: getattr(self, name) + getattr(more, name) for name in parts}
        return Program(self.source, **both, namespaces=more.namespaces)


def variables_of(quoted: Body | Plan | Rule) -> dict[Var, None]:
    """The variables of a plan body, plan or rule, in order of appearance."""
    found: dict[Var, None] = {}
    for term in terms_of(quoted):
        variables_in(term, found)
    return found


def terms_of(quoted: Body | Plan | Rule) -> Iterator[Term]:
    """The terms of a plan body, plan or rule, in order of appearance; those inside them are not given apart."""
    if isinstance(quoted, Rule):
        yield from (quoted.head, quoted.formula)
    elif isinstance(quoted, Plan):
        yield from (quoted.label, quoted.head, *quoted.head_annots)
        yield from (formula for formula in (quoted.context, quoted.condition) if formula is not None)
        yield from terms_of(quoted.body)
    else:
        for step in quoted.steps:
            yield from _terms_of(step)


def _terms_of(step: Step) -> Iterator[Term]:
    if isinstance(step, Simple):
        yield step.term
    elif isinstance(step, Fork):
        for branch in step.branches:
            yield from terms_of(branch)
    else:
        yield step.condition
        for inner in (step.then, step.otherwise) if isinstance(step, If) else (step.body,):
            yield from terms_of(inner)


def with_terms(quoted: Quoted, change: Callable[[Any], Any]) -> Quoted:
    """The same plan body, plan or rule with each of its terms changed."""
    if isinstance(quoted, Rule):
        return replace(quoted, head=change(quoted.head), formula=change(quoted.formula))
    if isinstance(quoted, Body):
        return replace(quoted, steps=tuple(_with_terms(step, change) for step in quoted.steps))
    return replace(
        quoted,
        label=change(quoted.label),
        head=change(quoted.head),
        head_annots=tuple(map(change, quoted.head_annots)),
        context=None if quoted.context is None else change(quoted.context),
        condition=None if quoted.condition is None else change(quoted.condition),
        body=with_terms(quoted.body, change),
        subplans=tuple(with_terms(inner, change) for inner in quoted.subplans),
    )


def _with_terms(step: Step, change: Callable[[Any], Any]) -> Step:
    if isinstance(step, Simple):
        return replace(step, term=change(step.term))
    if isinstance(step, Fork):
        return replace(step, branches=tuple(with_terms(branch, change) for branch in step.branches))
    if isinstance(step, If):
        then, otherwise = with_terms(step.then, change), with_terms(step.otherwise, change)
        return replace(step, condition=change(step.condition), then=then, otherwise=otherwise)
    return replace(step, condition=change(step.condition), body=with_terms(step.body, change))


def event_of(quoted: Body | Plan | Rule) -> tuple[Trigger, Literal | Var] | None:
    """{+!g(X)} as an event, also {+b} which is a plan body as well; None for anything else."""
    if isinstance(quoted, Plan):
        return quoted.trigger, quoted.head
    if isinstance(quoted, Body) and len(quoted.steps) == 1 and isinstance(quoted.steps[0], Simple):
        step = quoted.steps[0]
        if step.does in (Does.ADD, Does.REMOVE) and not isinstance(step.term, Code):
            return Trigger(step.does.value), step.term  # type: ignore[return-value]
    return None


def event_alone(plan: Plan) -> Body | Plan:
    """Return the event that `{+!g(X)}` or `{+b}` consists of."""
    if plan.trigger in (BELIEF_ADDED, BELIEF_REMOVED):
        return Body((Simple(Does(plan.trigger.value), plan.head, plan.place),))
    return Plan(atom(""), plan.trigger, plan.head, None, Body(), plan.place, head_annots=plan.head_annots)
