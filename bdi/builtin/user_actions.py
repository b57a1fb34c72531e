"""Internal actions of your own, in Python.

    library = InternalActions()

    @library.action("courier.distance")                    # courier.distance(3, X, D)
    def distance(mind: Mind, a: float, b: float) -> float:
        return abs(a - b)

    @library.action("courier.post")                        # courier.post(P): every one in turn
    def post(mind: Mind) -> Iterator[str]:
        yield from ("library", "canteen")

    @library.function("courier.cost")                      # X = 2 * courier.cost(3.5)
    def cost(mind: Mind, km: float) -> float:
        return 0.3 * km

    agent = Agent(program, internal_actions=library)

The kinds of the arguments are read off the annotations, or given after the name: `@library.action("courier.distance",
NUMBER, NUMBER, OUT)`. Each annotation is a kind:

| Python | AgentSpeak |
|---|---|
| `float`, `int` | a number, a whole number |
| `str`, `bool` | a string, one of the atoms `true` and `false` |
| `list` | a list, its items by their own kind |
| `Atom`, `Literal` | an atom, a literal, as they are |
| anything else | any term; strings and lists come as Python ones |

An argument with a default may be left out; `*args` takes any number. What is returned is one more argument, unified
with the answer (a tuple: several more); nothing at all for `-> bool` and `-> None`, which say whether it is true. An
iterator gives one answer after the other. `None` as an answer is none: the action fails.

An exception in your code makes the step fail with `error(ia_failed)` and a message that names the action.
"""

import inspect
from collections.abc import Callable, Collection, Iterable, Iterator
from typing import Any, get_args, get_origin, get_type_hints

from bdi.builtin.kinds import ANY, ATOM, LIST, LITERAL, NUMBER, OUT, STRING, WHOLE, Kind, at_place, optional, rest
from bdi.builtin.table import STANDARD, Definition, Table
from bdi.language.terms import (
    FALSE,
    TRUE,
    Atom,
    Code,
    Handle,
    List,
    Literal,
    OpenList,
    String,
    Structure,
    Term,
    Var,
    number,
)
from bdi.language.unify import undo, unify
from bdi.model.intentions import StepFailed
from bdi.model.logic import HasLogic

__all__ = ["ANY", "ATOM", "LIST", "LITERAL", "NUMBER", "OUT", "STRING", "TRUTH", "WHOLE", "InternalActions"]
__all__ += ["optional", "rest"]

TRUTH = Kind("true or false", lambda value: value in (TRUE, FALSE))
_KINDS: dict[Any, Kind] = {float: NUMBER, int: WHOLE, str: STRING, bool: TRUTH, Atom: ATOM, Literal: LITERAL}
_TERMS = (Atom, Structure, String, List, OpenList, Var, Handle, Code)


class InternalActions(Table):
    """The internal actions and functions that some agents have beside ours. Each belongs to a package: `pkg.name`."""

    def action(self, name: str, *takes: Kind) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
        """Register `name` for use as a step and in conditions. Raises ValueError for a name that cannot be one."""

        def register(call: Callable[..., Any]) -> Callable[..., Any]:
            self._refuse(name)
            kinds = takes or _signature(call)
            self.actions[name] = Definition(name, _answering(name, call, kinds), kinds)
            return call

        return register

    def function(self, name: str, *takes: Kind) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
        """Register `name` for use where a value can stand. Raises ValueError for a name that cannot be one."""

        def register(call: Callable[..., Any]) -> Callable[..., Any]:
            self._refuse(name)
            kinds = takes or _inputs(call)
            self.functions[name] = Definition(name, _valued(name, call, kinds), kinds, asks=True)
            return call

        return register

    def _refuse(self, name: str) -> None:
        words = name.split(".")
        if len(words) < 2 or not all(word.isidentifier() and word[0].islower() for word in words):
            raise ValueError(f"{name!r} is no name for an internal action: give package and name, as courier.distance")
        if self.named(name) or STANDARD.named(name):
            raise ValueError(f"there is {name} already")


# ---- kinds from annotations ----------------------------------------------------------------------------------------


def _inputs(call: Callable[..., Any]) -> tuple[Kind, ...]:
    """The kinds of what comes after the agent."""
    hints = get_type_hints(call)
    parameters = list(inspect.signature(call).parameters.values())[1:]
    return tuple(_kind_of(parameter, hints.get(parameter.name)) for parameter in parameters)


def _kind_of(parameter: inspect.Parameter, hint: Any) -> Kind:
    found = LIST if hint is list or get_origin(hint) is list else _KINDS.get(hint, ANY)
    if parameter.kind is inspect.Parameter.VAR_POSITIONAL:
        return rest(found)
    return found if parameter.default is inspect.Parameter.empty else optional(found)


def _signature(call: Callable[..., Any]) -> tuple[Kind, ...]:
    """Inputs, then answers. Raises ValueError where an input may be left out before an answer."""
    inputs, answers = _inputs(call), _answers(get_type_hints(call).get("return"))
    if answers and any(each.optional for each in inputs):
        raise ValueError(f"{call.__name__}: no argument can be left out before an answer; register it twice instead")
    return (*inputs, *[OUT] * answers)


def _answers(hint: Any) -> int:
    """Return how many arguments the answer takes."""
    origin = get_origin(hint)
    if isinstance(origin, type) and issubclass(origin, Iterable) and not issubclass(origin, Collection):
        return _answers(get_args(hint)[0])
    if origin is tuple:
        return len(get_args(hint))
    return 0 if hint in (None, bool, type(None)) else 1


# ---- calling -------------------------------------------------------------------------------------------------------


def _answering(name: str, call: Callable[..., Any], kinds: tuple[Kind, ...]) -> Callable[..., Any]:
    def ask(mind: HasLogic, *args: Term) -> bool | Iterator[bool]:
        inputs, outs = [], []
        for place, arg in enumerate(args):
            kind = at_place(kinds, place)
            if kind.out:
                outs.append(arg)
            else:
                inputs.append(python_of(arg, kind))
        found = _called(name, call, mind, *inputs)
        if isinstance(found, Iterator):
            return _each(mind, name, found, outs)
        return _unified(mind, name, found, outs)

    return ask


def _valued(name: str, call: Callable[..., Any], kinds: tuple[Kind, ...]) -> Callable[..., Term]:
    def value(mind: HasLogic, *args: Term) -> Term:
        inputs = [python_of(arg, at_place(kinds, place)) for place, arg in enumerate(args)]
        return _called(name, lambda: term_of(call(mind, *inputs)))  # type: ignore[no-any-return]

    return value


def _called(name: str, call: Callable[..., Any], *args: Any) -> Any:
    """Call the user's code; an exception in it becomes the failure of the step."""
    try:
        return call(*args)
    except StepFailed:
        raise
    except Exception as problem:
        raise StepFailed("ia_failed", f"{name}: {type(problem).__name__}: {problem}") from problem


def _each(mind: HasLogic, name: str, answers: Iterator[Any], outs: list[Term]) -> Iterator[bool]:
    trail = mind.logic.trail
    while (found := _called(name, next, answers, _NO_MORE)) is not _NO_MORE:
        mark = len(trail)
        if _unified(mind, name, found, outs):
            yield True
        undo(trail, mark)


_NO_MORE = object()


def _unified(mind: HasLogic, name: str, found: Any, outs: list[Term]) -> bool:
    if not outs:
        return found is not False
    if found is None:
        return False
    values = found if len(outs) > 1 else (found,)
    terms = _called(name, lambda: [term_of(value) for value in values])
    if len(terms) != len(outs):
        raise StepFailed("ia_failed", f"{name} answers {len(terms)} values, not {len(outs)}")
    return all(unify(out, term, mind.logic.trail) for out, term in zip(outs, terms, strict=True))


# ---- values --------------------------------------------------------------------------------------------------------


def python_of(term: Term, kind: Kind = ANY) -> Any:
    """A string as `str`, a list as `list`, true and false as `bool` where that is the kind; other terms as they are."""
    if isinstance(term, String):
        return str.__str__(term)
    if isinstance(term, List):
        return [python_of(item) for item in term]
    return term is TRUE if kind.name == TRUTH.name else term


def term_of(value: Any) -> Term:
    """A Python value as a term. Raises TypeError for one that is none."""
    if isinstance(value, bool):
        return TRUE if value else FALSE
    if isinstance(value, int | float):
        return number(value)
    if isinstance(value, _TERMS):
        return value
    if isinstance(value, str):
        return String(value)
    if isinstance(value, list | tuple):
        return List(term_of(item) for item in value)
    raise TypeError(f"{value!r} is no term: answer a number, a string, a list or a term")
