"""Internal actions and functions about values alone: lists, strings, numbers, sets, maps and queues."""

import math
import statistics
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from functools import cmp_to_key
from typing import Any

from bdi.builtin import Answer, function, internal_action, wrong_arguments
from bdi.logic import HasLogic, Question
from bdi.parser import parse_term
from bdi.terms import Atom, Handle, List, OpenList, String, Structure, Term, Var, number, show
from bdi.unify import compare, deref, is_ground, renamed, substituted, undo, unify, variables_in

in_order = cmp_to_key(compare)


def _unify(mind: HasLogic, left: Term, right: Term) -> bool:
    return unify(left, right, mind.logic.trail)


def _each(mind: HasLogic, alternatives: Iterable[tuple[tuple[Term, Term], ...]]) -> Iterator[bool]:
    """Once for every alternative whose pairs all unify."""
    trail = mind.logic.trail
    for pairs in alternatives:
        mark = len(trail)
        if all(unify(left, right, trail) for left, right in pairs):
            yield True
        undo(trail, mark)


def items_of(term: Term, name: str) -> tuple[Term, ...]:
    """The items of a list, set or queue. Raises StepFailed(wrong_arguments)."""
    if isinstance(term, List):
        return tuple(term)
    if isinstance(term, Handle):
        return tuple(term.value)
    raise wrong_arguments(name, "a list", term)


def text_of(term: Term) -> str:
    """A string without its quotes; any other term as it is written."""
    return str.__str__(term) if isinstance(term, String) else show(term)


# ---- lists ---------------------------------------------------------------------------------------------------------


@internal_action("member", 2)
def member(mind: HasLogic, item: Term, items: Term) -> Answer:
    return _each(mind, (((item, each),) for each in items_of(items, "member")))


@internal_action("length", 2)
def length(mind: HasLogic, value: Term, count: Term) -> Answer:
    return _unify(mind, count, length_of(value))


@function(".length", 1)
def length_of(value: Term) -> Term:
    if isinstance(value, Handle):
        return len(value.value)
    if isinstance(value, List | String):
        return len(value)
    raise wrong_arguments("length", "a list or string", value)


@internal_action("nth", 3)
def nth(mind: HasLogic, place: Term, items: Term, item: Term) -> Answer:
    found = items_of(items, "nth")
    if isinstance(place, int):
        if not 0 <= place < len(found):
            raise wrong_arguments("nth", f"an index from 0 to {len(found) - 1}", place)
        return _unify(mind, item, found[place])
    return _each(mind, (((place, at), (item, each)) for at, each in enumerate(found)))


@internal_action("concat", 3, None)
def concat(mind: HasLogic, *args: Term) -> Answer:
    *parts, result = args
    if all(isinstance(part, List) for part in parts):
        return _unify(mind, result, List([item for part in parts for item in items_of(part, "concat")]))
    if len(parts) == 2 and isinstance(result, List) and any(isinstance(part, Var) for part in parts):
        splits = ((List(result[:at]), List(result[at:])) for at in range(len(result) + 1))
        return _each(mind, (((parts[0], left), (parts[1], right)) for left, right in splits))
    return _unify(mind, result, String("".join(map(text_of, parts))))


@internal_action("delete", 3)
def delete(mind: HasLogic, item: Term, value: Term, result: Term) -> Answer:
    """A number deletes by index, a term deletes all its equals, from lists and strings."""
    if isinstance(value, String):
        text = str.__str__(value)
        cut = text[:item] + text[item + 1 :] if isinstance(item, int) else text.replace(text_of(item), "")
        return _unify(mind, result, String(cut))
    items = items_of(value, "delete")
    if isinstance(item, int):
        return _unify(mind, result, List(items[:item] + items[item + 1 :]))
    return _unify(mind, result, List([each for each in items if not _unifiable(mind, item, each)]))


def _unifiable(mind: HasLogic, left: Term, right: Term) -> bool:
    mark = len(mind.logic.trail)
    found = _unify(mind, left, right)
    undo(mind.logic.trail, mark)
    return found


@internal_action("reverse", 2)
def reverse(mind: HasLogic, value: Term, result: Term) -> Answer:
    if isinstance(value, String):
        return _unify(mind, result, String(str.__str__(value)[::-1]))
    return _unify(mind, result, List(items_of(value, "reverse")[::-1]))


@internal_action("sort", 2)
def sort(mind: HasLogic, items: Term, result: Term) -> Answer:
    return _unify(mind, result, List(sorted(items_of(items, "sort"), key=in_order)))


@internal_action("max", 2)
def largest(mind: HasLogic, items: Term, result: Term) -> Answer:
    found = items_of(items, "max")
    return bool(found) and _unify(mind, result, max(found, key=in_order))


@internal_action("min", 2)
def smallest(mind: HasLogic, items: Term, result: Term) -> Answer:
    found = items_of(items, "min")
    return bool(found) and _unify(mind, result, min(found, key=in_order))


def _unique(items: Iterable[Term]) -> List:
    return List(sorted(dict.fromkeys(items), key=in_order))


@internal_action("union", 3)
def union(mind: HasLogic, left: Term, right: Term, result: Term) -> Answer:
    return _unify(mind, result, _unique(items_of(left, "union") + items_of(right, "union")))


@internal_action("intersection", 3)
def intersection(mind: HasLogic, left: Term, right: Term, result: Term) -> Answer:
    others = items_of(right, "intersection")
    return _unify(mind, result, _unique(item for item in items_of(left, "intersection") if item in others))


@internal_action("difference", 3)
def difference(mind: HasLogic, left: Term, right: Term, result: Term) -> Answer:
    others = items_of(right, "difference")
    return _unify(mind, result, _unique(item for item in items_of(left, "difference") if item not in others))


@internal_action("sublist", 2)
def sublist(mind: HasLogic, part: Term, items: Term) -> Answer:
    found = items_of(items, "sublist")
    spans = ((a, b) for a in range(len(found)) for b in range(len(found), a, -1))
    return _each(mind, (((part, List(found[a:b])),) for a, b in spans))


@internal_action("prefix", 2)
def prefix(mind: HasLogic, part: Term, items: Term) -> Answer:
    found = items_of(items, "prefix")
    return _each(mind, (((part, List(found[:end])),) for end in range(len(found), -1, -1)))


@internal_action("suffix", 2)
def suffix(mind: HasLogic, part: Term, items: Term) -> Answer:
    found = items_of(items, "suffix")
    return _each(mind, (((part, List(found[start:])),) for start in range(len(found) + 1)))


@internal_action("empty", 1)
def empty(mind: HasLogic, value: Term) -> Answer:
    return bool(length_of(value) == 0)


@internal_action("range", 3, 4)
def span(mind: HasLogic, value: Term, start: Term, end: Term, by: Term = 1) -> Answer:
    if not isinstance(start, int) or not isinstance(end, int) or not isinstance(by, int) or not by:
        raise wrong_arguments("range", "whole numbers", List([start, end, by]))
    steps = range(start, end + (1 if by > 0 else -1), by)
    if isinstance(value, int):
        return value in steps
    return _each(mind, (((value, each),) for each in steps))


# ---- formulas ------------------------------------------------------------------------------------------------------


@internal_action("findall", 3, lazy=(0, 1))
def findall(mind: HasLogic, template: Question, formula: Question, result: Term) -> Answer:
    return _unify(mind, result, List(formula.answers(template)))


@internal_action("setof", 3, lazy=(0, 1))
def setof(mind: HasLogic, template: Question, formula: Question, result: Term) -> Answer:
    return _unify(mind, result, _unique(formula.answers(template)))


@internal_action("count", 2, lazy=(0,))
def count(mind: HasLogic, formula: Question, result: Term) -> Answer:
    return _unify(mind, result, len(formula.answers(formula)))


# ---- strings -------------------------------------------------------------------------------------------------------


@internal_action("substring", 2, 4)
def substring(mind: HasLogic, part: Term, whole: Term, start: Term | None = None, end: Term | None = None) -> Answer:
    """Where the part stands; with a given start (and end) the part itself."""
    text = text_of(whole)
    if isinstance(part, Var) and isinstance(start, int):
        stop = end if isinstance(end, int) else len(text)
        return _unify(mind, part, String(text[start:stop]))
    wanted = text_of(part)
    places = (at for at in range(len(text) + 1) if text.startswith(wanted, at))
    pairs: list[tuple[tuple[Term, Term], ...]] = []
    for at in places:
        found: list[tuple[Term, Term]] = [(start, at)] if start is not None else []
        pairs.append((*found, *([(end, at + len(wanted))] if end is not None else [])))
    return _each(mind, pairs)


@internal_action("upper_case", 2)
def upper_case(mind: HasLogic, text: Term, result: Term) -> Answer:
    return _unify(mind, result, String(text_of(text).upper()))


@internal_action("lower_case", 2)
def lower_case(mind: HasLogic, text: Term, result: Term) -> Answer:
    return _unify(mind, result, String(text_of(text).lower()))


@internal_action("replace", 4)
def replace(mind: HasLogic, text: Term, old: Term, new: Term, result: Term) -> Answer:
    return _unify(mind, result, String(text_of(text).replace(text_of(old), text_of(new))))


@internal_action("term2string", 2, named=True)
def term2string(mind: HasLogic, names: dict[str, Term], term: Term, text: Term) -> Answer:
    """Variables in the text are those of the plan."""
    if isinstance(term, Var) and isinstance(text, String):
        parsed = parse_term(str.__str__(text))
        values = {variable: names[variable.name] for variable in variables_in(parsed) if variable.name in names}
        return _unify(mind, term, substituted(parsed, values))
    return _unify(mind, text, String(text_of(term)))


# ---- kinds of terms ------------------------------------------------------------------------------------------------

KINDS: dict[str, Callable[[Term], bool]] = {
    "atom": lambda term: isinstance(term, Atom),
    "structure": lambda term: isinstance(term, Structure | List | OpenList | Atom),
    "literal": lambda term: isinstance(term, Structure | Atom),
    "list": lambda term: isinstance(term, List),
    "number": lambda term: isinstance(term, int | float),
    "string": lambda term: isinstance(term, String),
    "ground": is_ground,
}


def _register_kind(name: str, holds: Callable[[Term], bool]) -> None:
    internal_action(name, 1)(lambda mind, term: holds(deref(term)))


for _name, _holds in KINDS.items():
    _register_kind(_name, _holds)


@internal_action("copy_term", 2)
def copy_term(mind: HasLogic, term: Term, copy: Term) -> Answer:
    return _unify(mind, copy, renamed(term, {}))


# ---- collections ---------------------------------------------------------------------------------------------------


def _register_collection(name: str, make: Callable[[], Any]) -> None:
    internal_action(f"{name}.create", 1, 2)(
        lambda mind, target, items=None: _unify(mind, target, _filled(make(), items))
    )


def _filled(value: Any, items: Term | None) -> Handle:
    for item in items if isinstance(items, List) else ():
        _put(value, item)
    return Handle(value)


def _put(value: Any, item: Term) -> None:
    if isinstance(value, dict):
        value[item] = None
    else:
        value.append(item)


for _name, _make in {"queue": deque, "set": dict, "map": dict}.items():
    _register_collection(_name, _make)


def _inside(term: Term, kind: type, name: str) -> Any:
    if isinstance(term, Handle) and isinstance(term.value, kind):
        return term.value
    raise wrong_arguments(name, f"a {name.split('.', maxsplit=1)[0]}", term)


@internal_action("queue.add", 2)
def queue_add(mind: HasLogic, queue: Term, item: Term) -> Answer:
    _inside(queue, deque, "queue.add").append(item)
    return True


@internal_action("queue.add_all", 2)
def queue_add_all(mind: HasLogic, queue: Term, items: Term) -> Answer:
    _inside(queue, deque, "queue.add_all").extend(items_of(items, "queue.add_all"))
    return True


@internal_action("queue.head", 2)
def queue_head(mind: HasLogic, queue: Term, item: Term) -> Answer:
    items = _inside(queue, deque, "queue.head")
    return bool(items) and _unify(mind, item, items[0])


@internal_action("queue.remove", 2)
def queue_remove(mind: HasLogic, queue: Term, item: Term) -> Answer:
    items = _inside(queue, deque, "queue.remove")
    return bool(items) and _unify(mind, item, items.popleft())


@internal_action("queue.clear", 1)
def queue_clear(mind: HasLogic, queue: Term) -> Answer:
    _inside(queue, deque, "queue.clear").clear()
    return True


@internal_action("set.add", 2)
def set_add(mind: HasLogic, target: Term, item: Term) -> Answer:
    _inside(target, dict, "set.add")[item] = None
    return True


@internal_action("set.remove", 2)
def set_remove(mind: HasLogic, target: Term, item: Term) -> Answer:
    _inside(target, dict, "set.remove").pop(item, None)
    return True


@internal_action("set.to_list", 2)
def set_to_list(mind: HasLogic, target: Term, result: Term) -> Answer:
    return _unify(mind, result, List(sorted(_inside(target, dict, "set.to_list"), key=in_order)))


@internal_action("map.put", 3)
def map_put(mind: HasLogic, target: Term, key: Term, value: Term) -> Answer:
    _inside(target, dict, "map.put")[key] = value
    return True


@internal_action("map.get", 3, 4)
def map_get(mind: HasLogic, target: Term, key: Term, value: Term, default: Term | None = None) -> Answer:
    found = _inside(target, dict, "map.get").get(key, default)
    return found is not None and _unify(mind, value, found)


@internal_action("map.remove", 2, 3)
def map_remove(mind: HasLogic, target: Term, key: Term, value: Term | None = None) -> Answer:
    found = _inside(target, dict, "map.remove").pop(key, None)
    return found is not None and (value is None or _unify(mind, value, found))


@internal_action("map.key", 2)
def map_key(mind: HasLogic, target: Term, key: Term) -> Answer:
    return _each(mind, (((key, each),) for each in list(_inside(target, dict, "map.key"))))


# ---- functions -----------------------------------------------------------------------------------------------------


def _half_up(value: float) -> float:
    return math.floor(value + 0.5)


def _numbers(name: str, args: tuple[Any, ...]) -> list[float]:
    items = args[0] if len(args) == 1 and isinstance(args[0], List) else args
    if not all(type(item) in (int, float) for item in items):
        raise TypeError(f"{name} takes numbers")
    return list(items)


NUMERIC: dict[str, tuple[Callable[..., float], int]] = {
    "abs": (abs, 1),
    "acos": (math.acos, 1),
    "asin": (math.asin, 1),
    "atan": (math.atan, 1),
    "ceil": (math.ceil, 1),
    "cos": (math.cos, 1),
    "floor": (math.floor, 1),
    "log": (math.log, 1),
    "round": (_half_up, 1),
    "sin": (math.sin, 1),
    "sqrt": (math.sqrt, 1),
    "tan": (math.tan, 1),
}
OF_MANY: dict[str, Callable[[list[float]], float]] = {
    "average": statistics.fmean,
    "mean": statistics.fmean,
    "max": max,
    "median": statistics.median,
    "min": min,
    "std_dev": statistics.pstdev,
    "sum": sum,
}


def _register_numeric(name: str, call: Callable[..., float], count: int) -> None:
    function(f"math.{name}", count)(lambda *args: number(call(*_numbers(name, args))))


def _register_of_many(name: str, call: Callable[[list[float]], float]) -> None:
    function(f"math.{name}", 1, None)(lambda *args: number(call(_numbers(name, args))))


for _name, (_call, _count) in NUMERIC.items():
    _register_numeric(_name, _call, _count)
for _name, _of in OF_MANY.items():
    _register_of_many(_name, _of)
