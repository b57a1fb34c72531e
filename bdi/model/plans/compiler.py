"""Plans compiled once: head and context to one function, the body to a chain of steps."""

from collections.abc import Callable
from functools import partial

from bdi.language.syntax import Plan, variables_of
from bdi.language.terms import TRUE, Var
from bdi.language.unify import undo, variables_in
from bdi.model.intentions import NOT_WORKED_OUT, Event
from bdi.model.logic import Frame, Known, Logic, Scope
from bdi.model.plans.control import Control
from bdi.model.plans.library import Applicable, Choose, CompiledPlan, Library, Options
from bdi.model.plans.steps import Effects

MOST_AT_ONCE = 30  # plans; each that comes or goes means compiling them all again


class Compiler:
    """Makes plans of one agent out of written ones."""

    def __init__(self, effects: Effects, logic: Logic) -> None:
        self.logic = logic
        self.library = Library(self)
        self._control = Control(effects, logic, self.library)

    def compile(self, compiled: CompiledPlan, forget: Callable[[], None]) -> Applicable:
        """The body becomes steps of the plan; the answer is what tells whether the plan applies."""
        scope = self._prepared(compiled)
        return self.logic.applicable(compiled.plan, scope, forget, compiled.around)

    def choice(self, options: Options, forget: Callable[[], None]) -> Choose:
        """Join all heads and contexts to one function, as long as that is short and asks for no proof by rules."""
        if len(options) > MOST_AT_ONCE or any(self.logic.needs_rules(each.plan.context) for each in options):
            return partial(self.choose_one_by_one, options)
        try:
            return self.logic.choice([(each, each.plan, self._prepared(each)) for each in options], forget)
        except RecursionError:  # one of them is nested too deeply: that one does not apply
            return partial(self.choose_one_by_one, options)

    def choose_one_by_one(self, options: Options, event: Event) -> tuple[CompiledPlan, Frame] | None:
        trail = self.logic.trail
        for plan in options:
            try:
                frame = plan.applicable(event)
            except NOT_WORKED_OUT:
                frame = None  # a context that cannot be worked out does not hold
            if frame is not None:
                trail.clear()
                return plan, frame
            undo(trail, 0)
        return None

    def _prepared(self, compiled: CompiledPlan) -> Scope:
        """The steps of the body are made; the answer tells where its variables live."""
        plan, scope = compiled.plan, _scope_of(compiled.plan, compiled.around)
        context = None if plan.context is TRUE else plan.context
        if compiled.first is None:
            known = Known().among(
                {each: None for part in (plan.head, *plan.head_annots, *compiled.around) for each in variables_in(part)}
            )
            known = known if context is None else known.after(context)
            if plan.condition is not None:
                compiled.condition = self.logic.silent(plan.condition, scope)
            compiled.first = self._control.chain(plan.body, scope, known, None)
        if compiled.subplans is not None:
            compiled.places = {variable.name: slot for variable, slot in scope.slots.items()}
        return scope


def _scope_of(plan: Plan, around: tuple[Var, ...]) -> Scope:
    """A slot for every variable, those of the head first."""
    scope = Scope()
    written = (plan.head, *plan.head_annots, plan.context, plan.condition)
    for term in written:
        scope.add_all(() if term is None else variables_in(term))
    scope.add_all(around)
    scope.add_all(variables_of(plan.body))
    return scope
