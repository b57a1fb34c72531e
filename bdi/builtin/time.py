"""Time and chance: `.wait`, `.time`, `.random`, …"""

from heapq import heappush

from bdi.builtin.arguments import event_in, items_of, running_intention
from bdi.builtin.table import Answer, internal_action
from bdi.intentions import State
from bdi.logic import Question
from bdi.mind import Mind
from bdi.terms import List, Term, show
from bdi.unify import unify
from bdi.waiting import event_waiter, formula_waiter, moment_of


@internal_action("wait", 1, 3, lazy=(0,))
def wait(mind: Mind, what: Question, timeout: Term | None = None, elapsed: Term | None = None) -> Answer:
    """.wait(MS)   .wait("+event", MS)   .wait(formula, MS): with a third argument a time-out is no failure."""
    condition = what.term()
    intention = running_intention(mind, "wait")
    if isinstance(condition, int | float):
        moment = mind.now + condition / 1000
        intention.waits_for = moment
        intention.state = State.TIME
        heappush(mind.timers, (moment, intention.number, intention))
        return True
    deadline_s = None if timeout is None else moment_of(mind.now, timeout)
    trigger = event_in(condition)
    if trigger is None and what.first():
        return True
    waiter = event_waiter(intention, *trigger, deadline_s) if trigger else formula_waiter(intention, what, deadline_s)
    waiter.quiet = elapsed is not None
    intention.state = State.TIME
    intention.waits_for = waiter
    mind.waiters.append(waiter)
    return True


@internal_action("time", 3)
def clock(mind: Mind, hours: Term, minutes: Term, seconds: Term) -> Answer:
    """Hours, minutes and seconds of the clock that the agent is given, which need not be the time of day."""
    whole = int(mind.now)
    parts = (whole // 3600, whole // 60 % 60, whole % 60)
    return all(unify(a, b, mind.logic.trail) for a, b in zip((hours, minutes, seconds), parts, strict=True))


@internal_action("random", 1, 2)
def random(mind: Mind, *args: Term) -> Answer:
    """.random(X): from 0 to 1. .random(LIST, X): one of them."""
    if len(args) == 1:
        return unify(args[0], mind.random.random(), mind.logic.trail)
    items = items_of(args[0], "random")
    return bool(items) and unify(args[1], mind.random.choice(items), mind.logic.trail)


@internal_action("set_random_seed", 1)
def set_random_seed(mind: Mind, seed: Term) -> Answer:
    mind.random.seed(show(seed))
    return True


@internal_action("shuffle", 2)
def shuffle(mind: Mind, items: Term, result: Term) -> Answer:
    mixed = list(items_of(items, "shuffle"))
    mind.random.shuffle(mixed)
    return unify(result, List(mixed), mind.logic.trail)
