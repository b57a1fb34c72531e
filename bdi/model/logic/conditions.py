"""Formulas that only say yes or no, as Python expressions."""

from abc import ABC, abstractmethod

from bdi.language.terms import (
    AND,
    ANNOTATED,
    FALSE,
    IN_SPACE,
    NOT,
    OR,
    RELATIONS,
    TRUE,
    Atom,
    Code,
    Literal,
    Structure,
    Term,
    Var,
    is_internal,
)
from bdi.language.unify import FIXED, variables_in
from bdi.model.beliefs import Relation
from bdi.model.logic.terms import TermWriter, is_simple
from bdi.model.logic.writer import Flow, Writer

PYTHON_TESTS = {"<": "<", "<=": "<=", ">": ">", ">=": ">=", "==": "==", "\\==": "!="}


class Conditions(TermWriter, ABC):
    """Writes formulas that bind nothing."""

    @abstractmethod
    def relation_of(self, literal: Literal) -> Relation: ...

    @abstractmethod
    def is_regular(self, relation: Relation) -> bool:
        """Return whether equality finds its facts. When that ends, what was compiled with it is compiled again."""

    def condition(self, w: Writer, term: Term, flow: Flow, silent: bool = False) -> str | None:
        """A Python expression, if the formula binds nothing and has one answer at most.

        `silent`: only yes or no counts, as within `not`.
        """
        if not isinstance(term, Atom | Structure):
            return None if isinstance(term, Var | Code) else "False"
        key = term.predicate
        if term is TRUE:
            return "True"
        if term is FALSE:
            return "False"
        if key is NOT:
            inner = self.condition(w, term.args[0], flow, silent=True)
            return inner and (inner[4:] if inner.startswith("not ") else f"not {inner}")
        if key is AND or (key is OR and (silent or w.once)):
            return self._both_or_either(w, term, flow, silent)
        if key in (OR, IN_SPACE, ANNOTATED) or is_internal(key.name):
            return None
        if key in RELATIONS:
            return self._compared(w, term, flow, silent)
        return self._believed(w, term, flow, silent)

    def _both_or_either(self, w: Writer, term: Literal, flow: Flow, silent: bool) -> str | None:
        left, right = term.args
        one = self.condition(w, left, flow, silent)
        if one is None:
            return None
        found = variables_in(left).keys() - flow.names.keys()
        if found and not found.isdisjoint(variables_in(right)):
            return None  # what the left side finds is for the right side
        other = self.condition(w, right, flow, silent)
        return other and f"({one} {'and' if term.predicate is AND else 'or'} {other})"

    def _compared(self, w: Writer, term: Literal, flow: Flow, silent: bool) -> str | None:
        if self.may_fail(term) or any(variable not in flow.names for variable in variables_in(term)):
            return None
        left, right = term.args
        name = term.predicate.name
        if name == "=":
            return self._equal(w, left, right, flow, silent)
        if name == "=..":
            return None
        a, b = self.expression(w, left, flow), self.expression(w, right, flow)
        if not (a.isidentifier() or type(left) is int) or not (b.isidentifier() or type(right) is int):
            return f"holds({name!r}, {a}, {b})"
        tests = [f"type({made}) is int" for made, part in ((a, left), (b, right)) if type(part) is not int]
        quick = f"{a} {PYTHON_TESTS[name]} {b}"
        return f"({quick} if {' and '.join(tests) or 'True'} else holds({name!r}, {a}, {b}))"

    def _equal(self, w: Writer, left: Term, right: Term, flow: Flow, silent: bool) -> str | None:
        """X = Y, where equality is enough, or where the bindings are not needed."""
        if is_simple(left) and is_simple(right):
            a, b = self.expression(w, left, flow), self.expression(w, right, flow)
            if flow.is_plain(left) and flow.is_plain(right):
                return f"({a} == {b})"
            if silent:
                unsure = [made for made, part in ((a, left), (b, right)) if not flow.is_plain(part)]
                fixed = " and ".join(f"type({each}) in FIXED" for each in unsure)
                return f"({a} == {b} if {fixed} else unifies({a}, {b}))"
        if silent:
            return f"unifies({self.expression(w, left, flow)}, {self.expression(w, right, flow)})"
        return None

    def _believed(self, w: Writer, term: Literal, flow: Flow, silent: bool) -> str | None:
        """p(a,X), where one look will do."""
        relation = self.relation_of(term)
        if term.annots or not all(map(is_simple, term.args)) or not self.is_regular(relation):
            return None
        name = w.constant(relation, term.functor)
        free = [arg for arg in term.args if type(arg) is Var and arg not in flow.names]
        if not free and all(map(flow.is_plain, term.args)):
            fixed = all(type(arg) in FIXED for arg in term.args)
            args = w.constant(term.args, "args") if fixed else self.expressions(w, term.args, flow)
            return f"({args} in {name}.facts)"
        if silent and free and len(set(free)) == len(term.args):
            return f"{name}.facts"
        return None
