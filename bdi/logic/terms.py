"""Terms compiled: a function that makes the term from a frame, or matches a value against it."""

from collections.abc import Callable
from typing import Any

from bdi.arithmetic import OPERATION_OF, ArithmeticFailure
from bdi.logic.frames import Build, Builtin, Frame, Match, Scope
from bdi.terms import (
    ARITHMETIC,
    NEGATIVE,
    POSITIVE,
    Code,
    List,
    OpenList,
    Predicate,
    Structure,
    Term,
    Var,
    number,
)
from bdi.unify import (
    FIXED,
    Trail,
    annots_of,
    deref,
    evaluated,
    parts_of,
    resolve,
    unify,
    variables_in,
)


class Terms:
    """Compiles terms."""

    def __init__(self, builtin: Callable[[Predicate], Builtin | None]) -> None:
        self.builtin = builtin
        self.trail: Trail = []

    def build(self, term: Term, scope: Scope) -> Build:
        """A function that makes the term from a frame. Values may still hold variables bound later: `resolve` them."""
        if type(term) in FIXED:
            return lambda frame: term
        if type(term) is Var:
            return self._build_variable(scope.slot(term), term.name)
        if type(term) is Code:
            return self._build_code(term, scope)
        if not variables_in(term) and not self._has_functions(term):
            return self._build_ground(term)
        if type(term) is Structure:
            return self._build_structure(term, scope)
        return self._build_sequence(term, scope)

    def _build_variable(self, slot: int, name: str) -> Build:
        def variable(frame: Frame) -> Term:
            value = frame[slot]
            if value is None:
                value = frame[slot] = Var(name)
            elif type(value) is Var:
                return deref(value)
            return value  # type: ignore[no-any-return]

        return variable

    def _build_ground(self, term: Term) -> Build:
        try:
            value = resolve(term)
        except ArithmeticFailure:
            return lambda frame: resolve(term)
        return lambda frame: value

    def _build_code(self, term: Code, scope: Scope) -> Build:
        parts = [(variable, self.build(value, scope)) for variable, value in term.scope.items()]
        return lambda frame: Code(term.body, {variable: part(frame) for variable, part in parts})

    def _has_functions(self, term: Term) -> bool:
        if isinstance(term, Structure) and self._function(term.predicate):
            return True
        return any(self._has_functions(part) for part in parts_of(term))

    def _function(self, key: Predicate) -> Any:
        """The arithmetic function of this name, such as `math.abs`, if there is one."""
        if "." not in key.name and key.name != "time":
            return None
        return getattr(self.builtin(key), "function", None)

    def _build_structure(self, term: Structure, scope: Scope) -> Build:
        key = term.predicate
        if key in ARITHMETIC:
            return self._build_arithmetic(term, scope)
        parts = [self.build(arg, scope) for arg in term.args]
        annots = [self.build(annot, scope) for annot in term.annots]
        function = self._function(key)
        if function:
            return lambda frame: function(tuple([resolve(part(frame)) for part in parts]))
        if key is NEGATIVE or key is POSITIVE:
            return lambda frame: evaluated(Structure(key, (resolve(parts[0](frame)),)))
        if not annots:
            return lambda frame: Structure(key, tuple([part(frame) for part in parts]))
        return lambda frame: Structure(
            key, tuple([part(frame) for part in parts]), annots_of(tuple([annot(frame) for annot in annots]))
        )

    def _build_arithmetic(self, term: Structure, scope: Scope) -> Build:
        left, right = (self.build(arg, scope) for arg in term.args)
        key = term.predicate
        calculate = OPERATION_OF[key]

        def arithmetic(frame: Frame) -> Term:
            a, b = left(frame), right(frame)
            if type(a) in (int, float) and type(b) in (int, float):
                return number(calculate(a, b))  # type: ignore[arg-type]
            return evaluated(Structure(key, (resolve(a), resolve(b))))

        return arithmetic

    def _build_sequence(self, term: Term, scope: Scope) -> Build:
        if isinstance(term, OpenList):
            items = [self.build(item, scope) for item in term.items]
            tail = self.build(term.tail, scope)
            return lambda frame: resolve(OpenList(tuple([item(frame) for item in items]), tail(frame)))
        parts = [self.build(item, scope) for item in parts_of(term)]
        return lambda frame: List([part(frame) for part in parts])

    def match(self, pattern: Term, scope: Scope, met: set[Var]) -> Match:
        """A function that makes a pattern and a value equal; `met` are the variables seen to the left of here."""
        if type(pattern) is Var:
            first = pattern not in met
            met.add(pattern)
            return self._match_first(scope.slot(pattern)) if first else self._match_again(scope.slot(pattern))
        if type(pattern) in FIXED:
            return self._match_constant(pattern)
        met.update(variables_in(pattern))
        build, trail = self.build(pattern, scope), self.trail
        return lambda frame, value: unify(build(frame), value, trail)

    def _match_first(self, slot: int) -> Match:
        def first(frame: Frame, value: Term) -> bool:
            frame[slot] = value
            return True

        return first

    def _match_again(self, slot: int) -> Match:
        trail = self.trail
        return lambda frame, value: unify(frame[slot], value, trail)

    def _match_constant(self, constant: Term) -> Match:
        trail = self.trail
        return lambda frame, value: value == constant or (type(value) not in FIXED and unify(constant, value, trail))
