"""Intentions and goals: `.drop_intention`, `.intend`, `.suspend`, `.succeed_goal`, …

Where a goal is asked for, it is a pattern: `.suspend(go(_))` is about every goal that unifies. A goal is pursued by the
intentions that have it somewhere in their stack, or is still an event.
"""

from collections.abc import Callable, Iterator

from bdi.builtin.agent_state.stacks import goals_ahead, intention_term, stack_of, state_of
from bdi.builtin.arguments import alternatives, running_intention, unifiable
from bdi.builtin.kinds import ANY, ATOM, GOAL, OUT, optional, rest
from bdi.builtin.table import Answer, internal_action
from bdi.language.syntax import Trigger
from bdi.language.terms import Term, atom
from bdi.language.unify import unify
from bdi.model.intentions import Event, Intention, Means, StepFailed
from bdi.model.mind import Mind
from bdi.model.waiting import reason_of


def _pursues(mind: Mind, goal: Term) -> Callable[[Means], bool]:
    """Return a test whether means are for this goal."""
    return lambda means: (
        means.event.trigger in (Trigger.GOAL_ADDED, Trigger.GOAL_FAILED) and unifiable(mind, goal, means.event.literal)
    )


def _intentions_for(mind: Mind, goal: Term) -> Iterator[Intention]:
    """Yield intentions that pursue the goal now, and still do when their turn comes."""
    pursues = _pursues(mind, goal)
    for each in list(mind.intentions.values()):
        if any(map(pursues, each.stack)):
            yield each


def _events_for(mind: Mind, goal: Term) -> Iterator[Event]:
    """Goals that no plan is chosen for yet."""
    for event in [*mind.events, *mind.suspended_events]:
        still = event in mind.events or event in mind.suspended_events
        if still and event.trigger is Trigger.GOAL_ADDED and unifiable(mind, goal, event.literal):
            yield event


# ---- dropping ------------------------------------------------------------------------------------------------------


@internal_action("drop_all_intentions")
def drop_all_intentions(mind: Mind) -> Answer:
    """Drop all intentions but the one that calls this, with its branches; events of the world stay."""
    mine = mind.current
    for intention in list(mind.intentions.values()):
        if mine is None or not intention.is_beside(mine):
            mind.intention_base.drop(intention)
    return True


@internal_action("drop_all_desires")
def drop_all_desires(mind: Mind) -> Answer:
    drop_all_events(mind)
    return drop_all_intentions(mind)


@internal_action("drop_all_events")
def drop_all_events(mind: Mind) -> Answer:
    """Drop all events, with the intentions that wait for one."""
    for event in [*mind.events, *mind.suspended_events]:
        if event in mind.events or event in mind.suspended_events:
            mind.intention_base.drop_event(event)
    return True


@internal_action("drop_intention", optional(GOAL))
def drop_intention(mind: Mind, goal: Term | None = None) -> Answer:
    for intention in [running_intention(mind, "drop_intention")] if goal is None else _intentions_for(mind, goal):
        mind.intention_base.drop(intention)
    return True


@internal_action("drop_desire", GOAL)
def drop_desire(mind: Mind, goal: Term) -> Answer:
    drop_event(mind, goal)
    return drop_intention(mind, goal)


@internal_action("drop_event", GOAL)
def drop_event(mind: Mind, goal: Term) -> Answer:
    """Drop an event, with the intention that waits for it."""
    for event in _events_for(mind, goal):
        mind.intention_base.drop_event(event)
    return True


@internal_action("drop_future_intention", GOAL)
def drop_future_intention(mind: Mind, goal: Term) -> Answer:
    """The intentions that have `!goal` or `!!goal` still before them, as far as their plans say so now."""
    for intention in list(mind.intentions.values()):
        ahead = (each for means in intention.stack for each in goals_ahead(means))
        if any(unifiable(mind, goal, each) for each in ahead):
            mind.intention_base.drop(intention)
    return True


# ---- asking --------------------------------------------------------------------------------------------------------


@internal_action("intend", GOAL, optional(OUT))
def intend(mind: Mind, goal: Term, intention: Term | None = None) -> Answer:
    """.intend(GOAL, intention(ID, STACK))"""
    return alternatives(mind, _intended(mind, goal, intention))


@internal_action("desire", GOAL, optional(OUT))
def desire(mind: Mind, goal: Term, intention: Term | None = None) -> Answer:
    """A goal that is still an event, or intended."""
    waiting = [
        ((goal, event.literal),)
        for event in (*mind.events, *mind.suspended_events)
        if event.trigger is Trigger.GOAL_ADDED and intention is None
    ]
    return alternatives(mind, [*waiting, *_intended(mind, goal, intention)])


def _intended(mind: Mind, goal: Term, wanted: Term | None) -> Iterator[tuple[tuple[Term, Term], ...]]:
    for intention in list(mind.intentions.values()):
        for means in intention.stack[:]:
            if means.event.trigger is Trigger.GOAL_ADDED:
                pair = (goal, means.event.literal)
                yield (pair,) if wanted is None else (pair, (wanted, intention_term(intention)))


@internal_action("current_intention", OUT)
def current_intention(mind: Mind, result: Term) -> Answer:
    """intention(ID, STACK)"""
    intention = _present(mind)
    return intention is not None and unify(result, intention_term(intention), mind.logic.trail)


def _present(mind: Mind) -> Intention | None:
    """Return the current intention; in a context that of the goal, if it has one already."""
    if mind.current is None and mind.considered is not None:
        return mind.considered.intention
    return mind.current


@internal_action("intention", OUT, OUT, optional(OUT), optional(ATOM))
def intention(mind: Mind, number: Term, state: Term, stack: Term | None = None, which: Term | None = None) -> Answer:
    """.intention(ID, STATE, STACK): running, waiting or suspended. `current` as fourth: only the one that asks."""
    if which is not None and which != atom("current"):
        raise StepFailed("wrong_arguments", ".intention takes current as fourth argument")
    found = [_present(mind)] if which is not None else list(mind.intentions.values())
    return alternatives(
        mind,
        (
            (
                (number, each.number),
                (state, state_of(each, mind.current)),
                *(() if stack is None else ((stack, stack_of(each)),)),
            )
            for each in found
            if each is not None
        ),
    )


# ---- suspending ----------------------------------------------------------------------------------------------------


@internal_action("suspend", optional(GOAL))
def suspend(mind: Mind, goal: Term | None = None) -> Answer:
    if goal is None:
        mind.suspension.suspend(running_intention(mind, "suspend"))
        return True
    for intention in _intentions_for(mind, goal):
        if not intention.suspended:
            mind.suspension.suspend(intention)
    for event in _events_for(mind, goal):
        if event not in mind.suspended_events:
            mind.suspension.suspend_goal(event)
    return True


@internal_action("resume", GOAL)
def resume(mind: Mind, goal: Term) -> Answer:
    """Resume what `.suspend` suspended; intentions that only wait go on waiting."""
    for intention in _intentions_for(mind, goal):
        mind.suspension.resume(intention)
    for event in _events_for(mind, goal):
        if event in mind.suspended_events:
            mind.suspension.resume_goal(event)
    return True


@internal_action("suspended", GOAL, OUT)
def suspended(mind: Mind, goal: Term, reason: Term) -> Answer:
    """action(A), wait(W)[time(MS)], ask: what it waits for; suspended: by `.suspend`."""
    return alternatives(mind, [((reason, each),) for each in _reasons(mind, goal)])


def _reasons(mind: Mind, goal: Term) -> Iterator[Term]:
    for intention in _intentions_for(mind, goal):
        awaited = reason_of(intention)
        if awaited is not None:
            yield awaited
        if intention.suspended:
            yield atom("suspended")
    for event in _events_for(mind, goal):
        if event in mind.suspended_events:
            yield atom("suspended")


# ---- ending --------------------------------------------------------------------------------------------------------


@internal_action("succeed_goal", GOAL)
def succeed_goal(mind: Mind, goal: Term) -> Answer:
    """Let a goal count as reached: the plans for it are dropped, and the plan that wanted it goes on."""
    for intention in _intentions_for(mind, goal):
        mind.recovery.reach_goal(intention, _pursues(mind, goal))
    for event in _events_for(mind, goal):
        mind.recovery.reach_event(event)
    return True


@internal_action("done", optional(GOAL))
def done(mind: Mind, goal: Term | None = None) -> Answer:
    """Without a goal: the plan that says so has done its work; in a sub-plan that reacts to the world, that around."""
    if goal is not None:
        return succeed_goal(mind, goal)
    stack = running_intention(mind, "done").stack
    own = (stack[0].event.around or stack)[-1].event
    for intention in list(mind.intentions.values()):
        mind.recovery.reach_goal(intention, lambda means: means.event is own)
    return True


@internal_action("fail_goal", GOAL, rest(ANY))
def fail_goal(mind: Mind, goal: Term, *annots: Term) -> Answer:
    """Let a goal count as failed: `-!goal[error(goal_failed), ANNOTS]` is searched for from it down the stack."""
    failure = StepFailed("goal_failed", "given up by .fail_goal", annots)
    events = list(_events_for(mind, goal))
    for intention in _intentions_for(mind, goal):
        mind.recovery.give_up_goal(intention, _pursues(mind, goal), failure)
    for event in events:
        if event in mind.events or event in mind.suspended_events:
            mind.recovery.give_up_waiting(event, failure)
    return True
