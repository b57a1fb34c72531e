"""Plans as texts: `.add_plan`, `.remove_plan`, `.relevant_plans`."""

from bdi.builtin.arguments import event_in, text_of
from bdi.builtin.table import Answer, internal_action, wrong_arguments
from bdi.errors import AgentSpeakSyntaxError
from bdi.intentions import StepFailed
from bdi.mind import Mind
from bdi.parser import parse_plan
from bdi.syntax import Plan
from bdi.terms import List, String, Term, atom
from bdi.unify import unify


@internal_action("add_plan", 1, 3)
def add_plan(mind: Mind, plans: Term, source: Term | None = None, place: Term | None = None) -> Answer:
    """One plan or a list of them, as text; `begin` puts them before the others."""
    for each in plans if isinstance(plans, List) else (plans,):
        mind.add_plan(plan_of(each), first=place == atom("begin"))
    return True


def plan_of(term: Term) -> Plan:
    if not isinstance(term, String):
        raise wrong_arguments("add_plan", "a plan as text", term)
    try:
        return parse_plan(term)
    except AgentSpeakSyntaxError as error:
        raise StepFailed("wrong_arguments", str(error)) from error


@internal_action("remove_plan", 1, 2)
def remove_plan(mind: Mind, labels: Term, source: Term | None = None) -> Answer:
    found = [mind.remove_plan(text_of(each)) for each in (labels if isinstance(labels, List) else (labels,))]
    return all(found)


@internal_action("relevant_plans", 2, 3)
def relevant_plans(mind: Mind, trigger: Term, plans: Term, labels: Term | None = None) -> Answer:
    wanted = event_in(trigger)
    if wanted is None:
        raise wrong_arguments("relevant_plans", "an event", trigger)
    found = mind.library.options(wanted[0], wanted[1].predicate)
    texts = unify(plans, List([String(str(each.plan)) for each in found]), mind.logic.trail)
    return texts and (labels is None or unify(labels, List([atom(each.label) for each in found]), mind.logic.trail))
