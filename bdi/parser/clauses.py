"""Each rule of the grammar gets its meaning."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from lark import v_args
from lark.tree import Meta

from bdi.errors import (
    AgentSpeakSyntaxError,
)
from bdi.parser.steps import NO_LITERALS, believed, branch_of, step_of
from bdi.parser.terms import Braces, Marked, Terms
from bdi.syntax import (
    Belief,
    Body,
    Clause,
    Directive,
    Does,
    For,
    Fork,
    Goal,
    If,
    Plan,
    Rule,
    Simple,
    Step,
    Trigger,
    While,
)
from bdi.terms import (
    Atom,
    Code,
    Literal,
    Structure,
    Term,
    Var,
    atom,
    literal_of,
    predicate,
)


def with_own_labels(plans: list[Plan]) -> Iterator[Plan]:
    """Plans without a name get p__1, p__2, … in source order."""
    for count, plan in enumerate(plans, 1):
        if plan.label.functor:
            yield plan
        else:
            yield replace(plan, label=literal_of(predicate(f"p__{count}"), (), plan.label.annots))


@v_args(inline=True)
class Clauses(Terms):
    """Builds clauses bottom-up."""

    # -- clauses

    def program(self, *clauses: Clause | tuple[Plan, ...]) -> list[Clause]:
        kept: list[Clause] = []
        for clause in clauses:
            if not isinstance(clause, tuple):
                kept.append(clause)
            elif kept and isinstance(kept[-1], Plan):
                kept[-1] = replace(kept[-1], subplans=clause)
            else:
                raise AgentSpeakSyntaxError("these sub-plans follow no plan", clause[0].place)
        return kept

    @v_args(meta=True)
    def belief(self, meta: Meta, children: list[Literal]) -> Belief:
        self.variables = {}
        return Belief(children[0], self.place(meta))

    @v_args(meta=True)
    def rule(self, meta: Meta, children: list[Any]) -> Rule:
        self.variables = {}
        return Rule(children[0], children[1], self.place(meta))

    @v_args(meta=True)
    def goal(self, meta: Meta, children: list[Literal]) -> Goal:
        self.variables = {}
        return Goal(children[0], self.place(meta))

    @v_args(meta=True)
    def directive(self, meta: Meta, children: list[Literal]) -> Directive:
        return Directive(children[0], self.place(meta))

    @v_args(meta=True)
    def plan(self, meta: Meta, children: list[Any]) -> Plan:
        self.variables = {}
        parts = {child.kind: child.value for child in children if isinstance(child, Marked)}
        trigger, head = parts["trigger"]
        body = next((child for child in children if isinstance(child, Body)), Body())
        label = parts.get("label") or atom("")
        return Plan(label, trigger, head, parts.get("context"), body, self.place(meta), parts.get("condition"))

    def subplans(self, *plans: Plan) -> tuple[Plan, ...]:
        return tuple(with_own_labels(list(plans)))

    def label(self, label: Literal | Braces) -> Marked:
        if isinstance(label, Braces):
            label = literal_of(predicate(""), (), label.terms)
        return Marked("label", label)

    def trigger(self, *children: Any) -> Marked:
        *signs, head = children
        return Marked("trigger", (Trigger("".join(signs)), head))

    def context(self, formula: Term) -> Marked:
        return Marked("context", formula)

    def condition(self, formula: Term) -> Marked:
        return Marked("condition", formula)

    # -- bodies

    def body(self, *steps: Step) -> Body:
        return Body(steps)

    @v_args(meta=True)
    def formula_step(self, meta: Meta, children: list[Term]) -> Simple:
        """p(1)   .x(1)   X > 2   +b   ++b   -b   --b   -+b   X"""
        return step_of(children[0], self.place(meta))

    @v_args(meta=True)
    def achieve(self, meta: Meta, children: list[Term]) -> Simple:
        return Simple(Does.ACHIEVE, self.goal_term(children[0], meta), self.place(meta))

    @v_args(meta=True)
    def achieve_apart(self, meta: Meta, children: list[Term]) -> Simple:
        return Simple(Does.ACHIEVE_APART, self.goal_term(children[0], meta), self.place(meta))

    def goal_term(self, term: Term, meta: Meta) -> Term:
        if isinstance(term, Atom | Structure | Var | Code) and getattr(term, "predicate", None) not in NO_LITERALS:
            return term
        raise AgentSpeakSyntaxError(f"{term} cannot be a goal", self.place(meta), ("a name", "a variable"))

    @v_args(meta=True)
    def test(self, meta: Meta, children: list[Term]) -> Simple:
        return Simple(Does.TEST, children[0], self.place(meta))

    @v_args(meta=True)
    def add_first(self, meta: Meta, children: list[Term]) -> Simple:
        return Simple(Does.ADD_FIRST, believed(children[0], self.place(meta)), self.place(meta))

    @v_args(meta=True)
    def add_last(self, meta: Meta, children: list[Term]) -> Simple:
        return Simple(Does.ADD_LAST, believed(children[0], self.place(meta)), self.place(meta))

    @v_args(meta=True)
    def bracket(self, meta: Meta, children: list[Body]) -> Step:
        """( a; b ) is the condition-free `if`."""
        return If(atom("true"), children[0], Body(), self.place(meta))

    @v_args(meta=True)
    def or_fork(self, meta: Meta, children: list[Step]) -> Fork:
        return Fork(False, tuple(branch_of(child) for child in children), self.place(meta))

    @v_args(meta=True)
    def and_fork(self, meta: Meta, children: list[Step]) -> Fork:
        return Fork(True, tuple(branch_of(child) for child in children), self.place(meta))

    @v_args(meta=True)
    def if_step(self, meta: Meta, children: list[Any]) -> If:
        condition, then, *rest = children
        otherwise = rest[0] if rest else Body()
        return If(condition, then, otherwise if isinstance(otherwise, Body) else Body((otherwise,)), self.place(meta))

    elif_step = if_step

    @v_args(meta=True)
    def while_step(self, meta: Meta, children: list[Any]) -> While:
        return While(children[0], children[1], self.place(meta))

    @v_args(meta=True)
    def for_step(self, meta: Meta, children: list[Any]) -> For:
        return For(children[0], children[1], self.place(meta))
