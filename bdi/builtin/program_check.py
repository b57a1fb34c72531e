"""Checks of a whole program when an agent is made of it: an unknown name is an error, never nothing."""

from collections.abc import Iterable, Iterator

from bdi.builtin import NOT_SUPPORTED, STANDARD, Definition, Table
from bdi.language.arithmetic import ArithmeticFailure
from bdi.language.errors import AgentSpeakError, Place, UnknownAction, UnknownInternalAction
from bdi.language.syntax import Body, Does, Fork, Function, If, Plan, Program, Rule, Simple, Step
from bdi.language.terms import (
    AND,
    ARITHMETIC,
    INTERNAL,
    NEGATIVE,
    NOT,
    OR,
    POSITIVE,
    Atom,
    Code,
    Literal,
    OpenList,
    Structure,
    Term,
    Var,
    is_internal,
    show,
)
from bdi.language.unify import parts_of, resolve

KnownActions = frozenset[str] | None
_CONNECTIVES = frozenset({AND, OR, NOT})
_CALCULATED = ARITHMETIC | {NEGATIVE, POSITIVE}


def is_known_action(term: Literal, known: KnownActions) -> bool:
    """Return whether the body has this action; with no declaration, every one is."""
    key = term.predicate
    return known is None or key.name in known or f"{key.name}/{key.arity}" in known


def check_program(
    program: Program, known: KnownActions, own: Table | None = None, functions: Iterable[Function] = ()
) -> None:
    """Raises UnknownInternalAction, UnknownAction, and AgentSpeakError for a belief or goal that cannot be worked out,
    with the place. `own` are internal actions of this agent, `functions` what was registered before this program."""
    if not isinstance(program, Program):
        raise TypeError("an agent is made of a program: Agent(parse_program(text)), Agent(load_program(path))")
    check = _Check(own, (*functions, *program.functions))
    for clause in program.beliefs:
        if isinstance(clause, Rule):
            check.term(clause.head, clause.place)
            check.formula(clause.formula, clause.place)
        else:
            check.value(clause.literal, clause.place)
    for goal in program.goals:
        check.value(goal.literal, goal.place)
    for plan in program.plans:
        check.plan(plan, known)


class _Check:
    def __init__(self, own: Table | None, functions: Iterable[Function]) -> None:
        self.tables = (STANDARD,) if own is None else (own, STANDARD)
        self.registered = {(each.name, each.arity) for each in functions}

    def value(self, literal: Literal, place: Place) -> None:
        """Check an initial belief or goal: no plan could handle one that cannot be evaluated."""
        self.term(literal, place)
        try:
            resolve(literal)
        except ArithmeticFailure as problem:
            raise AgentSpeakError(f"{show(literal)} cannot be worked out: {problem}", place) from problem

    def plan(self, plan: Plan, known: KnownActions) -> None:
        self.term(plan.head, plan.place)
        for formula in (plan.context, plan.condition):
            if formula is not None:
                self.formula(formula, plan.place)
        self.body(plan.body, known)
        for inner in plan.subplans:
            self.plan(inner, known)

    def body(self, body: Body, known: KnownActions) -> None:
        for step in steps_of(body):
            self.step(step, known)

    def step(self, step: Step, known: KnownActions) -> None:
        if isinstance(step, Fork):
            return
        if not isinstance(step, Simple):
            self.formula(step.condition, step.place)
            return
        term = step.term
        if step.does is Does.ACTION and isinstance(term, Atom | Structure) and not is_known_action(term, known):
            raise UnknownAction(f"the body has no action {term.predicate!r}", step.place, tuple(sorted(known or ())))
        self.formula(term, step.place)

    def formula(self, term: Term, place: Place) -> None:
        """A condition or a step: what has a dot is called here even without arguments."""
        if isinstance(term, Structure) and term.predicate in _CONNECTIVES:
            for part in term.args:
                self.formula(part, place)
            return
        if isinstance(term, Atom) and is_internal(term.functor):
            self.call(term, place)
        self.term(term, place)

    def term(self, term: Term, place: Place) -> None:
        if isinstance(term, Atom | Structure) and is_internal(term.functor) and not _is_data(term):
            self.call(term, place)
        if isinstance(term, Code):
            self.code(term.body, place)
        for part in parts_of(term):
            self.term(part, place)

    def code(self, quoted: Body | Plan | Rule, place: Place) -> None:
        """A plan as a value: its actions may be meant for another body."""
        if isinstance(quoted, Body):
            self.body(quoted, None)
        elif isinstance(quoted, Plan):
            self.plan(quoted, None)
        else:
            self.term(quoted.head, place)
            self.formula(quoted.formula, place)

    def call(self, term: Literal, place: Place) -> None:
        """An internal action or function: does it exist, with so many arguments, of these kinds?"""
        name, count = term.functor, len(term.args)
        if (name, count) in self.registered:
            return
        found = [definition for table in self.tables for definition in table.named(name)]
        if not found:
            raise UnknownInternalAction(self.unknown(name), place)
        fitting = [definition for definition in found if definition.accepts(count)]
        if not fitting:
            raise UnknownInternalAction(f"{name} takes {found[0].how_many()}, not {count}", place)
        problems = [self.wrong_kind(definition, term.args) for definition in fitting]
        if all(problems):
            raise UnknownInternalAction(str(problems[0]), place)

    def unknown(self, name: str) -> str:
        if name in NOT_SUPPORTED:
            return f"not supported: {name}: {NOT_SUPPORTED[name]}"
        near = [like for table in self.tables for like in table.like(name)]
        hint = f"; did you mean {' or '.join(near)}?" if near else ""
        if not near and not name.startswith(INTERNAL):
            hint = "; one of your own is a Python function: Agent(program, internal_actions=…)"
        return f"there is no internal action {name}{hint}"

    def wrong_kind(self, definition: Definition, args: tuple[Term, ...]) -> str:
        for place, kind in definition.checks(len(args)):
            value = self.constant(args[place])
            if value is not None and kind.holds is not None and not kind.holds(value):
                return f"argument {place + 1} of {definition.name} is {kind.name}, not {show(value)}"
        return ""

    def constant(self, term: Term) -> Term | None:
        """The value, if it is known before the program runs."""
        if isinstance(term, Var | OpenList):
            return None
        if isinstance(term, Structure) and is_internal(term.functor):
            return None  # a function, perhaps
        if isinstance(term, Structure) and term.predicate in _CALCULATED:
            return None if None in [self.constant(arg) for arg in term.args] else _worked_out(term)
        return term


def _is_data(term: Literal) -> bool:
    """`file.txt` as an argument: a name with a dot that is not called."""
    return not term.args and not term.functor.startswith(INTERNAL)


def _worked_out(term: Structure) -> Term | None:
    """`1 div 0` fails when its step has its turn, not before."""
    try:
        return resolve(term)
    except ArithmeticFailure:
        return None


def steps_of(body: Body) -> Iterator[Step]:
    """Yield all steps of a body, those inside others too."""
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
