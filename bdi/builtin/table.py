"""The table of internal actions and functions: `.name` → what it does.

An internal action is a Python function of the agent and its arguments. It answers True or False, or yields once for
every way in which it is true (having bound variables with `unify`). A function takes values and gives a value.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, TypeAlias

from bdi.intentions import StepFailed
from bdi.logic import Builtin, HasLogic
from bdi.terms import Predicate, Structure, Term, show

Answer: TypeAlias = bool | Iterator[Any] | None  # None counts as True


@dataclass(frozen=True, slots=True)
class Definition:
    """One name of the table. `most` None: any number of arguments from `least` on."""

    name: str
    call: Callable[..., Any]
    least: int
    most: int | None
    lazy: frozenset[int] = frozenset()
    is_function: bool = False
    named: bool = False  # whether it is told which variables its plan has, by name

    def accepts(self, count: int) -> bool:
        return self.least <= count and (self.most is None or count <= self.most)


ACTIONS: dict[str, Definition] = {}
FUNCTIONS: dict[str, Definition] = {}


def internal_action(
    name: str, least: int, most: int | None = -1, lazy: tuple[int, ...] = (), named: bool = False
) -> Callable[[Callable[..., Answer]], Callable[..., Answer]]:
    """Register `.name` with `least` to `most` arguments (as many as `least` if not given, any number for None).

    Arguments in `lazy` come as a `Question`: a formula that the action asks itself. With `named` the first argument
    is a dictionary of the variables of the plan that calls.
    """

    def register(call: Callable[..., Answer]) -> Callable[..., Answer]:
        ACTIONS[f".{name}"] = Definition(
            f".{name}", call, least, least if most == -1 else most, frozenset(lazy), named=named
        )
        return call

    return register


def function(name: str, least: int, most: int | None = -1) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Register a function that can stand where a number can, such as `math.abs`."""

    def register(call: Callable[..., Any]) -> Callable[..., Any]:
        FUNCTIONS[name] = Definition(name, call, least, least if most == -1 else most, is_function=True)
        return call

    return register


class Bound:
    """An internal action or function as one agent calls it."""

    __slots__ = ("_call", "_mind", "function", "lazy", "named")

    def __init__(self, mind: HasLogic, action: Definition | None, value: Definition | None) -> None:
        self._mind = mind
        self._call = action.call if action else None
        self.lazy = action.lazy if action else frozenset()
        self.named = action is not None and action.named
        self.function = value.call if value else None

    def ask(self, args: tuple[Any, ...]) -> bool | Iterator[Any]:
        if self._call is None:
            return False
        answer = self._call(self._mind, *args)
        return True if answer is None else answer


def find_builtin(key: Predicate, mind: HasLogic) -> Builtin | None:
    """What `.name/arity` is for this agent, or None."""
    action, value = ACTIONS.get(key.name), FUNCTIONS.get(key.name)
    action = action if action and action.accepts(key.arity) else None
    value = value if value and value.accepts(key.arity) else None
    if action is None and value is None:
        return None
    bound = Bound(mind, action, value)
    if value is not None:
        bound.function = _over_values(key, value.call)
    return bound


def _over_values(key: Predicate, call: Callable[..., Any]) -> Callable[[tuple[Term, ...]], Term]:
    """A function stays an expression as long as it gets something that it cannot work with."""

    def apply(args: tuple[Term, ...]) -> Term:
        try:
            value: Term = call(*args)
        except (TypeError, ValueError, AttributeError, ZeroDivisionError, OverflowError):
            return Structure(key, args)
        return value

    return apply


def wrong_arguments(name: str, expected: str, got: object) -> StepFailed:
    return StepFailed("wrong_arguments", f".{name} takes {expected}, not {show(got)}")
