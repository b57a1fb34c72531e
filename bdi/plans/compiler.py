"""Plans compiled once: head and context to one function, the body to a chain of steps."""

from bdi.logic import Known, Logic, Scope, succeed
from bdi.plans.control import Control
from bdi.plans.heads import Heads
from bdi.plans.library import CompiledPlan, Library
from bdi.plans.steps import Doer
from bdi.terms import TRUE, Var


class Compiler:
    """Makes plans of one agent out of written ones."""

    def __init__(self, doer: Doer, logic: Logic) -> None:
        self.logic = logic
        self.library = Library(self)
        self._heads = Heads(logic)
        self._control = Control(doer, logic, self.library)

    def compile(self, compiled: CompiledPlan) -> None:
        plan = compiled.plan
        scope, met = Scope(), set[Var]()
        head = self._heads.head(plan, scope, met)
        known = Known().among(dict.fromkeys(met))
        context = None
        if plan.context is not None and plan.context is not TRUE:
            context = self.logic.formula(plan.context, scope, known, succeed)
            known = known.after(plan.context)
        if plan.condition is not None:
            compiled.condition = self._heads.silent(plan.condition, scope)
        compiled.first = self._control.chain(plan.body, scope, known, None)
        compiled.applicable = self._heads.applicable(plan, head, context, scope)
