"""Lists: `.member`, `.length`, `.sort`, …"""

from bdi.builtin.arguments import alternatives, bind, in_order, items_of, text_of, unique
from bdi.builtin.table import Answer, function, internal_action, wrong_arguments
from bdi.logic import HasLogic
from bdi.terms import Handle, List, String, Term, Var
from bdi.unify import undo


@internal_action("member", 2)
def member(mind: HasLogic, item: Term, items: Term) -> Answer:
    return alternatives(mind, (((item, each),) for each in items_of(items, "member")))


@internal_action("length", 2)
def length(mind: HasLogic, value: Term, count: Term) -> Answer:
    return bind(mind, count, length_of(value))


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
        return bind(mind, item, found[place])
    return alternatives(mind, (((place, at), (item, each)) for at, each in enumerate(found)))


@internal_action("concat", 3, None)
def concat(mind: HasLogic, *args: Term) -> Answer:
    *parts, result = args
    if all(isinstance(part, List) for part in parts):
        return bind(mind, result, List([item for part in parts for item in items_of(part, "concat")]))
    if len(parts) == 2 and isinstance(result, List) and any(isinstance(part, Var) for part in parts):
        splits = ((List(result[:at]), List(result[at:])) for at in range(len(result) + 1))
        return alternatives(mind, (((parts[0], left), (parts[1], right)) for left, right in splits))
    return bind(mind, result, String("".join(map(text_of, parts))))


@internal_action("delete", 3)
def delete(mind: HasLogic, item: Term, value: Term, result: Term) -> Answer:
    """A number deletes by index, a term deletes all its equals, from lists and strings."""
    if isinstance(value, String):
        text = str.__str__(value)
        cut = text[:item] + text[item + 1 :] if isinstance(item, int) else text.replace(text_of(item), "")
        return bind(mind, result, String(cut))
    items = items_of(value, "delete")
    if isinstance(item, int):
        return bind(mind, result, List(items[:item] + items[item + 1 :]))
    return bind(mind, result, List([each for each in items if not _unifiable(mind, item, each)]))


def _unifiable(mind: HasLogic, left: Term, right: Term) -> bool:
    mark = len(mind.logic.trail)
    found = bind(mind, left, right)
    undo(mind.logic.trail, mark)
    return found


@internal_action("reverse", 2)
def reverse(mind: HasLogic, value: Term, result: Term) -> Answer:
    if isinstance(value, String):
        return bind(mind, result, String(str.__str__(value)[::-1]))
    return bind(mind, result, List(items_of(value, "reverse")[::-1]))


@internal_action("sort", 2)
def sort(mind: HasLogic, items: Term, result: Term) -> Answer:
    return bind(mind, result, List(sorted(items_of(items, "sort"), key=in_order)))


@internal_action("max", 2)
def largest(mind: HasLogic, items: Term, result: Term) -> Answer:
    found = items_of(items, "max")
    return bool(found) and bind(mind, result, max(found, key=in_order))


@internal_action("min", 2)
def smallest(mind: HasLogic, items: Term, result: Term) -> Answer:
    found = items_of(items, "min")
    return bool(found) and bind(mind, result, min(found, key=in_order))


@internal_action("union", 3)
def union(mind: HasLogic, left: Term, right: Term, result: Term) -> Answer:
    return bind(mind, result, unique(items_of(left, "union") + items_of(right, "union")))


@internal_action("intersection", 3)
def intersection(mind: HasLogic, left: Term, right: Term, result: Term) -> Answer:
    others = items_of(right, "intersection")
    return bind(mind, result, unique(item for item in items_of(left, "intersection") if item in others))


@internal_action("difference", 3)
def difference(mind: HasLogic, left: Term, right: Term, result: Term) -> Answer:
    others = items_of(right, "difference")
    return bind(mind, result, unique(item for item in items_of(left, "difference") if item not in others))


@internal_action("sublist", 2)
def sublist(mind: HasLogic, part: Term, items: Term) -> Answer:
    found = items_of(items, "sublist")
    spans = ((a, b) for a in range(len(found)) for b in range(len(found), a, -1))
    return alternatives(mind, (((part, List(found[a:b])),) for a, b in spans))


@internal_action("prefix", 2)
def prefix(mind: HasLogic, part: Term, items: Term) -> Answer:
    found = items_of(items, "prefix")
    return alternatives(mind, (((part, List(found[:end])),) for end in range(len(found), -1, -1)))


@internal_action("suffix", 2)
def suffix(mind: HasLogic, part: Term, items: Term) -> Answer:
    found = items_of(items, "suffix")
    return alternatives(mind, (((part, List(found[start:])),) for start in range(len(found) + 1)))


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
    return alternatives(mind, (((value, each),) for each in steps))
