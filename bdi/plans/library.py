"""The plans of an agent, found by trigger and predicate."""

from collections.abc import Callable
from typing import Protocol

from bdi.intentions import Event, Step
from bdi.logic import Frame, Solve
from bdi.syntax import Plan, Trigger
from bdi.terms import Literal, Predicate, Var
from bdi.unify import Trail, renamed, undo, unify

Applicable = Callable[[Event], "Frame | None"]  # the filled frame if head and context hold


class PlanCompiler(Protocol):
    def compile(self, compiled: "CompiledPlan") -> None: ...


class CompiledPlan:
    """A plan of one agent. Compiled when it is first considered."""

    __slots__ = ("_compiler", "applicable", "atomic", "condition", "first", "label", "plan", "subplans")

    def __init__(self, plan: Plan, compiler: PlanCompiler) -> None:
        self.plan = plan
        self.label = plan.label.functor
        self.atomic = plan.has("atomic")
        self.applicable: Applicable = self._compile_then_apply
        self.first: Step | None = None
        self.condition: Solve | None = None
        self.subplans = Library(compiler, plan.subplans) if plan.subplans else None
        self._compiler = compiler

    def _compile_then_apply(self, event: Event) -> Frame | None:
        self._compiler.compile(self)
        return self.applicable(event)

    def concerns(self, literal: Literal) -> bool:
        """Whether the head unifies, whatever the context says: then the plan is relevant."""
        trail: Trail = []
        found = unify(self.plan.head, renamed(literal, {}), trail)
        undo(trail, 0)
        return found


Options = list[CompiledPlan]


def relevant(options: Options, literal: Literal) -> Options:
    """Those whose head unifies with the event; if all do, the very list, which is kept up to date."""
    found = [plan for plan in options if plan.concerns(literal)]
    return options if len(found) == len(options) else found


class Library:
    """Plans by trigger and predicate, each list in source order. A list, once handed out, is kept up to date."""

    def __init__(self, compiler: PlanCompiler, plans: tuple[Plan, ...] = ()) -> None:
        self.compiler = compiler
        self.plans: list[CompiledPlan] = []
        self._options: dict[tuple[Trigger, Predicate], Options] = {}
        for plan in plans:
            self.add(plan)

    def options(self, trigger: Trigger, key: Predicate) -> Options:
        """The plans that could react: those with this predicate, and those whose trigger is a variable."""
        found = self._options.get((trigger, key))
        if found is None:
            found = [plan for plan in self.plans if _reacts(plan.plan, trigger, key)]
            self._options[trigger, key] = found
        return found

    def add(self, plan: Plan, first: bool = False) -> CompiledPlan:
        compiled = CompiledPlan(plan, self.compiler)
        for options in (self.plans, *self._options_with(plan)):
            options.insert(0 if first else len(options), compiled)
        return compiled

    def remove(self, label: str) -> bool:
        """Whether there was a plan with this label."""
        doomed = [plan for plan in self.plans if plan.label == label]
        for plan in doomed:
            for options in (self.plans, *self._options_with(plan.plan)):
                options.remove(plan)
        return bool(doomed)

    def _options_with(self, plan: Plan) -> list[Options]:
        return [found for (trigger, key), found in self._options.items() if _reacts(plan, trigger, key)]


def _reacts(plan: Plan, trigger: Trigger, key: Predicate) -> bool:
    return plan.trigger is trigger and (isinstance(plan.head, Var) or plan.head.predicate is key)
