"""Plans and rules that are learnt and forgotten by a step of a plan: `+{ +!g <- a }`, `-{ p :- q }`."""

from dataclasses import replace

from bdi.builtin.agent_state.beliefs import asserta, assertz
from bdi.builtin.agent_state.plans import add_plan
from bdi.builtin.code import with_values
from bdi.language.syntax import Does, Plan, Rule
from bdi.language.terms import Code, atom, show
from bdi.model.beliefs import Derivation
from bdi.model.intentions import StepFailed
from bdi.model.mind import Mind


def learn(mind: Mind, code: Code, does: Does) -> None:
    """+{…} learns (a plan after the others, a rule before the older ones; +<{…} and +>{…} say where), -{…} forgets.
    What is not known is forgotten already. Raises StepFailed for anything but a plan or a rule."""
    quoted = with_values(code)
    if not isinstance(quoted, Plan | Rule) or does not in _DEEDS:
        raise StepFailed("wrong_arguments", f"{does.value}{show(code)} is no plan or rule to learn or forget")
    if does in (Does.REMOVE, Does.REMOVE_APART):
        _forget_plan(mind, quoted) if isinstance(quoted, Plan) else _forget_rule(mind, quoted)
    elif isinstance(quoted, Plan):
        add_plan(mind, code, place=atom("begin") if does is Does.ADD_FIRST else None)
    else:
        (assertz if does is Does.ADD_LAST else asserta)(mind, code)


_DEEDS = frozenset(
    {Does.ADD, Does.ADD_APART, Does.ADD_FIRST, Does.ADD_LAST, Does.REMOVE, Does.REMOVE_APART},
)


def _forget_plan(mind: Mind, plan: Plan) -> None:
    """Forget a plan by its label; without one, every plan of the same text."""
    for known in list(mind.library.plans):
        written = known.plan if plan.label.functor else replace(known.plan, label=atom(""))
        if known.label == plan.label.functor or str(written) == str(plan):
            mind.plan_base.remove(known.label)


def _forget_rule(mind: Mind, rule: Rule) -> None:
    relation = mind.beliefs.relation(rule.head.predicate)
    for entry in list(relation.facts.values()):
        if isinstance(entry, Derivation) and str(entry.rule) == str(rule):
            relation.discard_rule(entry)
