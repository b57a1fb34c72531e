"""The steps of a plan body, each as a function of the intention and the means that it belongs to. What it does to the
agent goes through the few verbs of `Doer`."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Protocol

from bdi.intentions import Intention, Means, Step, StepFailed
from bdi.logic import Build, Builtin, Known, Logic, Scope, succeed
from bdi.plans.library import Library, Options
from bdi.syntax import Body, Does, Simple, Trigger
from bdi.terms import INTERNAL, Atom, Code, Literal, Predicate, Structure, Term, Var, show
from bdi.unify import FIXED, parts_of, resolve, resolve_all, undo

Run = Callable[[Intention, Means], None]


class Doer(Protocol):
    """What a step of a plan can ask of the agent."""

    def start_action(self, intention: Intention, term: Literal) -> None: ...
    def call_internal(self, intention: Intention, builtin: Builtin, args: tuple[Any, ...]) -> bool: ...
    def achieve(self, intention: Intention, goal: Literal, options: Options) -> None: ...
    def achieve_apart(self, goal: Literal, options: Options) -> None: ...
    def ask_plans(self, intention: Intention, goal: Literal, options: Options) -> None: ...
    def believe(self, literal: Literal, intention: Intention | None, last: bool = False) -> None: ...
    def forget(self, literal: Literal, intention: Intention | None) -> None: ...
    def update(self, literal: Literal, intention: Intention) -> None: ...
    def fork(self, intention: Intention, branches: list[Step | None], wait_for_all: bool) -> None: ...
    def join(self, intention: Intention) -> None: ...
    def step(self, intention: Intention) -> None: ...


class Steps(ABC):
    """Compiles single steps."""

    def __init__(self, doer: Doer, logic: Logic, library: Library) -> None:
        self.doer = doer
        self.logic = logic
        self.library = library

    @abstractmethod
    def chain(self, body: Body, scope: Scope, known: Known, following: Step | None) -> Step | None: ...

    def simple(self, written: Simple, scope: Scope, known: Known) -> Run:
        term = written.term
        if written.does in (Does.CONSTRAINT, Does.TEST):
            return self._test(written, scope, known)
        if written.does is Does.INTERNAL:
            return self._internal(_literal(term), scope)
        if written.does is Does.VARIABLE or isinstance(term, Code):
            return self._variable(term, scope)
        build = self.logic.build(term, scope)
        key = term.predicate if isinstance(term, Atom | Structure) else None
        run = (
            _GOALS[written.does](self, build, key)
            if written.does in _GOALS
            else self._deed(written.does, build, _fixed(term))
        )
        return _variables_named(run, term) if isinstance(term, Var) else run

    def _deed(self, does: Does, build: Build, fixed: Literal | None) -> Run:
        doer, deed = self.doer, _DEEDS[does]
        if fixed is not None:
            return lambda intention, means: deed(doer, intention, fixed)
        return lambda intention, means: deed(doer, intention, _literal(build(means.frame)))

    def _test(self, written: Simple, scope: Scope, known: Known) -> Run:
        """?b   ?(b & X > 2)   X > 2"""
        term, trail = written.term, self.logic.trail
        solve = self.logic.formula(term, scope, known, succeed)
        build = self.logic.build(term, scope)
        error = "test_goal_failed" if written.does is Does.TEST else "constraint_failed"
        options = None
        if written.does is Does.TEST and isinstance(term, Atom | Structure):
            options = self.library.options(Trigger.TEST_ADDED, term.predicate)

        def test(intention: Intention, means: Means) -> None:
            found = solve(means.frame)
            if found:
                trail.clear()
                return
            undo(trail, 0)
            if not options:
                raise StepFailed(error, f"{written.does.value}{show(resolve(build(means.frame)))} is not the case")
            self.doer.ask_plans(intention, _literal(build(means.frame)), options)

        return test if written.does is Does.TEST else self._constraint(term, scope, test)

    def _constraint(self, term: Term, scope: Scope, test: Run) -> Run:
        """Arithmetic that cannot be done is named as such, not taken for false."""
        builds = [self.logic.build(arg, scope) for arg in getattr(term, "args", ())]

        def constraint(intention: Intention, means: Means) -> None:
            try:
                test(intention, means)
            except StepFailed:
                for build in builds:
                    resolve(build(means.frame))
                raise

        return constraint

    def _achieve(self, build: Build, key: Predicate | None) -> Run:
        """!g"""
        doer, library = self.doer, self.library
        options = library.options(Trigger.GOAL_ADDED, key) if key else None

        def achieve(intention: Intention, means: Means) -> None:
            goal = build(means.frame)
            if options is None:
                goal = resolve(goal)
                if isinstance(goal, Code):
                    return self.run_code(intention, means, goal)
                literal = _literal(goal)
                return doer.achieve(intention, literal, library.options(Trigger.GOAL_ADDED, literal.predicate))
            return doer.achieve(intention, goal, options)  # type: ignore[arg-type]

        return achieve

    def _achieve_apart(self, build: Build, key: Predicate | None) -> Run:
        """!!g"""

        def achieve_apart(intention: Intention, means: Means) -> None:
            goal = _literal(build(means.frame))
            self.doer.achieve_apart(goal, self.library.options(Trigger.GOAL_ADDED, goal.predicate))

        return achieve_apart

    def _internal(self, term: Literal, scope: Scope) -> Run:
        """.print(X)"""
        builtin = self.logic.builtin(term.predicate)
        if builtin is None:
            return _unknown_internal(term)
        arguments, doer = self.logic.arguments(term, builtin, scope), self.doer

        def internal(intention: Intention, means: Means) -> None:
            if not doer.call_internal(intention, builtin, arguments(means.frame)):
                raise StepFailed("ia_failed", f"{show(term)} failed")

        return internal

    def _variable(self, term: Term, scope: Scope) -> Run:
        """X, where X is a plan body, an action or an internal action; it starts in the same cycle."""
        build = self.logic.build(term, scope)

        def variable(intention: Intention, means: Means) -> None:
            value = resolve(build(means.frame))
            if isinstance(value, Code):
                self.run_code(intention, means, value)
            elif isinstance(value, Atom | Structure) and value.functor.startswith(INTERNAL):
                self._internal(value, Scope())(intention, means)
            elif isinstance(value, Var):
                raise StepFailed("body_var_without_value", f"{value.name} has no value")
            else:
                self.doer.start_action(intention, _literal(value))

        return variable

    def run_code(self, intention: Intention, means: Means, code: Code) -> None:
        """Go on with the body held by a value: its variables get slots at the end of the frame."""
        scope = Scope(len(means.frame))
        for variable, value in code.scope.items():
            scope.slot(variable)
            means.frame.append(value)
        means.step = self.chain(code.body, scope, Known().among(code.scope), means.step)
        means.frame.extend([None] * (scope.size - len(means.frame)))
        if means.step is not None:
            self.doer.step(intention)


def _fixed(term: Term) -> Literal | None:
    """The literal itself if every part is a plain value, so that there is nothing to work out."""
    plain = isinstance(term, Atom | Structure) and all(type(part) in FIXED for part in parts_of(term))
    return term if plain else None  # type: ignore[return-value]


def _literal(value: Term) -> Literal:
    """A value about to be done or believed; anything else fails by name."""
    if type(value) is Structure:
        return Structure(value[0], resolve_all(value[1]), resolve_all(value[2]))
    if type(value) is Atom:
        return value
    resolved = resolve(value) if type(value) not in FIXED else value
    if isinstance(resolved, Atom | Structure):
        return resolved
    raise StepFailed("wrong_arguments", f"{show(resolved)} is no literal")


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


_GOALS: dict[Does, Callable[[Steps, Build, Predicate | None], Run]] = {
    Does.ACHIEVE: Steps._achieve,
    Does.ACHIEVE_APART: Steps._achieve_apart,
}


_DEEDS: dict[Does, Callable[[Doer, Intention, Literal], None]] = {
    Does.ACTION: lambda doer, intention, term: doer.start_action(intention, term),
    Does.ADD: lambda doer, intention, term: doer.believe(term, intention),
    Does.ADD_FIRST: lambda doer, intention, term: doer.believe(term, intention),
    Does.ADD_LAST: lambda doer, intention, term: doer.believe(term, intention, last=True),
    Does.ADD_APART: lambda doer, intention, term: doer.believe(term, None),
    Does.REMOVE: lambda doer, intention, term: doer.forget(term, intention),
    Does.REMOVE_APART: lambda doer, intention, term: doer.forget(term, None),
    Does.UPDATE: lambda doer, intention, term: doer.update(term, intention),
}
