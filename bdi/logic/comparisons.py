"""X < Y   X == Y   X = Y   X =.. [name,args,annots]"""

from collections.abc import Callable
from typing import Any

from bdi.arithmetic import ArithmeticFailure
from bdi.logic.frames import Build, Frame, Scope, Solve
from bdi.logic.terms import Terms
from bdi.terms import (
    Atom,
    List,
    Structure,
    Term,
    atom,
    literal_of,
    predicate,
)
from bdi.unify import (
    compare,
    resolve,
    undo,
    unify,
)


class Comparisons(Terms):
    """Compiles comparisons."""

    def comparison(self, term: Structure, scope: Scope, then: Solve) -> Solve:
        """X < Y   X == Y   X = Y   X =.. [name,args,annots]"""
        left, right = (self.build(arg, scope) for arg in term.args)
        name = term.predicate.name
        if name == "=":
            return self._solve_equation(left, right, then)
        if name == "=..":
            return self._solve_decomposition(left, right, then)
        test = _TESTS[name]

        def compared(frame: Frame) -> bool:
            try:
                a, b = left(frame), right(frame)
                holds = test(a, b) if type(a) is int and type(b) is int else _holds(name, resolve(a), resolve(b))
            except ArithmeticFailure:
                return False
            return holds and then(frame)

        return compared

    def _solve_equation(self, left: Build, right: Build, then: Solve) -> Solve:
        trail = self.trail

        def equation(frame: Frame) -> bool:
            mark = len(trail)
            try:
                if unify(resolve(left(frame)), resolve(right(frame)), trail) and then(frame):
                    return True
            except ArithmeticFailure:
                pass
            undo(trail, mark)
            return False

        return equation

    def _solve_decomposition(self, left: Build, right: Build, then: Solve) -> Solve:
        trail = self.trail

        def decomposition(frame: Frame) -> bool:
            mark = len(trail)
            value, pattern = resolve(left(frame)), resolve(right(frame))
            if isinstance(value, Atom | Structure):
                parts: Term = List([atom(value.functor), List(value.args), List(value.annots)])
                done = unify(parts, pattern, trail)
            else:
                made = _composed(pattern)
                done = made is not None and unify(value, made, trail)
            if done and then(frame):
                return True
            undo(trail, mark)
            return False

        return decomposition


def _composed(pattern: Term) -> Term | None:
    """[p,[a],[x]] → p(a)[x]"""
    if not isinstance(pattern, List) or len(pattern) != 3:
        return None
    name, args, annots = pattern
    if not isinstance(name, Atom) or not isinstance(args, List) or not isinstance(annots, List):
        return None
    return literal_of(predicate(name.functor, len(args)), tuple(args), tuple(annots))


_TESTS: dict[str, Callable[[Any, Any], bool]] = {
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "==": lambda a, b: a == b,
    "\\==": lambda a, b: a != b,
}


def _holds(name: str, a: Term, b: Term) -> bool:
    """Numbers by value, other terms by the standard order."""
    if name in ("==", "\\==") or (type(a) in (int, float) and type(b) in (int, float)):
        return _TESTS[name](a, b)
    return _TESTS[name](compare(a, b), 0)
