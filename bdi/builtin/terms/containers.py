"""Containers that a variable can hold and a program changes in place: maps, sets, queues."""

from bisect import insort
from collections import deque
from collections.abc import Iterable, Iterator
from typing import Any

from bdi.builtin.kinds import Kind
from bdi.language.terms import Handle, Term, Var
from bdi.language.unify import in_order


class OrderedSet(set[Term]):
    """Each term once; gone through in the standard order."""

    def __iter__(self) -> Iterator[Term]:
        return iter(sorted(super().__iter__(), key=in_order))


class OrderedMap(dict[Term, Term]):
    """Gone through in the standard order of its keys."""

    def __iter__(self) -> Iterator[Term]:
        return iter(sorted(super().__iter__(), key=in_order))

    def items(self) -> Any:
        return [(key, self[key]) for key in self]

    def values(self) -> Any:
        return [self[key] for key in self]


class PriorityQueue(deque[Term]):
    """The smallest in the standard order comes first; equal ones as they came."""

    def append(self, item: Term) -> None:
        insort(self, item, key=in_order)

    def extend(self, items: Iterable[Term]) -> None:
        for item in items:
            self.append(item)


def or_variable(kind: Kind) -> Kind:
    """A free variable becomes a new one."""
    return Kind(kind.name, lambda value: type(value) is Var or (kind.holds is not None and kind.holds(value)))


def holding(name: str, kind: type) -> Kind:
    """An argument that is a map, a set or a queue."""
    return Kind(name, lambda value: type(value) is Handle and isinstance(value.value, kind))


MAP = holding("a map", OrderedMap)
SET = holding("a set", OrderedSet)
QUEUE = holding("a queue", deque)
