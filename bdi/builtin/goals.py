"""Intentions and goals: `.drop_intention`, `.intend`, `.suspend`, `.succeed_goal`, …"""

from collections.abc import Callable, Iterator

from bdi.builtin.arguments import running_intention
from bdi.builtin.table import Answer, internal_action
from bdi.intentions import Intention, Means
from bdi.mind import Mind
from bdi.syntax import Trigger
from bdi.terms import List, Literal, String, Term, atom, structure
from bdi.unify import undo, unify


def _unifies(mind: Mind, pattern: Term, literal: Literal) -> bool:
    mark = len(mind.logic.trail)
    found = unify(pattern, literal, mind.logic.trail)
    undo(mind.logic.trail, mark)
    return found


def _pursues(mind: Mind, goal: Term) -> Callable[[Means], bool]:
    """Whether means are for this goal."""
    return lambda means: (
        means.event.trigger in (Trigger.GOAL_ADDED, Trigger.GOAL_FAILED) and _unifies(mind, goal, means.event.literal)
    )


def _intentions_for(mind: Mind, goal: Term) -> list[Intention]:
    pursues = _pursues(mind, goal)
    return [each for each in list(mind.intentions.values()) if any(map(pursues, each.stack))]


def _drop_desire(mind: Mind, goal: Term) -> None:
    """Events `+!goal` that no intention waits for, and the intentions that wait for one."""
    for event in list(mind.events):
        if event.trigger is Trigger.GOAL_ADDED and event in mind.events and _unifies(mind, goal, event.literal):
            mind.events.remove(event)
            if event.intention is not None:
                mind.drop(event.intention)


@internal_action("drop_all_intentions", 0)
def drop_all_intentions(mind: Mind) -> Answer:
    """All but the one that says so; events of the world stay."""
    for intention in list(mind.intentions.values()):
        if intention is not mind.current:
            mind.drop(intention)
    return True


@internal_action("drop_all_desires", 0)
def drop_all_desires(mind: Mind) -> Answer:
    drop_all_intentions(mind)
    return drop_all_events(mind)


@internal_action("drop_all_events", 0)
def drop_all_events(mind: Mind) -> Answer:
    for intention in [event.intention for event in mind.events if event.intention is not None]:
        if intention is not mind.current:
            mind.drop(intention)
    mind.events.clear()
    return True


@internal_action("drop_intention", 0, 1)
def drop_intention(mind: Mind, goal: Term | None = None) -> Answer:
    for intention in [running_intention(mind, "drop_intention")] if goal is None else _intentions_for(mind, goal):
        mind.drop(intention)
    return True


@internal_action("drop_desire", 1)
def drop_desire(mind: Mind, goal: Term) -> Answer:
    _drop_desire(mind, goal)
    return drop_intention(mind, goal)


@internal_action("drop_event", 1)
def drop_event(mind: Mind, goal: Term) -> Answer:
    _drop_desire(mind, goal)
    return True


@internal_action("intend", 1)
def intend(mind: Mind, goal: Term) -> Answer:
    return _goals_that_unify(mind, goal, _intended(mind))


@internal_action("desire", 1)
def desire(mind: Mind, goal: Term) -> Answer:
    waiting = [event.literal for event in mind.events if event.trigger is Trigger.GOAL_ADDED]
    return _goals_that_unify(mind, goal, waiting + _intended(mind))


def _intended(mind: Mind) -> list[Literal]:
    return [
        means.event.literal
        for intention in mind.intentions.values()
        for means in intention.stack
        if means.event.trigger is Trigger.GOAL_ADDED
    ]


def _goals_that_unify(mind: Mind, goal: Term, goals: list[Literal]) -> Iterator[bool]:
    for literal in goals:
        mark = len(mind.logic.trail)
        if unify(goal, literal, mind.logic.trail):
            yield True
        undo(mind.logic.trail, mark)


@internal_action("suspend", 0, 1)
def suspend(mind: Mind, goal: Term | None = None) -> Answer:
    for intention in [running_intention(mind, "suspend")] if goal is None else _intentions_for(mind, goal):
        mind.hold(intention)
    return True


@internal_action("resume", 1)
def resume(mind: Mind, goal: Term) -> Answer:
    for intention in _intentions_for(mind, goal):
        mind.release(intention)
    return True


@internal_action("suspended", 2)
def suspended(mind: Mind, goal: Term, reason: Term) -> Answer:
    held = [intention for intention in _intentions_for(mind, goal) if intention.held]
    return bool(held) and unify(reason, String("suspended"), mind.logic.trail)


@internal_action("current_intention", 1)
def current_intention(mind: Mind, result: Term) -> Answer:
    intention = mind.current
    if intention is None:
        return False
    plans = List([_described(means) for means in reversed(intention.stack)])
    return unify(result, structure("intention", intention.number, plans), mind.logic.trail)


def _described(means: Means) -> Term:
    return structure("im", atom(means.plan.label), String(str(means.event)))


@internal_action("succeed_goal", 1)
def succeed_goal(mind: Mind, goal: Term) -> Answer:
    for intention in _intentions_for(mind, goal):
        mind.reach_goal(intention, _pursues(mind, goal))
    return True


@internal_action("done", 1)
def done(mind: Mind, goal: Term) -> Answer:
    return succeed_goal(mind, goal)


@internal_action("fail_goal", 1, None)
def fail_goal(mind: Mind, goal: Term, *annots: Term) -> Answer:
    for intention in _intentions_for(mind, goal):
        mind.give_up_goal(intention, _pursues(mind, goal), annots)
    return True
