"""The steps of a plan body, each a function of its intention and means. They change the agent by `Effects` only."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Protocol

from bdi.language.syntax import GOAL_ADDED, Body, Does, Simple, Trigger, variables_of
from bdi.language.terms import (
    ANNOTATED,
    IN_SPACE,
    Atom,
    Code,
    Literal,
    Predicate,
    Structure,
    Term,
    Var,
    is_internal,
    predicate,
    show,
)
from bdi.language.unify import EVALUATED, FIXED, parts_of, undo, variables_in
from bdi.model.beliefs import annots_from_self
from bdi.model.intentions import Intention, Means, Step, StepFailed
from bdi.model.logic import Builtin, Compiled, Known, Logic, Scope
from bdi.model.plans.library import Library, Options

Run = Callable[[Intention, Means], None]
Build = Callable[[Any], Any]
Arguments = tuple[Term, ...]
REMEMBERED_BODIES = 200
WAIT = predicate(".wait", 1)


class Effects(Protocol):
    """The interface of an agent for the steps of plans."""

    def start_action(self, intention: Intention, term: Literal) -> None: ...
    def call_internal(self, intention: Intention, builtin: Builtin, args: tuple[Any, ...]) -> bool: ...
    def achieve(
        self, intention: Intention, key: Predicate, args: Arguments, annots: Arguments, options: Options
    ) -> None: ...
    def post_goal(
        self, intention: Intention, key: Predicate, args: Arguments, annots: Arguments, options: Options
    ) -> None: ...
    def achieve_apart(self, goal: Literal) -> None: ...
    def ask_plans(self, intention: Intention, goal: Literal, options: Options) -> None: ...
    def with_subplans(
        self, intention: Intention, trigger: Trigger, goal: Term, options: Options | None
    ) -> Options | None: ...
    def believe(self, literal: Literal, intention: Intention | None, last: bool = False) -> None: ...
    def forget(self, literal: Literal, intention: Intention | None) -> None: ...
    def update(self, literal: Literal, intention: Intention) -> None: ...
    def learn(self, code: Code, does: Does) -> None: ...
    def fork(self, intention: Intention, branches: list[Step | None], wait_for_all: bool) -> None: ...
    def join(self, intention: Intention) -> None: ...
    def step(self, intention: Intention) -> None: ...


Deed = Callable[[Intention, Literal], None]


class Steps(ABC):
    """Compiles single steps. What a step needs of its variables is compiled when it first runs."""

    def __init__(self, effects: Effects, logic: Logic, library: Library) -> None:
        self.effects = effects
        self.logic = logic
        self.library = library
        self._chains: dict[tuple[Any, ...], tuple[Body, Scope, Step | None]] = {}  # of bodies held by values

    @abstractmethod
    def chain(self, body: Body, scope: Scope, known: Known, following: Step | None) -> Step | None: ...

    def simple(self, written: Simple, scope: Scope, known: Known) -> Run | Compiled:
        term, does = written.term, written.does
        if does in (Does.CONSTRAINT, Does.TEST):
            return self._test(written, scope, known)
        if does is Does.INTERNAL:
            return self._internal(_literal(term), scope, known)
        if isinstance(term, Code) and does in _DEEDS:
            return self._with_variable(does, self._one(term, scope, known))  # +{ +!g <- a }
        if does is Does.VARIABLE or isinstance(term, Code):
            return self._variable(term, scope, known)
        if isinstance(term, Structure) and term.predicate in (IN_SPACE, ANNOTATED):
            return self._with_variable(does, self._one(term, scope, known))
        if isinstance(term, Var):
            return _variables_named(self._with_variable(does, self._one(term, scope, known)), term)
        literal = _literal_written(term)
        if does in (Does.ACHIEVE, Does.ACHIEVE_APART):
            return self._goal(does, literal, scope, known)
        return self._deed(_DEEDS[does](self.effects), literal, scope, known)

    def _one(self, term: Term, scope: Scope, known: Known) -> Build:
        """The term with the values of its variables."""
        build = self.logic.builder((term,), scope, known, resolved=True)
        return lambda frame: build.call(frame)[0]

    # ---- beliefs and actions ---------------------------------------------------------------------------------------

    def _deed(self, deed: Deed, term: Literal, scope: Scope, known: Known) -> Run | Compiled:
        """p(1)   +b   ++b   +<b   +>b   -b   --b   -+b"""
        if _is_fixed(term):
            return lambda intention, means: deed(intention, term)
        if self.logic.function(term.predicate) or term.predicate in EVALUATED:
            build = self._one(term, scope, known)  # who knows what that will be
            return lambda intention, means: deed(intention, _literal(build(means.frame)))
        return self.logic.deed_step(deed, term, scope, known)

    def _with_variable(self, does: Does, build: Build) -> Run:
        """!X   !!X   +X, where X is a goal, a plan body, a belief, plan or rule"""
        effects, library = self.effects, self.library

        def achieve(intention: Intention, means: Means) -> None:
            goal = build(means.frame)
            if isinstance(goal, Code):
                self.run_code(intention, means, goal)
                return
            literal = _literal(goal)
            options = library.options(GOAL_ADDED, literal.predicate)
            annots = annots_from_self(literal.annots)
            effects.achieve(intention, literal.predicate, literal.args, annots, options)

        if does is Does.ACHIEVE:
            return achieve
        if does is Does.ACHIEVE_APART:
            return lambda intention, means: effects.achieve_apart(_literal(build(means.frame)))
        deed = _DEEDS[does](effects)

        def believe(intention: Intention, means: Means) -> None:
            value = build(means.frame)
            if type(value) is Code and does is not Does.ACTION:
                effects.learn(value, does)
            else:
                deed(intention, _literal(value))

        return believe

    # ---- goals -----------------------------------------------------------------------------------------------------

    def _goal(self, does: Does, term: Literal, scope: Scope, known: Known) -> Run | Compiled:
        """!g   !!g"""
        effects = self.effects
        if does is Does.ACHIEVE_APART:
            build = self._one(term, scope, known)
            return lambda intention, means: effects.achieve_apart(_literal(build(means.frame)))
        key, args, annots = term.predicate, term.args, annots_from_self(term.annots)
        options = self.library.options(GOAL_ADDED, key)
        if _is_fixed(term):
            return lambda intention, means: effects.post_goal(intention, key, args, annots, options)
        if term.annots or self.logic.has_functions(term):
            whole = self._one(term, scope, known)

            def achieve(intention: Intention, means: Means) -> None:
                goal = _literal(whole(means.frame))
                effects.achieve(intention, goal.predicate, goal.args, annots_from_self(goal.annots), options)

            return achieve
        return self.logic.goal_step(effects, term, options, scope, known)

    def _test(self, written: Simple, scope: Scope, known: Known) -> Run:
        """?b   ?(b & X > 2)   X > 2"""
        term, trail, effects = written.term, self.logic.trail, self.effects
        solve = self.logic.test(term, scope, known)
        value = self._one(term, scope, Known(known.filled, known.met | frozenset(variables_in(term))))
        is_test = written.does is Does.TEST
        error, mark = ("test_goal_failed", "?") if is_test else ("constraint_failed", "")
        options, late = None, is_test and isinstance(term, Structure) and term.predicate in (IN_SPACE, ANNOTATED)
        if is_test and isinstance(term, Atom | Structure) and not late:
            options = self.library.options(Trigger.TEST_ADDED, term.predicate)

        def test(intention: Intention, means: Means) -> None:
            if solve.call(means.frame):
                trail.clear()
                return
            undo(trail, 0)
            shown = value(means.frame)
            plans = self.library.options(Trigger.TEST_ADDED, _literal(shown).predicate) if late else options
            if is_test:
                plans = effects.with_subplans(intention, Trigger.TEST_ADDED, shown, plans)
            if not plans:
                raise StepFailed(error, f"{mark}{show(shown)} is not the case")
            effects.ask_plans(intention, _literal(shown), plans)

        return test

    # ---- internal actions and bodies held by values ----------------------------------------------------------------

    def _internal(self, term: Literal, scope: Scope, known: Known) -> Run:
        """.print(X)"""
        builtin = self.logic.builtin(term.predicate)
        if builtin is None:
            return _unknown_internal(term)
        arguments, effects = self.logic.call(term, builtin, scope, known), self.effects

        def internal(intention: Intention, means: Means) -> None:
            if not effects.call_internal(intention, builtin, arguments.call(means.frame)):
                raise StepFailed("ia_failed", f"{show(term)} failed")

        return internal

    def _variable(self, term: Term, scope: Scope, known: Known) -> Run:
        """X, where X is a plan body, an action or an internal action; it starts in the same cycle."""
        build = self._one(term, scope, known)

        def variable(intention: Intention, means: Means) -> None:
            value = build(means.frame)
            if isinstance(value, Code):
                self.run_code(intention, means, value)
            elif isinstance(value, Atom | Structure) and is_internal(value.functor):
                self._internal(value, Scope(), Known())(intention, means)
            elif isinstance(value, Var):
                raise StepFailed("body_var_without_value", f"{value.name} has no value")
            else:
                self.effects.start_action(intention, _literal(value))

        return variable

    def run_code(self, intention: Intention, means: Means, code: Code) -> None:
        """Go on with the body held by a value: its variables get slots at the end of the frame."""
        if not isinstance(code.body, Body):
            raise StepFailed("wrong_arguments", f"{show(code)} is no plan body")
        frame = means.frame
        scope, first = self._chain_of(code, len(frame), means.step)
        frame.extend(code.scope.values())
        frame.extend([None] * (scope.size - len(frame)))
        means.step = first
        if first is not None:
            self.effects.step(intention)

    def _chain_of(self, code: Code, start: int, following: Step | None) -> tuple[Scope, Step | None]:
        """The steps of the body, remembered: a loop may run it many times."""
        key = (id(code.body), start, following, *code.scope)
        found = self._chains.get(key)
        if found is None:
            if len(self._chains) >= REMEMBERED_BODIES:
                self._chains.clear()
            scope = Scope(start)
            scope.add_all((*code.scope, *variables_of(code.body)))
            first = self.chain(code.body, scope, Known().among(code.scope), following)
            found = self._chains[key] = code.body, scope, first  # the body is kept, so that its id stays its own
        return found[1:]


def _is_fixed(term: Literal) -> bool:
    """Return whether every part is a plain value, so that there is nothing to work out (as there is in `math.pi`)."""
    parts = parts_of(term)
    return all(type(part) in FIXED and not (type(part) is Atom and is_internal(part.functor)) for part in parts)


def _literal_written(term: Term) -> Literal:
    if isinstance(term, Atom | Structure):
        return term
    raise StepFailed("wrong_arguments", f"{show(term)} is no literal")


def _literal(value: Term) -> Literal:
    """A value about to be done or believed; anything else fails by name."""
    if isinstance(value, Atom | Structure) and value.predicate not in (IN_SPACE, ANNOTATED):
        return value
    raise StepFailed("wrong_arguments", f"{show(value)} is no literal")


def _variables_named(run: Run, variable: Var) -> Run:
    def named(intention: Intention, means: Means) -> None:
        try:
            run(intention, means)
        except StepFailed as failure:
            if failure.error == "wrong_arguments":
                raise StepFailed("body_var_without_value", f"{variable.name} has no value") from failure
            raise

    return named


def _unknown_internal(term: Literal) -> Run:
    def unknown(intention: Intention, means: Means) -> None:
        raise StepFailed("unknown_internal_action", f"there is no internal action {term.functor}/{len(term.args)}")

    return unknown


_DEEDS: dict[Does, Callable[[Effects], Deed]] = {
    Does.ACTION: lambda effects: effects.start_action,
    Does.ADD: lambda effects: lambda intention, term: effects.believe(term, intention),
    Does.ADD_FIRST: lambda effects: lambda intention, term: effects.believe(term, intention),
    Does.ADD_LAST: lambda effects: lambda intention, term: effects.believe(term, intention, last=True),
    Does.ADD_APART: lambda effects: lambda intention, term: effects.believe(term, None),
    Does.REMOVE: lambda effects: lambda intention, term: effects.forget(term, intention),
    Does.REMOVE_APART: lambda effects: lambda intention, term: effects.forget(term, None),
    Does.UPDATE: lambda effects: lambda intention, term: effects.update(term, intention),
}
