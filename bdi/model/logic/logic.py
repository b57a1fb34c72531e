"""Asking: formulas that come at run time, questions within questions, questions from outside."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, Protocol, TypeAlias

from bdi.language.terms import (
    ANNOTATED,
    DEFAULT_SPACE,
    IN_SPACE,
    OPERATORS,
    PRIVATE_SPACE,
    Atom,
    Literal,
    Predicate,
    Structure,
    Term,
    Var,
    atom,
    in_space,
    is_internal,
    literal_of,
    plain,
    space_of,
)
from bdi.language.unify import renamed, resolve, substituted, undo, unify, variables_in
from bdi.model.beliefs import Beliefs
from bdi.model.logic.frames import Builtin, Known, Scope, deep_stack
from bdi.model.logic.functions import Compiled, Functions
from bdi.model.logic.writer import Flow

DEEPEST_QUESTIONS = 100  # `.findall` within `.findall`
REMEMBERED_FORMULAS = 500  # that came as values at run time
DEFAULT = atom(DEFAULT_SPACE)
NOT_PLAIN = frozenset({"not", "true", "false", "::"} | OPERATORS)
Values: TypeAlias = tuple[Any, ...]


class HasLogic(Protocol):
    logic: "Logic"


class Logic(Functions):
    """Compiles and asks. One for each agent."""

    def __init__(self, beliefs: Beliefs, builtin: Callable[[Predicate], Builtin | None]) -> None:
        super().__init__(beliefs, builtin)
        self._runtime["ask"] = self._ask_formula
        self._questions = 0  # that are being asked within each other
        self._formulas: dict[Term, Compiled] = {}

    # ---- formulas that come as values ------------------------------------------------------------------------------

    def _ask_formula(self, formula: Term, then: Callable[[], Any]) -> Any:
        """A formula that is only known now; X and X[a] with a free X ask for all beliefs."""
        if type(formula) is Var or (type(formula) is Structure and formula.predicate is ANNOTATED):
            formula = in_space(DEFAULT, formula)
        elif not isinstance(formula, Atom | Structure):
            return None
        solve, values = self._compiled(formula)
        return solve.call(*values, then)

    def _compiled(self, formula: Term) -> tuple[Compiled, Values]:
        """solve(*values, collect), remembered by how the formula reads, and the values to call it with."""
        if isinstance(formula, Atom | Structure) and self._is_plain_literal(formula):
            places = _places(len(formula.args))
            return self._remembered(literal_of(formula.predicate, places), places), formula.args
        variables = tuple(variables_in(formula))
        places = _places(len(variables))
        return self._remembered(substituted(formula, dict(zip(variables, places, strict=True))), places), variables

    def _is_plain_literal(self, term: Literal) -> bool:
        key = term.predicate
        return not term.annots and key.name not in NOT_PLAIN and not is_internal(key.name)

    def _remembered(self, formula: Term, places: Values) -> Compiled:
        found = self._formulas.get(formula)
        if found is None:
            if len(self._formulas) >= REMEMBERED_FORMULAS:
                self._formulas.clear()
            found = self._formulas[formula] = Compiled(partial(self._compile_formula, formula, places))
        return found

    def _compile_formula(self, formula: Term, places: Values, forget: Callable[[], None]) -> Callable[..., Any]:
        w = self._writer((), once=False)
        flow = Flow({variable: w.fresh("V") for variable in places})
        names = list(flow.names.values())
        with w.function("solve", ", ".join([*names, "collect"])):

            def collect(now: Flow) -> None:
                w.line("answer = collect()")
                w.line("if answer is not None: return answer")

            self.formula(w, formula, flow, collect)
        return self._made(w, "solve", forget)

    def _all_answers(self, formula: Term, build: Callable[[], Any], most: int | None = None) -> list[Any]:
        """Return the result of `build` for each answer, or for so many."""
        solve, values = self._compiled(formula)

        def ask() -> list[Any]:
            found: list[Any] = []

            def collect() -> bool | None:
                found.append(build())
                return True if len(found) == most else None

            solve.call(*values, collect)
            return found

        answers: list[Any] = self.ask_within(ask)
        return answers

    def query(self, formula: Term, most: int | None = None) -> list[dict[str, Term]]:
        """Return all answers to a formula (or so many), each as name → value of the variables that got one."""
        variables = [variable for variable in variables_in(formula) if variable.name != "_"]

        def named() -> dict[str, Term]:
            pairs = [(variable.name, resolve(variable)) for variable in variables]
            return {name: value for name, value in pairs if type(value) is not Var}

        return self._all_answers(formula, named, most)

    def count(self, formula: Term) -> int:
        """Return how many answers there are."""
        return len(self._all_answers(formula, lambda: None))

    def first(self, formula: Term, wanted: Term) -> Term | None:
        """Return the value of `wanted` in the first answer."""
        found = self._all_answers(formula, lambda: renamed(wanted, {}), most=1)
        return found[0] if found else None

    def instances(self, literal: Literal) -> list[Term]:
        """Every way in which the literal is believed."""
        return self._all_answers(literal, lambda: renamed(literal, {}))

    def bound_in_any_space(self, wanted: Literal) -> Iterator[None]:
        """Bind NS::p(X) or n::X to each belief that it is about."""
        mark = len(self.trail)
        for belief in self.in_any_space(wanted):
            if unify(wanted, belief, self.trail):
                yield
            undo(self.trail, mark)

    def in_any_space(self, wanted: Literal) -> Iterator[Term]:
        """Yield the beliefs that `NS::p(X)` or `n::X` can mean."""
        if wanted.predicate is not IN_SPACE:
            yield from self.instances(wanted)
            return
        space, inner = wanted.args
        for key in list(self.beliefs.relations):
            if space is not space_of(key) and not (type(space) is Var and not key.namespace.startswith(PRIVATE_SPACE)):
                continue
            if type(inner) is Var or (isinstance(inner, Structure) and inner.predicate is ANNOTATED):
                anything = tuple([Var() for _ in range(key.arity)])
                yield from self.instances(literal_of(key, anything, getattr(inner, "annots", ())))
            elif isinstance(inner, Atom | Structure) and inner.predicate is plain(key):
                yield from self.instances(literal_of(key, inner.args, inner.annots))

    def value_of(self, term: Term) -> Term:
        """The term with arithmetic and functions worked out."""
        scope = Scope()
        scope.add_all(variables_in(term))
        value: Term = self.builder((term,), scope, Known(), resolved=True).call([None] * scope.size)[0]
        return value

    def ask_within(self, ask: Callable[[], Any]) -> Any:
        """A question with a mind of its own, such as that of `.findall`: nothing stays bound."""
        if self._questions >= DEEPEST_QUESTIONS:
            raise RecursionError("a formula asks itself")
        mark = len(self.trail)
        self._questions += 1
        try:
            return self.ask_deeply(ask)
        finally:
            self._questions -= 1
            undo(self.trail, mark)

    def ask_deeply(self, ask: Callable[[], Any]) -> Any:
        """Ask with a higher stack if it takes one, unless the question around this one has raised it."""
        mark = len(self.trail)
        try:
            return ask()
        except RecursionError:
            if self._asking or self._questions > 1:
                raise
            undo(self.trail, mark)
            with deep_stack():
                return ask()


_PLACES: list[Var] = []


def _places(count: int) -> tuple[Var, ...]:
    """The same variables every time, so that formulas that read alike are alike."""
    while len(_PLACES) < count:
        _PLACES.append(Var(f"V{len(_PLACES)}"))
    return tuple(_PLACES[:count])
