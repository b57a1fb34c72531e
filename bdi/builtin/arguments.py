"""Helpers for the arguments of internal actions."""

from collections.abc import Iterable, Iterator

from bdi.builtin.table import wrong_arguments
from bdi.language.terms import Handle, List, String, Term, show
from bdi.language.unify import in_order, undo, unify
from bdi.model.intentions import Intention, StepFailed
from bdi.model.logic import HasLogic
from bdi.model.mind import Mind


def bind(mind: HasLogic, left: Term, right: Term) -> bool:
    return unify(left, right, mind.logic.trail)


def alternatives(mind: HasLogic, alternatives: Iterable[tuple[tuple[Term, Term], ...]]) -> Iterator[bool]:
    """Yield once for every alternative whose pairs all unify."""
    trail = mind.logic.trail
    for pairs in alternatives:
        mark = len(trail)
        if all(unify(left, right, trail) for left, right in pairs):
            yield True
        undo(trail, mark)


def unifiable(mind: HasLogic, left: Term, right: Term) -> bool:
    """Return whether they would unify; nothing stays bound."""
    mark = len(mind.logic.trail)
    found = unify(left, right, mind.logic.trail)
    undo(mind.logic.trail, mark)
    return found


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


def running_intention(mind: Mind, name: str) -> Intention:
    """The intention whose step this is. In a condition there is none."""
    intention: Intention | None = mind.current
    if intention is None:
        raise StepFailed("wrong_arguments", f".{name} belongs in the body of a plan, not in a condition")
    return intention


def unique(items: Iterable[Term]) -> List:
    return List(sorted(dict.fromkeys(items), key=in_order))
