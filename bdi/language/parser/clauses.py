"""Each rule of the grammar gets its meaning."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import Any

from bdi.language.errors import (
    AgentSpeakSyntaxError,
)
from bdi.language.parser.steps import NO_LITERALS, Run, believed, branch_of, run_together, step_of
from bdi.language.parser.terms import Braces, Marked, Terms
from bdi.language.syntax import (
    Belief,
    Body,
    Clause,
    CompatibilityWarning,
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
from bdi.language.terms import (
    ANNOTATED,
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


def with_own_labels(plans: list[Plan], first: int = 1) -> Iterator[Plan]:
    """Plans without a name get p__1, p__2, … in source order."""
    for count, plan in enumerate(plans, first):
        if plan.label.functor:
            yield plan
        else:
            yield replace(plan, label=literal_of(predicate(f"p__{count}"), (), plan.label.annots))


Warn = Callable[[CompatibilityWarning], None]


class Clauses(Terms):
    """Builds clauses bottom-up. Each method has the name of its rule in the grammar."""

    def __init__(self, text: str, source: str, warn: Warn | None = None) -> None:
        super().__init__(text, source)
        self.warn = warn  # of what older programs write

    # -- clauses

    def program(self, *clauses: Clause | tuple[Plan, ...]) -> list[Clause]:
        return self._with_subplans(clauses)

    def _with_subplans(self, clauses: Iterable[Clause | tuple[Plan, ...]]) -> list[Clause]:
        kept: list[Clause] = []
        for clause in clauses:
            if not isinstance(clause, tuple):
                kept.append(clause)
            elif kept and isinstance(kept[-1], Plan):
                kept[-1] = replace(kept[-1], subplans=clause)
            else:
                raise AgentSpeakSyntaxError("these sub-plans follow no plan", clause[0].place)
        return kept

    def belief(self, literal: Literal) -> Belief:
        self.variables = {}
        return Belief(literal, self.place)

    def rule(self, head: Literal, formula: Term) -> Rule:
        self.variables = {}
        return self.rule_value(head, formula)

    def rule_value(self, head: Literal, formula: Term) -> Rule:
        return Rule(head, formula, self.place)

    def goal(self, literal: Literal) -> Goal:
        self.variables = {}
        return Goal(literal, self.place)

    def directive(self, term: Literal) -> Directive:
        self.variables = {}
        return Directive(term, self.place)

    def block(self, term: Literal, *clauses: Any) -> Directive:
        self.variables = {}
        return Directive(term, self.place, tuple(self._with_subplans(clauses)))

    def plan(self, *parts: Any) -> Plan:
        self.variables = {}
        return self.plan_value(*parts)

    def plan_value(self, *parts: Any) -> Plan:
        named = {part.kind: part.value for part in parts if isinstance(part, Marked)}
        trigger, head = named["trigger"]
        annots: tuple[Term, ...] = ()
        if isinstance(head, Structure) and head.predicate is ANNOTATED:  # +!G[source(S)]
            annots, head = head.annots, head.args[0]
        body = next((part for part in parts if isinstance(part, Body)), Body())
        label = named.get("label") or atom("")
        context, condition = named.get("context"), named.get("condition")
        return Plan(label, trigger, head, context, body, self.place, condition, head_annots=annots)

    def subplans(self, *plans: Any) -> tuple[Plan, ...]:
        kept = self._with_subplans(plans)
        return tuple(with_own_labels([plan for plan in kept if isinstance(plan, Plan)]))

    def label_variable(self, label: Var | Structure) -> Marked:
        """Label of a plan as a value: { @L +!G <- B }"""
        return Marked("label", Structure(ANNOTATED, (label,)))

    def label(self, label: Literal | Braces) -> Marked:
        if isinstance(label, Braces):
            label = literal_of(predicate(""), (), label.terms)
        return Marked("label", label)

    def trigger(self, *parts: Any) -> Marked:
        *signs, head = parts
        return Marked("trigger", (Trigger("".join(signs)), head))

    def context(self, formula: Term) -> Marked:
        return Marked("context", formula)

    def condition(self, formula: Term) -> Marked:
        return Marked("condition", formula)

    # -- bodies

    def body(self, *steps: Step | Run) -> Body:
        return Body(tuple(each for step in steps for each in (step.steps if isinstance(step, Run) else (step,))))

    def formula_step(self, formula: Term) -> Simple | Run:
        """p(1)   .x(1)   X > 2   +b   ++b   -b   --b   -+b   X"""
        terms = run_together(formula)
        if len(terms) == 1:
            return step_of(formula, self.place)
        steps = tuple(step_of(term, self.place) for term in terms)
        sentence = f"';' is missing between {steps[0]} and {steps[1]}"
        if self.warn is None:
            raise AgentSpeakSyntaxError(sentence, self.place)
        self.warn(CompatibilityWarning(self.place, sentence, ";"))
        return Run(steps)

    def achieve(self, term: Term) -> Simple:
        return Simple(Does.ACHIEVE, self._goal_term(term), self.place)

    def achieve_apart(self, term: Term) -> Simple:
        return Simple(Does.ACHIEVE_APART, self._goal_term(term), self.place)

    def _goal_term(self, term: Term) -> Term:
        if isinstance(term, Atom | Structure | Var | Code) and getattr(term, "predicate", None) not in NO_LITERALS:
            return term
        raise AgentSpeakSyntaxError(f"{term} cannot be a goal", self.place, ("a name", "a variable"))

    def test(self, term: Term) -> Simple:
        return Simple(Does.TEST, term, self.place)

    def add_first(self, term: Term) -> Simple:
        return Simple(Does.ADD_FIRST, believed(term, self.place), self.place)

    def add_last(self, term: Term) -> Simple:
        return Simple(Does.ADD_LAST, believed(term, self.place), self.place)

    def bracket(self, body: Body) -> Run:
        """( a; b ): its steps are those of the body around it."""
        return Run(body.steps)

    def fork_all(self, *branches: Step) -> Fork:
        return Fork(True, tuple(branch_of(branch) for branch in branches), self.place)

    def fork_any(self, *branches: Step) -> Fork:
        return Fork(False, tuple(branch_of(branch) for branch in branches), self.place)

    def if_step(self, condition: Term, then: Body, otherwise: Body | If | None = None) -> If:
        if otherwise is None:
            otherwise = Body()
        return If(condition, then, otherwise if isinstance(otherwise, Body) else Body((otherwise,)), self.place)

    def while_step(self, condition: Term, body: Body) -> While:
        return While(condition, body, self.place)

    def for_step(self, condition: Term, body: Body) -> For:
        return For(condition, body, self.place)
