"""Lists, and what strings, sets and queues have in common with them: `.member`, `.length`, `.sort`, …"""

import re
from typing import Any

from bdi.builtin.arguments import alternatives, bind, items_of, text_of, unifiable, unique
from bdi.builtin.kinds import ANY, COLLECTION, ITEMS, OUT, SEQUENCE, WHOLE, optional, rest
from bdi.builtin.table import Answer, function, internal_action, wrong_arguments
from bdi.language.terms import Handle, List, OpenList, String, Term, Var
from bdi.language.unify import in_order
from bdi.model.logic import HasLogic


@internal_action("member", OUT, ITEMS)
def member(mind: HasLogic, item: Term, items: Term) -> Answer:
    return alternatives(mind, (((item, each),) for each in items_of(items, "member")))


@internal_action("length", COLLECTION, OUT)
def length(mind: HasLogic, value: Term, count: Term) -> Answer:
    return bind(mind, count, length_of(value))


@function(".length", COLLECTION)
def length_of(value: Any) -> int:
    return len(value.value if isinstance(value, Handle) else value)


@internal_action("empty", COLLECTION)
def empty(mind: HasLogic, value: Term) -> Answer:
    return not length_of(value)


@internal_action("nth", OUT, COLLECTION, OUT)
def nth(mind: HasLogic, place: Term, value: Term, item: Term) -> Answer:
    """Places count from 0. A free place: every one in turn."""
    found = _parts(value)
    if isinstance(place, Var):
        return alternatives(mind, (((place, at), (item, each)) for at, each in enumerate(found)))
    if not isinstance(place, int) or not 0 <= place < len(found):
        raise wrong_arguments("nth", f"a place from 0 to {len(found) - 1}", place)
    return bind(mind, item, found[place])


def _parts(value: Term) -> tuple[Term, ...]:
    """Items; of a string its characters."""
    return tuple(map(String, value)) if isinstance(value, String) else items_of(value, "nth")


@internal_action("concat", ANY, ANY, OUT, rest(OUT))
def concat(mind: HasLogic, *args: Term) -> Answer:
    """Lists give a list, anything else a string. `.concat(X,Y,[a,b])` gives every way to cut the list in two."""
    *parts, result = args
    if len(parts) == 2 and isinstance(result, List) and any(isinstance(part, Var | OpenList) for part in parts):
        splits = ((List(result[:at]), List(result[at:])) for at in range(len(result) + 1))
        return alternatives(mind, (((parts[0], left), (parts[1], right)) for left, right in splits))
    if isinstance(parts[0], List):
        joined = [item for part in parts for item in _list(part)]
        return bind(mind, result, List(joined))
    return bind(mind, result, String("".join(map(text_of, parts))))


def _list(part: Term) -> List:
    if not isinstance(part, List):
        raise wrong_arguments("concat", "only lists after a list", part)
    return part


@internal_action("delete", ANY, ANY, ANY, optional(OUT))
def delete(mind: HasLogic, *args: Term) -> Answer:
    """.delete(ITEM,LIST,REST) every one that unifies; .delete(PLACE,LIST,REST); .delete(FROM,TO,LIST,REST)"""
    *which, value, result = args
    if not isinstance(which[0], int):
        return bind(mind, result, _without(mind, which[0], value))
    start = which[0]
    end = which[1] if len(which) > 1 else start + 1
    if not isinstance(end, int):
        raise wrong_arguments("delete", "a place to end at", end)
    if isinstance(value, String):
        text = str.__str__(value)
        inside = 0 <= start <= end <= len(text)
        return bind(mind, result, String(text[:start] + text[end:]) if inside else value)
    items = items_of(value, "delete")
    left = [item for place, item in enumerate(items) if not start <= place < end]
    return bind(mind, result, List(left))


def _without(mind: HasLogic, item: Term, value: Term) -> Term:
    """A string as the first is a regular expression, taken out of the other's text."""
    if isinstance(item, String):
        return String(pattern_of(item, "delete").sub("", text_of(value)))
    return List([each for each in items_of(value, "delete") if not unifiable(mind, item, each)])


def pattern_of(text: Term, name: str) -> "re.Pattern[str]":
    try:
        return re.compile(text_of(text))
    except re.error as problem:
        raise wrong_arguments(name, f"a regular expression ({problem})", text) from problem


@internal_action("reverse", SEQUENCE, OUT)
def reverse(mind: HasLogic, value: Term, result: Term) -> Answer:
    if isinstance(value, String):
        return bind(mind, result, String(str.__str__(value)[::-1]))
    return bind(mind, result, List(items_of(value, "reverse")[::-1]))


@internal_action("sort", ITEMS, OUT)
def sort(mind: HasLogic, items: Term, result: Term) -> Answer:
    """Sort in the standard order; equal items are kept."""
    return bind(mind, result, List(sorted(items_of(items, "sort"), key=in_order)))


@internal_action("max", ITEMS, OUT)
def largest(mind: HasLogic, items: Term, result: Term) -> Answer:
    found = items_of(items, "max")
    return bool(found) and bind(mind, result, max(found, key=in_order))


@internal_action("min", ITEMS, OUT)
def smallest(mind: HasLogic, items: Term, result: Term) -> Answer:
    found = items_of(items, "min")
    return bool(found) and bind(mind, result, min(found, key=in_order))


@internal_action("union", ITEMS, ITEMS, OUT)
def union(mind: HasLogic, left: Term, right: Term, result: Term) -> Answer:
    """Union as a list in standard order, each item once."""
    return bind(mind, result, unique(items_of(left, "union") + items_of(right, "union")))


@internal_action("intersection", ITEMS, ITEMS, OUT)
def intersection(mind: HasLogic, left: Term, right: Term, result: Term) -> Answer:
    others = items_of(right, "intersection")
    return bind(mind, result, unique(item for item in items_of(left, "intersection") if item in others))


@internal_action("difference", ITEMS, ITEMS, OUT)
def difference(mind: HasLogic, left: Term, right: Term, result: Term) -> Answer:
    others = items_of(right, "difference")
    return bind(mind, result, unique(item for item in items_of(left, "difference") if item not in others))


@internal_action("sublist", OUT, ITEMS)
def sublist(mind: HasLogic, part: Term, items: Term) -> Answer:
    """The prefixes of every suffix, the longest first; the empty list last."""
    found = items_of(items, "sublist")
    spans = [(a, b) for a in range(len(found)) for b in range(len(found), a, -1)]
    return alternatives(mind, (((part, List(found[a:b])),) for a, b in [*spans, (0, 0)]))


@internal_action("prefix", OUT, SEQUENCE)
def prefix(mind: HasLogic, part: Term, whole: Term) -> Answer:
    """The longest first."""
    ends = range(length_of(whole), -1, -1)
    return alternatives(mind, (((part, _cut(whole, 0, end)),) for end in ends))


@internal_action("suffix", OUT, SEQUENCE)
def suffix(mind: HasLogic, part: Term, whole: Term) -> Answer:
    """The longest first."""
    end = length_of(whole)
    return alternatives(mind, (((part, _cut(whole, start, end)),) for start in range(end + 1)))


def _cut(whole: Term, start: int, end: int) -> Term:
    if isinstance(whole, String):
        return String(str.__str__(whole)[start:end])
    return List(items_of(whole, "sublist")[start:end])


@internal_action("range", OUT, WHOLE, WHOLE, optional(WHOLE))
def span(mind: HasLogic, value: Term, start: int, end: int, by: int = 1) -> Answer:
    """Return the whole numbers from start to end, both included."""
    if not by:
        raise wrong_arguments("range", "a step that is not 0", by)
    steps = range(start, end + (1 if by > 0 else -1), by)
    if isinstance(value, int):
        return value in steps
    return alternatives(mind, (((value, each),) for each in steps))
