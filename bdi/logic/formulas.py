"""Formulas compiled once to functions over the belief base.

A formula becomes `solve(frame) -> bool`: it fills the frame (one slot for each variable), calls what comes after it,
and answers True as soon as that does. So a conjunction is a call, a second answer is a return, and no generator is
needed. A slot is None until its variable is met; then it holds a value or a `Var`.
"""

from collections.abc import Callable
from typing import Any, Protocol

from bdi.beliefs import Beliefs
from bdi.logic.believed import Believed
from bdi.logic.comparisons import Comparisons
from bdi.logic.frames import RULE_SLOTS, Builtin, Frame, Known, Scope, Solve, deep_stack, fail, proved, succeed
from bdi.logic.questions import Questions
from bdi.terms import (
    AND,
    FALSE,
    INTERNAL,
    NOT,
    OR,
    RELATIONS,
    TRUE,
    Atom,
    Code,
    Literal,
    Predicate,
    Structure,
    Term,
    Var,
)
from bdi.unify import (
    resolve,
    undo,
    variables_in,
)


class HasLogic(Protocol):
    logic: "Logic"


class Logic(Comparisons, Believed, Questions):
    """Compiles formulas and terms against one belief base. One for each agent."""

    def __init__(self, beliefs: Beliefs, builtin: Callable[[Predicate], Builtin | None]) -> None:
        super().__init__(beliefs, builtin)
        self._asked = False  # whether a formula is being asked that may be asked again with more stack

    def formula(self, term: Term, scope: Scope, known: Known, then: Solve) -> Solve:
        """`compile` for what a plan or somebody outside asks: long proofs by rules get the stack they need.

        A proof is a chain of calls. Where rules are involved it may be longer than Python's usual limit; then the
        formula is asked again with a higher one, which holds only for that time.
        """
        solve = self.compile(term, scope, known, then)
        if not self._may_need_rules(term):
            return solve
        unfilled = [scope.slot(variable) for variable in variables_in(term) if variable not in known.filled]
        trail = self.trail

        def ask(frame: Frame) -> bool:
            if self._asked:
                return solve(frame)  # a question within a question: the outer one takes care
            mark = len(trail)
            before = [frame[slot] for slot in unfilled]
            self._asked = True
            try:
                return solve(frame)
            except RecursionError:
                undo(trail, mark)
            finally:
                self._asked = False
            for slot, value in zip(unfilled, before, strict=True):
                frame[slot] = value
            return self._ask_deeply(solve, frame)

        return ask

    def _ask_deeply(self, solve: Solve, frame: Frame) -> bool:
        self._asked = True
        try:
            with deep_stack():
                return solve(frame)
        finally:
            self._asked = False

    def _may_need_rules(self, term: Term) -> bool:
        if not isinstance(term, Atom | Structure):
            return type(term) is Var
        key = term.predicate
        if key in (AND, OR, NOT) or key.name.startswith(INTERNAL):
            return any(self._may_need_rules(part) for part in term.args)
        return self.beliefs.relation(key).irregular > 0

    def compile(self, term: Term, scope: Scope, known: Known, then: Solve) -> Solve:
        """The formula as a function; `then` is called for every way in which it is true."""
        if type(term) is Var or type(term) is Code:
            return self._solve_variable(term, scope, then)
        if not isinstance(term, Atom | Structure):
            return fail
        key = term.predicate
        compiler = self._formulas().get(key)
        if compiler:
            return compiler(term, scope, known, then)
        if key in RELATIONS and isinstance(term, Structure):
            return self.comparison(term, scope, then)
        if key.name.startswith(INTERNAL):
            return self.internal(term, scope, then)
        return self.literal(term, scope, known, then)

    def _formulas(self) -> dict[Predicate, Callable[[Any, Scope, Known, Solve], Solve]]:
        return {
            AND: self._solve_and,
            OR: self._solve_or,
            NOT: self._solve_not,
            TRUE.predicate: lambda term, scope, known, then: then,
            FALSE.predicate: lambda term, scope, known, then: fail,
        }

    def _solve_and(self, term: Structure, scope: Scope, known: Known, then: Solve) -> Solve:
        left, right = term.args
        return self.compile(left, scope, known, self.compile(right, scope, known.after(left), then))

    def _solve_or(self, term: Structure, scope: Scope, known: Known, then: Solve) -> Solve:
        left, right = (self.compile(part, scope, known, then) for part in term.args)
        return lambda frame: left(frame) or right(frame)

    def _solve_not(self, term: Structure, scope: Scope, known: Known, then: Solve) -> Solve:
        inner = self.compile(term.args[0], scope, known, succeed)
        slots = [scope.slot(variable) for variable in variables_in(term) if variable not in known.filled]
        trail = self.trail

        def refute(frame: Frame) -> bool:
            mark = len(trail)
            before = [frame[slot] for slot in slots]
            if not inner(frame):
                return then(frame)
            undo(trail, mark)
            for slot, value in zip(slots, before, strict=True):
                frame[slot] = value
            return False

        return refute

    def _solve_variable(self, term: Term, scope: Scope, then: Solve) -> Solve:
        """A formula that is only known when it is asked: compiled then."""
        build = self.build(term, scope)

        def ask(frame: Frame) -> bool:
            inner = Scope(RULE_SLOTS)
            formula = resolve(build(frame))
            solve = self.compile(formula, inner, Known(), proved) if type(formula) is not Var else fail
            return solve([then, frame, *inner.slots])

        return ask

    def query(self, formula: Term) -> list[dict[str, Term]]:
        """All answers to a formula, each as name → value of the variables that got one."""
        scope = Scope()
        variables = [variable for variable in variables_in(formula) if variable.name != "_"]
        answers: list[dict[str, Term]] = []

        def collect(frame: Frame) -> bool:
            values = [(variable.name, resolve(frame[scope.slot(variable)] or variable)) for variable in variables]
            answers.append({name: value for name, value in values if type(value) is not Var})
            return False

        solve = self.formula(formula, scope, Known(), collect)
        for variable in variables:
            scope.slot(variable)
        solve([None] * scope.size)
        undo(self.trail, 0)
        return answers

    def instances(self, literal: Literal) -> list[Term]:
        """Every way in which the literal is believed."""
        scope = Scope()
        question = self.question(literal, scope)
        for variable in variables_in(literal):
            scope.slot(variable)
        asked = question([None] * scope.size)
        answers = asked.answers(asked)
        undo(self.trail, 0)
        return answers
