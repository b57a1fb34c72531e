"""Events that a program makes: `.signal` now, `.at` later; `.perceive`."""

import re

from bdi.builtin.code import event_in
from bdi.builtin.kinds import ATOM, EVENT, STRING, optional
from bdi.builtin.table import Answer, internal_action, wrong_arguments
from bdi.language.syntax import GOAL_ADDED, Trigger
from bdi.language.terms import Literal, String, Structure, Term, atom, literal_of
from bdi.language.unify import renamed
from bdi.model.beliefs import SELF, SOURCE
from bdi.model.intentions import Intention
from bdi.model.mind import Mind
from bdi.model.waiting import HasTime, Waiter


@internal_action("signal", EVENT, optional(ATOM))
def signal(mind: Mind, event: Term, how: Term | None = None) -> Answer:
    """.signal({+b(X)}): the event without the belief. `type_signal` as the second makes it b(X)[signal]."""
    trigger, literal = _event(event, "signal")
    more = (atom("signal"),) if how is atom("type_signal") else ()
    _happen(mind, trigger, literal_of(literal.predicate, literal.args, (*literal.annots, *more)))
    return True


@internal_action("perceive")
def perceive(mind: Mind) -> Answer:
    """Do nothing: the percepts of the body are taken in at the beginning of every cycle."""
    return True


def _event(term: Term, name: str) -> tuple[Trigger, Literal]:
    wanted = event_in(term)
    if wanted is None:
        raise wrong_arguments(name, "an event, as {+!g(X)}", term)
    return wanted[0], renamed(wanted[1], {})  # type: ignore[return-value]


def _happen(mind: Mind, trigger: Trigger, literal: Literal) -> None:
    if not any(isinstance(annot, Structure) and annot.predicate is SOURCE for annot in literal.annots):
        literal = literal_of(literal.predicate, literal.args, (*literal.annots, SELF))
    if trigger is GOAL_ADDED:
        mind.actions.achieve_apart(literal)
    else:
        mind.event_queue.notice(trigger, literal)


# ---- later ---------------------------------------------------------------------------------------------------------

_WHEN = re.compile(r"now\s*\+\s*(\d+)(?:\s+(\w+))?\s*")
_UNITS_S = {"s": 1, "m": 60, "h": 3600, "d": 86400, "second": 1, "minute": 60, "hour": 3600, "day": 86400}


@internal_action("at", STRING, EVENT)
def at(mind: Mind, when: String, event: Term) -> Answer:
    """.at("now +3 s", {+!g}): the event happens then. Units are s, m, h, d or their names, milliseconds without one."""
    alarm = Alarm(mind, mind.now + _seconds_in(when), *_event(event, "at"))
    later = [
        place for place, each in enumerate(mind.waiters) if isinstance(each, Alarm) and each.moment_s > alarm.moment_s
    ]
    mind.watches_clock = True
    mind.waiters.insert(later[0] if later else len(mind.waiters), alarm)
    return True


class Alarm(Waiter):
    """An event that happens at a moment. No intention waits for it."""

    def __init__(self, mind: Mind, moment_s: float, trigger: Trigger, literal: Literal) -> None:
        super().__init__(Intention(0), f"{trigger}{literal}", moment_s, lambda mind: False)
        self.mind, self.moment_s = mind, moment_s
        self.trigger, self.literal = trigger, literal

    def check(self, mind: HasTime) -> None:
        if mind.now < self.moment_s:
            return
        self.mind.waiters.remove(self)
        _happen(self.mind, self.trigger, self.literal)


def _seconds_in(when: String) -> float:
    found = _WHEN.fullmatch(str.__str__(when).strip())
    unit = (found[2] or "").removesuffix("s") or found[2] if found else None
    if found is None or (unit and unit not in _UNITS_S):
        raise wrong_arguments("at", 'a moment such as "now +3 seconds"', when)
    return int(found[1]) * (_UNITS_S[unit] if unit else 0.001)
