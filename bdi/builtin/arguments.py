"""What internal actions do with their arguments."""

from collections.abc import Iterable, Iterator
from functools import cmp_to_key

from bdi.builtin.table import wrong_arguments
from bdi.errors import AgentSpeakSyntaxError
from bdi.intentions import Intention, StepFailed
from bdi.logic import HasLogic
from bdi.mind import Mind
from bdi.parser import parse_event
from bdi.syntax import Trigger
from bdi.terms import Code, Handle, List, Literal, String, Term, show
from bdi.unify import compare, undo, unify

in_order = cmp_to_key(compare)


def bind(mind: HasLogic, left: Term, right: Term) -> bool:
    return unify(left, right, mind.logic.trail)


def alternatives(mind: HasLogic, alternatives: Iterable[tuple[tuple[Term, Term], ...]]) -> Iterator[bool]:
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


def running_intention(mind: Mind, name: str) -> Intention:
    """The intention whose step this is. In a condition there is none."""
    intention: Intention | None = mind.current
    if intention is None:
        raise StepFailed("wrong_arguments", f".{name} belongs in the body of a plan, not in a condition")
    return intention


def event_in(condition: Term) -> tuple[Trigger, Literal] | None:
    """ "+b(X)" or {+b(X)}; None for anything else."""
    if isinstance(condition, String):
        return event_named(condition)
    if isinstance(condition, Code) and len(condition.body.steps) == 1:
        return event_named(String(str(condition.body)))
    return None


def event_named(text: String) -> tuple[Trigger, Literal]:
    """ "+!g(X)" """
    try:
        return parse_event(str.__str__(text))
    except AgentSpeakSyntaxError as error:
        raise wrong_arguments("wait", "an event with a name", text) from error


def unique(items: Iterable[Term]) -> List:
    return List(sorted(dict.fromkeys(items), key=in_order))
