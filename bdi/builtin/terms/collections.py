"""Queues, sets and maps. They are changed in place; a variable holds the thing itself."""

from collections import deque
from typing import Any

from bdi.builtin.arguments import alternatives, bind, items_of
from bdi.builtin.kinds import ANY, ITEMS, OUT, VARIABLE, optional
from bdi.builtin.table import Answer, internal_action, wrong_arguments
from bdi.builtin.terms.containers import MAP, QUEUE, SET, OrderedMap, OrderedSet, PriorityQueue, or_variable
from bdi.language.terms import Handle, List, Term, Var, atom
from bdi.model.logic import HasLogic


def _made(mind: HasLogic, target: Term, kind: type) -> Any:
    """Return the container that the variable holds; a free variable holds a new one from here on."""
    if isinstance(target, Var):
        made = Handle(kind())
        bind(mind, target, made)
        return made.value
    return target.value if isinstance(target, Handle) else None


# ---- queues --------------------------------------------------------------------------------------------------------


@internal_action("queue.create", VARIABLE, optional(ANY))
def queue_create(mind: HasLogic, queue: Term, how: Term | None = None) -> Answer:
    """.queue.create(Q)   .queue.create(Q,priority)   .queue.create(Q,[a,b])"""
    if how is atom("priority"):
        return bind(mind, queue, Handle(PriorityQueue()))
    if how is not None and not isinstance(how, List):
        raise wrong_arguments("queue.create", "the word priority, or a list", how)
    return bind(mind, queue, Handle(deque(how or ())))


@internal_action("queue.add", QUEUE, ANY)
def queue_add(mind: HasLogic, queue: Any, item: Term) -> Answer:
    queue.value.append(item)
    return True


@internal_action("queue.add_all", QUEUE, ITEMS)
def queue_add_all(mind: HasLogic, queue: Any, items: Term) -> Answer:
    queue.value.extend(items_of(items, "queue.add_all"))
    return True


@internal_action("queue.head", QUEUE, OUT)
def queue_head(mind: HasLogic, queue: Any, item: Term) -> Answer:
    return bool(queue.value) and bind(mind, item, queue.value[0])


@internal_action("queue.remove", QUEUE, OUT)
def queue_remove(mind: HasLogic, queue: Any, item: Term) -> Answer:
    return bool(queue.value) and bind(mind, item, queue.value.popleft())


@internal_action("queue.clear", QUEUE)
def queue_clear(mind: HasLogic, queue: Any) -> Answer:
    queue.value.clear()
    return True


@internal_action("queue.copy", QUEUE, OUT)
def queue_copy(mind: HasLogic, queue: Any, copy: Term) -> Answer:
    return bind(mind, copy, Handle(type(queue.value)(queue.value)))


@internal_action("queue.to_list", QUEUE, OUT)
def queue_to_list(mind: HasLogic, queue: Any, result: Term) -> Answer:
    return bind(mind, result, List(queue.value))


# ---- sets ----------------------------------------------------------------------------------------------------------


@internal_action("set.create", VARIABLE, optional(ITEMS))
def set_create(mind: HasLogic, target: Term, items: Term | None = None) -> Answer:
    return bind(mind, target, Handle(OrderedSet(() if items is None else items_of(items, "set.create"))))


@internal_action("set.add", or_variable(SET), ANY)
def set_add(mind: HasLogic, target: Term, item: Term) -> Answer:
    _made(mind, target, OrderedSet).add(item)
    return True


@internal_action("set.add_all", or_variable(SET), ITEMS)
def set_add_all(mind: HasLogic, target: Term, items: Term) -> Answer:
    _made(mind, target, OrderedSet).update(items_of(items, "set.add_all"))
    return True


@internal_action("set.remove", SET, ANY)
def set_remove(mind: HasLogic, target: Any, item: Term) -> Answer:
    target.value.discard(item)
    return True


@internal_action("set.union", or_variable(SET), ITEMS)
def set_union(mind: HasLogic, target: Term, items: Term) -> Answer:
    return set_add_all(mind, target, items)


@internal_action("set.difference", SET, ITEMS)
def set_difference(mind: HasLogic, target: Any, items: Term) -> Answer:
    target.value.difference_update(items_of(items, "set.difference"))
    return True


@internal_action("set.intersection", SET, ITEMS)
def set_intersection(mind: HasLogic, target: Any, items: Term) -> Answer:
    target.value.intersection_update(items_of(items, "set.intersection"))
    return True


@internal_action("set.clear", SET)
def set_clear(mind: HasLogic, target: Any) -> Answer:
    target.value.clear()
    return True


@internal_action("set.copy", SET, OUT)
def set_copy(mind: HasLogic, target: Any, copy: Term) -> Answer:
    return bind(mind, copy, Handle(OrderedSet(target.value)))


@internal_action("set.to_list", SET, OUT)
def set_to_list(mind: HasLogic, target: Any, result: Term) -> Answer:
    return bind(mind, result, List(target.value))


# ---- maps ----------------------------------------------------------------------------------------------------------


@internal_action("map.create", VARIABLE)
def map_create(mind: HasLogic, target: Term) -> Answer:
    return bind(mind, target, Handle(OrderedMap()))


@internal_action("map.put", or_variable(MAP), ANY, ANY)
def map_put(mind: HasLogic, target: Term, key: Term, value: Term) -> Answer:
    _made(mind, target, OrderedMap)[key] = value
    return True


@internal_action("map.get", MAP, OUT, OUT, optional(ANY))
def map_get(mind: HasLogic, target: Any, key: Term, value: Term, default: Term | None = None) -> Answer:
    """A free key: every pair in turn."""
    if isinstance(key, Var):
        return alternatives(mind, (((key, each), (value, found)) for each, found in list(target.value.items())))
    found = target.value.get(key, default)
    return found is not None and bind(mind, value, found)


@internal_action("map.remove", MAP, ANY, optional(OUT))
def map_remove(mind: HasLogic, target: Any, key: Term, value: Term | None = None) -> Answer:
    found = target.value.pop(key, None)
    return found is not None and (value is None or bind(mind, value, found))


@internal_action("map.key", MAP, OUT)
def map_key(mind: HasLogic, target: Any, key: Term) -> Answer:
    return alternatives(mind, (((key, each),) for each in list(target.value)))


@internal_action("map.value", MAP, OUT)
def map_value(mind: HasLogic, target: Any, value: Term) -> Answer:
    return alternatives(mind, (((value, each),) for each in list(target.value.values())))


@internal_action("map.clear", MAP)
def map_clear(mind: HasLogic, target: Any) -> Answer:
    target.value.clear()
    return True


@internal_action("map.copy", MAP, OUT)
def map_copy(mind: HasLogic, target: Any, copy: Term) -> Answer:
    return bind(mind, copy, Handle(OrderedMap(target.value)))
