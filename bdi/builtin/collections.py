"""Queues, sets and maps. They are changed in place; a variable holds the thing itself."""

from collections import deque
from collections.abc import Callable
from typing import Any

from bdi.builtin.arguments import alternatives, bind, in_order, items_of
from bdi.builtin.table import Answer, internal_action, wrong_arguments
from bdi.logic import HasLogic
from bdi.terms import Handle, List, Term


def _register_collection(name: str, make: Callable[[], Any]) -> None:
    internal_action(f"{name}.create", 1, 2)(lambda mind, target, items=None: bind(mind, target, _filled(make(), items)))


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
    return bool(items) and bind(mind, item, items[0])


@internal_action("queue.remove", 2)
def queue_remove(mind: HasLogic, queue: Term, item: Term) -> Answer:
    items = _inside(queue, deque, "queue.remove")
    return bool(items) and bind(mind, item, items.popleft())


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
    return bind(mind, result, List(sorted(_inside(target, dict, "set.to_list"), key=in_order)))


@internal_action("map.put", 3)
def map_put(mind: HasLogic, target: Term, key: Term, value: Term) -> Answer:
    _inside(target, dict, "map.put")[key] = value
    return True


@internal_action("map.get", 3, 4)
def map_get(mind: HasLogic, target: Term, key: Term, value: Term, default: Term | None = None) -> Answer:
    found = _inside(target, dict, "map.get").get(key, default)
    return found is not None and bind(mind, value, found)


@internal_action("map.remove", 2, 3)
def map_remove(mind: HasLogic, target: Term, key: Term, value: Term | None = None) -> Answer:
    found = _inside(target, dict, "map.remove").pop(key, None)
    return found is not None and (value is None or bind(mind, value, found))


@internal_action("map.key", 2)
def map_key(mind: HasLogic, target: Term, key: Term) -> Answer:
    return alternatives(mind, (((key, each),) for each in list(_inside(target, dict, "map.key"))))
