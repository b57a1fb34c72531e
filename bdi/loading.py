"""Checks of a whole program when an agent is made of it: an unknown name is an error, never nothing."""

from collections.abc import Iterator

from bdi.builtin import ACTIONS, FUNCTIONS
from bdi.errors import Place, UnknownAction, UnknownInternalAction
from bdi.syntax import Body, Does, Fork, If, Plan, Program, Rule, Simple, Step
from bdi.terms import INTERNAL, Atom, Code, Literal, Structure, Term
from bdi.unify import parts_of

KnownActions = frozenset[str] | None


def is_known_action(term: Literal, known: KnownActions) -> bool:
    """Whether the body has this action; with no declaration, every one is."""
    key = term.predicate
    return known is None or key.name in known or f"{key.name}/{key.arity}" in known


def check_program(program: Program, known: KnownActions) -> None:
    """Raises UnknownInternalAction and UnknownAction, with the place."""
    for clause in program.beliefs:
        if isinstance(clause, Rule):
            _check_term(clause.formula, clause.place)
    for plan in program.plans:
        _check_plan(plan, known)


def _check_plan(plan: Plan, known: KnownActions) -> None:
    if plan.context is not None:
        _check_term(plan.context, plan.place)
    for step in steps_of(plan.body):
        if isinstance(step, Simple):
            _check_step(step, known)
        elif not isinstance(step, Fork):
            _check_term(step.condition, step.place)
    for inner in plan.subplans:
        _check_plan(inner, known)


def _check_step(step: Simple, known: KnownActions) -> None:
    term = step.term
    if step.does is Does.ACTION and isinstance(term, Atom | Structure) and not is_known_action(term, known):
        raise UnknownAction(f"the body has no action {term.predicate!r}", step.place, tuple(sorted(known or ())))
    _check_term(term, step.place)


def _check_term(term: Term, place: Place) -> None:
    if isinstance(term, Atom | Structure) and term.functor.startswith(INTERNAL):
        _check_internal(term, place)
    if isinstance(term, Code):
        for step in steps_of(term.body):
            if isinstance(step, Simple):
                _check_term(step.term, step.place)
    for part in parts_of(term):
        _check_term(part, place)


def _check_internal(term: Literal, place: Place) -> None:
    name, count = term.functor, len(term.args)
    found = [table[name] for table in (ACTIONS, FUNCTIONS) if name in table]
    if not found:
        raise UnknownInternalAction(f"there is no internal action {name}", place)
    if not any(definition.accepts(count) for definition in found):
        most = found[0].most
        takes = str(found[0].least) if most == found[0].least else f"{found[0].least} to {most or 'any number of'}"
        raise UnknownInternalAction(f"{name} takes {takes} arguments, not {count}", place)


def steps_of(body: Body) -> Iterator[Step]:
    """All steps of a body, those inside others too."""
    for step in body.steps:
        yield step
        if isinstance(step, Fork):
            inner: tuple[Body, ...] = step.branches
        elif isinstance(step, If):
            inner = (step.then, step.otherwise)
        else:
            inner = () if isinstance(step, Simple) else (step.body,)
        for each in inner:
            yield from steps_of(each)
