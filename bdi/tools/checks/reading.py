"""A program as the checks see it: which names it posts, tests, adds and does, and where."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from enum import Enum

from bdi.language.errors import Place
from bdi.language.syntax import Body, Does, Fork, If, Plan, Program, Rule, Simple, Step, Trigger
from bdi.language.terms import (
    AND,
    NOT,
    OR,
    RELATIONS,
    Atom,
    Code,
    Literal,
    Predicate,
    Structure,
    Term,
    Var,
    is_internal,
)
from bdi.language.unify import parts_of


class How(Enum):
    """The uses of a name."""

    POSTED = "posted"  # !g, !!g, an initial goal, .send(_, achieve, g)
    TESTED = "tested"  # in a context, condition or rule, ?b
    ADDED = "added"  # +b, an initial belief, the head of a rule, .send(_, tell, b)
    DONE = "done"  # an action


@dataclass(frozen=True, slots=True)
class Use:
    how: How
    literal: Literal
    place: Place
    plan: Plan | None = None  # in which


_ADDS = frozenset({Does.ADD, Does.ADD_APART, Does.ADD_FIRST, Does.ADD_LAST, Does.UPDATE})
_POSTS = frozenset({Does.ACHIEVE, Does.ACHIEVE_APART})
_ASKS = frozenset({".findall", ".setof", ".count", ".wait", ".belief", ".foreach", ".loop", ".if_then_else"})
_BELIEVES = frozenset({".asserta", ".assertz"})
_PLANS_COME = frozenset({".add_plan", ".include"})


@dataclass(slots=True)
class Reading:
    program: Program
    plans: list[Plan] = field(default_factory=list)  # sub-plans too
    rules: list[Rule] = field(default_factory=list)
    uses: list[Use] = field(default_factory=list)
    posts_anything: bool = False  # !G with a variable
    plans_come: bool = False  # .add_plan, or a plan as a value

    def of(self, how: How) -> Iterator[Use]:
        return (use for use in self.uses if use.how is how)

    def names(self, how: How) -> set[Predicate]:
        return {use.literal.predicate for use in self.of(how)}

    def plans_for(self, trigger: Trigger, key: Predicate) -> list[Plan]:
        """Return the plans with this predicate or a variable as head, in source order."""
        found = (plan for plan in self.plans if plan.trigger is trigger)
        return [plan for plan in found if isinstance(plan.head, Var) or plan.head.predicate is key]

    def heads(self, trigger: Trigger) -> set[Predicate]:
        heads = [plan.head for plan in self.plans if plan.trigger is trigger]
        return {head.predicate for head in heads if not isinstance(head, Var)}


def read(program: Program) -> Reading:
    reading = Reading(program)
    for clause in program.beliefs:
        if isinstance(clause, Rule):
            reading.rules.append(clause)
            reading.uses.append(Use(How.ADDED, clause.head, clause.place))
            _formula(reading, clause.formula, clause.place, None)
        else:
            reading.uses.append(Use(How.ADDED, clause.literal, clause.place))
    reading.uses += [Use(How.POSTED, goal.literal, goal.place) for goal in program.goals]
    for plan in program.plans:
        _plan(reading, plan)
    return reading


def _plan(reading: Reading, plan: Plan) -> None:
    reading.plans.append(plan)
    for formula in (plan.context, plan.condition):
        if formula is not None:
            _formula(reading, formula, plan.place, plan)
    for step in steps_of(plan.body):
        _step(reading, step, plan)
    for inner in plan.subplans:
        _plan(reading, inner)


def steps_of(body: Body) -> Iterator[Step]:
    """Yield all steps, those inside others too."""
    for step in body.steps:
        yield step
        for inner in bodies_of(step):
            yield from steps_of(inner)


def bodies_of(step: Step) -> tuple[Body, ...]:
    if isinstance(step, Simple):
        return ()
    if isinstance(step, Fork):
        return step.branches
    return (step.then, step.otherwise) if isinstance(step, If) else (step.body,)


def _step(reading: Reading, step: Step, plan: Plan) -> None:
    if isinstance(step, Fork):
        return
    if not isinstance(step, Simple):
        _formula(reading, step.condition, step.place, plan)
        return
    term = step.term
    if step.does in _POSTS and isinstance(term, Var):
        reading.posts_anything = True
    if isinstance(term, Atom | Structure):
        if step.does in _POSTS:
            reading.uses.append(Use(How.POSTED, term, step.place, plan))
        elif step.does in _ADDS:
            reading.uses.append(Use(How.ADDED, term, step.place, plan))
        elif step.does is Does.ACTION:
            reading.uses.append(Use(How.DONE, term, step.place, plan))
    if step.does in (Does.TEST, Does.CONSTRAINT, Does.INTERNAL):
        _formula(reading, term, step.place, plan)
    _values(reading, parts_of(term), step.place, plan)
    if isinstance(term, Code):
        _values(reading, (term,), step.place, plan)


def _formula(reading: Reading, term: Term, place: Place, plan: Plan | None) -> None:
    """A condition: the literals that are asked of the beliefs."""
    if not isinstance(term, Atom | Structure):
        return
    key = term.predicate
    if key in (AND, OR, NOT):
        for part in term.args:
            _formula(reading, part, place, plan)
    elif is_internal(key.name):
        _internal(reading, term, place, plan)
    elif key not in RELATIONS and key.name not in ("true", "false"):
        reading.uses.append(Use(How.TESTED, term, place, plan))
    if key in RELATIONS:
        _values(reading, term.args, place, plan)


def _internal(reading: Reading, term: Literal, place: Place, plan: Plan | None) -> None:
    name, args = term.functor, term.args
    reading.plans_come = reading.plans_come or name in _PLANS_COME
    if name in _ASKS:
        for arg in args:
            _formula(reading, arg, place, plan)
    elif name in _BELIEVES:
        reading.uses += [Use(How.ADDED, arg, place, plan) for arg in args if isinstance(arg, Atom | Structure)]
    elif name in (".send", ".broadcast") and len(args) >= 2:
        _message(reading, args[1:] if name == ".send" else args, place, plan)


def _message(reading: Reading, args: tuple[Term, ...], place: Place, plan: Plan | None) -> None:
    """Agents of one program write to each other: what one sends, another gets."""
    what, content = getattr(args[0], "functor", ""), args[1] if len(args) > 1 else None
    kinds = {"achieve": How.POSTED, "tell": How.ADDED, "signal": How.ADDED}
    if what in kinds and isinstance(content, Atom | Structure):
        reading.uses.append(Use(kinds[what], content, place, plan))


def _values(reading: Reading, terms: Iterable[Term], place: Place, plan: Plan | None) -> None:
    """Plan bodies and plans that are values, wherever they stand."""
    for term in terms:
        if isinstance(term, Code):
            if isinstance(term.body, Body) and plan is not None:
                for step in steps_of(term.body):
                    _step(reading, step, plan)
            elif isinstance(term.body, Plan):
                reading.plans_come = True
                _plan(reading, term.body)
        _values(reading, parts_of(term), place, plan)
