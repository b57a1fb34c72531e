"""Functions that a program defines: `{ register_function("area", 2, "area_of") }`."""

from typing import Any

from bdi.language.errors import UnknownInternalAction
from bdi.language.syntax import Function
from bdi.language.terms import Predicate, Structure, Term, Var, is_internal, literal_of, predicate
from bdi.model.logic import HasLogic


class Registered:
    """`area(X,Y)` is the first Z for which `area_of(X,Y,Z)` holds; without one it stays an expression."""

    lazy: frozenset[int] = frozenset()
    named = False

    def __init__(self, mind: HasLogic, function: Function) -> None:
        if is_internal(function.target.name) and mind.logic.builtin(function.target) is None:
            name, count = function.target.name, function.target.arity
            raise UnknownInternalAction(f"there is no internal action {name} of {count} arguments", function.place)
        self._logic = mind.logic
        self._target = function.target
        self._key = key_of(function)

    def ask(self, args: tuple[Any, ...]) -> bool:
        return False  # a function says nothing true or false

    def function(self, args: tuple[Term, ...]) -> Term:
        """The value."""
        result = Var("Result")
        value = self._logic.first(literal_of(self._target, (*args, result)), result)
        return Structure(self._key, args) if value is None else value


def key_of(function: Function) -> Predicate:
    return predicate(function.name, function.arity)
