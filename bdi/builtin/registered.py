"""The internal actions and functions of one agent, among them those that its program defines."""

from typing import Any

from bdi.builtin.table import Table, find_builtin
from bdi.language.errors import UnknownInternalAction
from bdi.language.syntax import Function
from bdi.language.terms import Predicate, Structure, Term, Var, is_internal, literal_of, predicate
from bdi.model.logic import Builtin, HasLogic


class BoundActions:
    """Internal actions and functions, bound to an agent when they are first used."""

    def __init__(self, mind: HasLogic, own: Table | None) -> None:
        self._mind = mind
        self._own = own
        self._bound: dict[Predicate, Builtin | None] = {}

    def find(self, key: Predicate) -> Builtin | None:
        """Return the internal action or function with this predicate, if there is one."""
        if key not in self._bound:
            self._bound[key] = find_builtin(key, self._mind, self._own)
        return self._bound[key]

    def define(self, function: Function) -> None:
        """{ register_function("area", 2, "area_of") }"""
        self._bound[key_of(function)] = Registered(self._mind, function)


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
