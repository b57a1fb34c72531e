"""The table of internal actions and functions: `.name` → what it takes, and what it does.

An internal action is a Python function of the agent and its arguments. It answers True or False, or yields once for
every way in which it is true (having bound variables with `unify`). A function takes values and gives a value.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import Any, TypeAlias

from bdi.builtin.kinds import Kind, at_place, counts
from bdi.language.errors import NotALiteral, UnknownPerformative
from bdi.language.terms import Predicate, Structure, Term, show
from bdi.model.intentions import StepFailed
from bdi.model.logic import Builtin, HasLogic

Answer: TypeAlias = bool | Iterator[Any] | None  # None counts as True


@dataclass(frozen=True, slots=True)
class Definition:
    """One name of the table."""

    name: str
    call: Callable[..., Any]
    takes: tuple[Kind, ...] = ()
    named: bool = False  # whether it takes the variables of its plan, by name
    asks: bool = False  # a function that is given the agent first
    lazy: frozenset[int] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "lazy", frozenset(i for i, each in enumerate(self.takes) if each.lazy))

    def accepts(self, count: int) -> bool:
        least, most = counts(self.takes)
        return least <= count and (most is None or count <= most)

    def how_many(self) -> str:
        """ "2 arguments", "1 to 3 arguments", "1 or more arguments" """
        least, most = counts(self.takes)
        if most is None:
            return f"{least} or more arguments"
        return f"{least if least == most else f'{least} to {most}'} argument{'' if most == 1 else 's'}"

    def checks(self, count: int) -> list[tuple[int, Kind]]:
        """The places whose values have to be looked at."""
        kinds = [(place, at_place(self.takes, place)) for place in range(count)]
        return [(place, each) for place, each in kinds if each.holds is not None and not each.lazy]


class Table:
    """Internal actions and functions by name."""

    def __init__(self) -> None:
        self.actions: dict[str, Definition] = {}
        self.functions: dict[str, Definition] = {}

    def named(self, name: str) -> list[Definition]:
        return [table[name] for table in (self.actions, self.functions) if name in table]

    def like(self, name: str) -> list[str]:
        """Return names that may have been meant."""
        return get_close_matches(name, [*self.actions, *self.functions], 3, 0.75)


STANDARD = Table()
ACTIONS = STANDARD.actions
FUNCTIONS = STANDARD.functions


def internal_action(
    name: str, *takes: Kind, named: bool = False
) -> Callable[[Callable[..., Answer]], Callable[..., Answer]]:
    """Register `.name` with the kinds of its arguments.

    An argument of kind FORMULA comes as a `Question`: the action asks it itself. With `named` the first argument
    is a dictionary of the variables of the plan that calls.
    """

    def register(call: Callable[..., Answer]) -> Callable[..., Answer]:
        ACTIONS[f".{name}"] = Definition(f".{name}", call, takes, named)
        return call

    return register


def function(name: str, *takes: Kind, asks: bool = False) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Register a function that can stand where a number can, such as `math.abs`; with `asks` it gets the agent too."""

    def register(call: Callable[..., Any]) -> Callable[..., Any]:
        FUNCTIONS[name] = Definition(name, call, takes, asks=asks)
        return call

    return register


class Bound:
    """An internal action or function as one agent calls it. `ask(args)` answers True, False or an iterator."""

    __slots__ = ("ask", "function", "lazy", "named")

    def __init__(self, mind: HasLogic, key: Predicate, action: Definition | None, value: Definition | None) -> None:
        self.lazy = action.lazy if action else frozenset[int]()
        self.named = action is not None and action.named
        self.ask: Callable[[tuple[Any, ...]], bool | Iterator[Any]] = _asking(mind, key, action)
        self.function = _over_values(mind, key, value) if value else None


def find_builtin(key: Predicate, mind: HasLogic, own: Table | None = None) -> Builtin | None:
    """Find `.name/arity` for this agent, in its own table or in ours; or None."""
    for table in (own, STANDARD) if own else (STANDARD,):
        action, value = table.actions.get(key.name), table.functions.get(key.name)
        action = action if action and action.accepts(key.arity) else None
        value = value if value and value.accepts(key.arity) else None
        if action is not None or value is not None:
            return Bound(mind, key, action, value)
    return None


def _asking(
    mind: HasLogic, key: Predicate, action: Definition | None
) -> Callable[[tuple[Any, ...]], bool | Iterator[Any]]:
    if action is None:
        return lambda args: False
    call, before = action.call, int(action.named)
    checks = [(place + before, kind.types, kind.holds, kind) for place, kind in action.checks(key.arity)]

    def ask(args: tuple[Any, ...]) -> bool | Iterator[Any]:
        try:
            answer = call(mind, *args)
        except (NotALiteral, UnknownPerformative) as problem:
            raise StepFailed("wrong_arguments", f"{action.name}: {problem}") from problem
        return True if answer is None else answer

    def check_and_ask(args: tuple[Any, ...]) -> bool | Iterator[Any]:
        for place, types, holds, kind in checks:
            good = type(args[place]) in types if types else holds(args[place])  # type: ignore[misc]
            if not good:
                raise wrong_argument(action.name, place - before, kind, args[place])
        return ask(args)

    return check_and_ask if checks else ask


def _over_values(mind: HasLogic, key: Predicate, value: Definition) -> Callable[[tuple[Term, ...]], Term]:
    """A function stays an expression as long as it gets something that it cannot work with."""
    call, checks = value.call, value.checks(key.arity)
    first = (mind,) if value.asks else ()

    def apply(args: tuple[Term, ...]) -> Term:
        for place, kind in checks:
            if not kind.holds(args[place]):  # type: ignore[misc]
                return Structure(key, args)
        try:
            found: Term = call(*first, *args)
        except (TypeError, ValueError, AttributeError, ZeroDivisionError, OverflowError):
            return Structure(key, args)
        return found

    return apply


def wrong_argument(name: str, place: int, kind: Kind, got: object) -> StepFailed:
    return StepFailed("wrong_arguments", f"argument {place + 1} of {name} is {kind.name}, not {show(got)}")


def wrong_arguments(name: str, expected: str, got: object) -> StepFailed:
    return StepFailed("wrong_arguments", f".{name} takes {expected}, not {show(got)}")
