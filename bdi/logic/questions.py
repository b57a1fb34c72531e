"""Formulas handed to internal actions, and internal actions in formulas."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

from bdi.logic.frames import DEEPEST_QUESTIONS, Build, Builtin, Frame, Known, Question, Scope, Solve, fail
from bdi.logic.terms import Terms
from bdi.terms import (
    Literal,
    Term,
    Var,
)
from bdi.unify import (
    renamed,
    resolve,
    undo,
    variables_in,
)


class Questions(Terms, ABC):
    """Compiles internal actions, with the formulas that they ask themselves."""

    @abstractmethod
    def formula(self, term: Term, scope: Scope, known: Known, then: Solve) -> Solve: ...

    def arguments(self, term: Literal, builtin: Builtin, scope: Scope) -> Callable[[Frame], tuple[Any, ...]]:
        """What an internal action is called with: values, and questions where it asks for them."""
        parts = [
            self.question(arg, scope) if place in builtin.lazy else self._value(arg, scope)
            for place, arg in enumerate(term.args)
        ]
        if builtin.named:
            return lambda frame: (_by_name(scope, frame), *[part(frame) for part in parts])
        return lambda frame: tuple([part(frame) for part in parts])

    def _value(self, term: Term, scope: Scope) -> Build:
        build = self.build(term, scope)
        return lambda frame: resolve(build(frame))

    def question(self, term: Term, scope: Scope) -> Callable[[Frame], Question]:
        build = self.build(term, scope)
        collectors: list[tuple[list[Term], Build]] = []

        def collect(frame: Frame) -> bool:
            found, template = collectors[-1]
            found.append(renamed(template(frame), {}))
            return False

        solve = self.formula(term, scope, Known(met=frozenset(variables_in(term))), collect)

        def answers(frame: Frame, template: Build) -> list[Term]:
            found: list[Term] = []
            if len(collectors) >= DEEPEST_QUESTIONS:
                raise RecursionError("a formula asks itself")
            collectors.append((found, template))
            try:
                solve(frame)
            finally:
                collectors.pop()
            return found

        return lambda frame: Question(frame, build, answers)

    def internal(self, term: Literal, scope: Scope, then: Solve) -> Solve:
        builtin = self.builtin(term.predicate)
        if builtin is None:
            return fail
        arguments, trail, ask = self.arguments(term, builtin, scope), self.trail, builtin.ask

        def solve(frame: Frame) -> bool:
            mark = len(trail)
            answer = ask(arguments(frame))
            if answer is True and then(frame):
                return True
            if answer is not True and answer:
                for _ in answer:
                    if then(frame):
                        return True
                    undo(trail, mark)
            undo(trail, mark)
            return False

        return solve


def _by_name(scope: Scope, frame: Frame) -> dict[str, Term]:
    for variable, slot in scope.slots.items():
        if slot < len(frame) and frame[slot] is None:
            frame[slot] = Var(variable.name)
    return {variable.name: frame[slot] for variable, slot in scope.slots.items() if slot < len(frame)}
