"""Intentions as terms, for programs that look into themselves."""

from collections.abc import Iterator

from bdi.language.errors import Place
from bdi.language.syntax import Body, Does, Fork, If, Plan, Simple
from bdi.language.terms import Atom, Code, List, String, Structure, Term, atom, structure
from bdi.language.unify import renamed
from bdi.model.intentions import RUNNING, Intention, Means, Step

_NOWHERE = Place("", 0, 0)
_GOALS = (Does.ACHIEVE, Does.ACHIEVE_APART)


def intention_term(intention: Intention) -> Term:
    """intention(ID, STACK)"""
    return structure("intention", intention.number, stack_of(intention))


def state_of(intention: Intention, current: Intention | None) -> Term:
    if intention.suspended:
        return atom("suspended")
    return atom("running" if intention.state is RUNNING or intention is current else "waiting")


def stack_of(intention: Intention) -> List:
    """[im(LABEL, {+!goal}, {REST OF THE BODY}), …], the running plan first."""
    return List([_means_term(means) for means in reversed(intention.stack)])


def _means_term(means: Means) -> Term:
    event = Plan(atom(""), means.event.trigger, means.event.literal, None, Body(), _NOWHERE)
    rest = Body(tuple(step.source for step in _steps_ahead(means)))
    return structure("im", _label_of(means.plan.plan), Code(event), Code(rest), List())


def _label_of(plan: Plan) -> Term:
    """Return the label with its place: code_line(12), code_src("mail.asl")."""
    place = (structure("code_line", plan.place.line), structure("code_src", String(plan.place.source)))
    return Structure(plan.label.predicate, (), (*plan.label.annots, *place))


def goals_ahead(means: Means) -> Iterator[Term]:
    """The goals of the steps that are still to come; variables are taken as free."""
    for step in _steps_ahead(means):
        yield from _goals_in(Body((step.source,)))


def _steps_ahead(means: Means) -> Iterator[Step]:
    """Each once, though a loop comes round again."""
    step, seen = means.step, set[int]()
    while step is not None and id(step) not in seen:
        seen.add(id(step))
        yield step
        step = step.next


def _goals_in(body: Body) -> Iterator[Term]:
    for step in body.steps:
        if isinstance(step, Simple):
            if step.does in _GOALS and isinstance(step.term, Atom | Structure):
                yield renamed(step.term, {})
        elif isinstance(step, Fork):
            for branch in step.branches:
                yield from _goals_in(branch)
        else:
            for inner in (step.then, step.otherwise) if isinstance(step, If) else (step.body,):
                yield from _goals_in(inner)
