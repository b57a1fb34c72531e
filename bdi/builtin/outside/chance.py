"""Chance, from the agent's own seed: `.random`, `.shuffle`, `.set_random_seed`."""

from collections.abc import Callable, Iterator

from bdi.builtin.arguments import items_of
from bdi.builtin.kinds import ANY, ITEMS, OUT, WHOLE, optional
from bdi.builtin.table import Answer, internal_action, wrong_arguments
from bdi.language.terms import List, Term, Var, show
from bdi.language.unify import undo, unify
from bdi.model.mind import Mind

MOST = 10_000  # answers of a question that has no end


@internal_action("random", ANY, optional(ANY), optional(WHOLE))
def random(mind: Mind, first: Term, second: Term = 1, times: Term = 1) -> Answer:
    """.random(X) from 0 to 1   .random(X,TIMES)   .random(LIST,X) one of them   .random(LIST,X,TIMES)

    Gives so many answers, one after the other; MOST if TIMES is 0.
    """
    if isinstance(first, Var | int | float):
        return _drawn(mind, first, mind.random.random, _times(second))
    items = items_of(first, "random")
    return bool(items) and _drawn(mind, second, lambda: mind.random.choice(items), _times(times))


def _times(value: Term) -> int:
    if not isinstance(value, int) or value < 0:
        raise wrong_arguments("random", "a number of answers", value)
    return value


def _drawn(mind: Mind, target: Term, draw: Callable[[], Term], times: int) -> Iterator[bool]:
    trail = mind.logic.trail
    for _ in range(times or MOST):
        mark = len(trail)
        if unify(target, draw(), trail):
            yield True
        undo(trail, mark)


@internal_action("set_random_seed", ANY)
def set_random_seed(mind: Mind, seed: Term) -> Answer:
    mind.random.seed(show(seed))
    return True


@internal_action("shuffle", ITEMS, OUT)
def shuffle(mind: Mind, items: Term, result: Term) -> Answer:
    mixed = list(items_of(items, "shuffle"))
    mind.random.shuffle(mixed)
    return unify(result, List(mixed), mind.logic.trail)
