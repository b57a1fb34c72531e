"""When a plan applies: head and context as one function of the event."""

from typing import Any

from bdi.intentions import Event
from bdi.logic import Frame, Known, Logic, Match, Scope, Solve, succeed
from bdi.plans.library import Applicable
from bdi.syntax import Plan
from bdi.terms import Literal, Term, Var
from bdi.unify import undo, unify_annots, variables_in


class Heads:
    """Compiles heads and contexts."""

    def __init__(self, logic: Logic) -> None:
        self.logic = logic

    def head(self, plan: Plan, scope: Scope, met: set[Var]) -> list[Any]:
        if isinstance(plan.head, Var):
            return [self.logic.match(plan.head, scope, met)]
        return [self.logic.match(part, scope, met) for part in plan.head.args]

    def applicable(self, plan: Plan, head: list[Any], context: Solve | None, scope: Scope) -> Applicable:
        if isinstance(plan.head, Var):
            return _applicable_any(head[0], context, [None] * scope.size)
        args = plan.head.args
        if plan.head.annots:
            return self._applicable_annotated(plan.head, head, context, scope)
        if len({arg for arg in args if type(arg) is Var}) == len(args):
            return _applicable_variables(context, [None] * (scope.size - len(args)))
        return _applicable_patterns(head, context, [None] * scope.size)

    def _applicable_annotated(
        self, pattern: Literal, head: list[Any], context: Solve | None, scope: Scope
    ) -> Applicable:
        wanted = [self.logic.build(annot, scope) for annot in pattern.annots]
        matches = _applicable_patterns(head, None, [None] * scope.size)
        trail = self.logic.trail

        def applicable(event: Event) -> Frame | None:
            frame = matches(event)
            if frame is None or not unify_annots(tuple([annot(frame) for annot in wanted]), event.annots, trail):
                return None
            return frame if context is None or context(frame) else None

        return applicable

    def silent(self, formula: Term, scope: Scope) -> Solve:
        """Whether it holds, leaving no trace in frame or variables."""
        for variable in variables_in(formula):
            scope.slot(variable)
        solve = self.logic.compile(formula, scope, Known(met=frozenset(variables_in(formula))), succeed)
        trail = self.logic.trail

        def holds(frame: Frame) -> bool:
            found = solve(frame[:])
            undo(trail, 0)
            return found

        return holds


def _applicable_variables(context: Solve | None, empty: Frame) -> Applicable:
    """A head of different variables takes the arguments as they are."""
    if context is None:
        return lambda event: [*event.args, *empty]

    def applicable(event: Event) -> Frame | None:
        frame = [*event.args, *empty]
        return frame if context(frame) else None

    return applicable


def _applicable_patterns(head: list[Match], context: Solve | None, empty: Frame) -> Applicable:
    def applicable(event: Event) -> Frame | None:
        frame = empty[:]
        for match, arg in zip(head, event.args, strict=True):
            if not match(frame, arg):
                return None
        return frame if context is None or context(frame) else None

    return applicable


def _applicable_any(match: Match, context: Solve | None, empty: Frame) -> Applicable:
    """+!G: the variable is the whole event."""

    def applicable(event: Event) -> Frame | None:
        frame = empty[:]
        if not match(frame, event.literal):
            return None
        return frame if context is None or context(frame) else None

    return applicable
