"""Plans and rules as terms: `.add_plan`, `.remove_plan`, `.relevant_plans`, `.plan_label`, `.relevant_rules`, …"""

from collections.abc import Iterator
from dataclasses import replace
from itertools import count

from bdi.builtin.arguments import alternatives, text_of, unifiable
from bdi.builtin.code import plan_in, trigger_in
from bdi.builtin.kinds import ANY, ATOM, EVENT, LITERAL, OUT, optional
from bdi.builtin.table import Answer, internal_action, wrong_arguments
from bdi.language.syntax import Body, Plan, Rule, Trigger
from bdi.language.terms import Atom, Code, List, Literal, String, Structure, Term, Var, atom, literal_of
from bdi.language.unify import unify
from bdi.model.beliefs import SELF, SOURCE, Derivation
from bdi.model.intentions import StepFailed
from bdi.model.mind import Mind
from bdi.model.plans import CompiledPlan

# ---- changing ------------------------------------------------------------------------------------------------------


@internal_action("add_plan", ANY, optional(ANY), optional(ATOM))
def add_plan(mind: Mind, plans: Term, source: Term = SELF.args[0], place: Term | None = None) -> Answer:
    """One plan or a list of them, from this source; `begin` puts them before the others."""
    for each in plans if isinstance(plans, List) else (plans,):
        plan = _labelled(mind, plan_in(each, "add_plan"), source)
        if not _is_there(mind, plan):
            mind.plan_base.add(plan, first=place is atom("begin"))
    return True


def _labelled(mind: Mind, plan: Plan, source: Term) -> Plan:
    """A plan without a name gets a new one; the name of a plan from another agent says whose it is."""
    key, args, annots = plan.label.predicate, plan.label.args, plan.label.annots
    if not key.name:
        taken = {compiled.label for compiled in mind.library.plans}
        name = next(name for name in (f"p__{number}" for number in count(1)) if name not in taken)
        key = atom(name).predicate
    if source is not SELF.args[0]:
        annots = (*annots, Structure(SOURCE, (source,)))
    return replace(plan, label=literal_of(key, args, annots))


def _is_there(mind: Mind, plan: Plan) -> bool:
    """Return whether this very plan is known. Raises StepFailed for another one of this name."""
    for compiled in mind.library.plans:
        if compiled.label == str(plan.label.predicate):
            if str(compiled.plan) == str(plan):
                return True
            raise StepFailed("ia_failed", f"there is another plan {compiled.label} already")
    return False


@internal_action("remove_plan", ANY, optional(ATOM))
def remove_plan(mind: Mind, labels: Term, source: Term = SELF.args[0]) -> Answer:
    """The plans with these labels (or these plans) that come from this source."""
    for each in list(labels) if isinstance(labels, List) else [labels]:
        label = _label_in(each)
        for compiled in list(mind.library.plans):
            if compiled.label == label and source in _sources(compiled.plan):
                mind.plan_base.remove(label)
    return True


def _label_in(term: Term) -> str:
    if isinstance(term, Code) and isinstance(term.body, Plan):
        return str(term.body.label.predicate)
    if isinstance(term, Atom | Structure):
        return str(term.predicate)
    if isinstance(term, String):
        return text_of(term).removeprefix("@")
    raise wrong_arguments("remove_plan", "the label of a plan", term)


def _sources(plan: Plan) -> list[Term]:
    found = [annot.args[0] for annot in plan.label.annots if isinstance(annot, Structure) and annot.predicate is SOURCE]
    return found or [SELF.args[0]]


# ---- looking -------------------------------------------------------------------------------------------------------


def _relevant(mind: Mind, term: Term, name: str) -> list[CompiledPlan]:
    """The plans for an event, whatever their contexts say; {+!_} asks for those of every goal."""
    event = trigger_in(term)
    if event is None:
        raise wrong_arguments(name, "an event, as {+!g(X)}", term)
    return [plan for plan in mind.library.plans if concerns(mind, plan.plan, *event)]


def concerns(mind: Mind, plan: Plan, trigger: Trigger, head: Literal | Var) -> bool:
    """Return whether it is a plan for this event, whatever their annotations are."""
    if plan.trigger is not trigger:
        return False
    if isinstance(head, Var) or isinstance(plan.head, Var):
        return True
    wanted, known = (literal_of(each.predicate, each.args) for each in (head, plan.head))
    return unifiable(mind, wanted, known)


def _as_term(plan: Plan) -> Code:
    return Code(plan)


@internal_action("relevant_plans", EVENT, OUT, optional(OUT))
def relevant_plans(mind: Mind, event: Term, plans: Term, labels: Term | None = None) -> Answer:
    found = [compiled.plan for compiled in _relevant(mind, event, "relevant_plans")]
    unified = unify(plans, List([_as_term(plan) for plan in found]), mind.logic.trail)
    return unified and (labels is None or unify(labels, List([plan.label for plan in found]), mind.logic.trail))


@internal_action("relevant_plan", ANY, OUT)
def relevant_plan(mind: Mind, event: Term, plan: Term) -> Answer:
    """Each relevant plan in turn; of a given plan, its event."""
    if isinstance(event, Var) and isinstance(plan, Code) and isinstance(plan.body, Plan):
        quoted = plan.body
        return unify(
            event, Code(replace(quoted, label=atom(""), context=None, body=Body()), plan.scope), mind.logic.trail
        )
    found = _relevant(mind, event, "relevant_plan")
    return alternatives(mind, (((plan, _as_term(each.plan)),) for each in found))


@internal_action("plan_label", OUT, OUT)
def plan_label(mind: Mind, plan: Term, label: Term) -> Answer:
    """The plan with this label, or the label of this plan; of two variables every pair."""
    known = [compiled.plan for compiled in mind.library.plans]
    return alternatives(mind, (((label, each.label), (plan, _as_term(each))) for each in known))


@internal_action("list_plans", optional(EVENT))
def list_plans(mind: Mind, event: Term | None = None) -> Answer:
    for compiled in mind.library.plans if event is None else _relevant(mind, event, "list_plans"):
        mind.say(str(compiled.plan))
    return True


# ---- rules ---------------------------------------------------------------------------------------------------------


@internal_action("relevant_rules", LITERAL, OUT)
def relevant_rules(mind: Mind, literal: Literal, rules: Term) -> Answer:
    """The rules that could derive this."""
    entries = reversed(list(mind.beliefs.relation(literal.predicate).facts.values()))
    found = [entry.rule for entry in entries if isinstance(entry, Derivation)]
    return unify(rules, List([Code(rule) for rule in found if unifiable(mind, literal, rule.head)]), mind.logic.trail)


@internal_action("list_rules")
def list_rules(mind: Mind) -> Answer:
    for rule in _rules(mind):
        mind.say(str(rule))
    return True


def _rules(mind: Mind) -> Iterator[Rule]:
    """Relation by relation, newest first."""
    for relation in mind.beliefs.relations.values():
        for entry in reversed(list(relation.facts.values())):
            if isinstance(entry, Derivation):
                yield entry.rule
