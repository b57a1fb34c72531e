"""Why a goal is not reached yet: read off the intentions, said in words."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from bdi.intentions import Event, Intention, Means, State
from bdi.syntax import Trigger
from bdi.terms import Literal, show
from bdi.unify import unify


@dataclass(frozen=True, slots=True)
class Why:
    """`sentence` is for people; the rest says the same as data. `waits_for` is an action, event or moment as text."""

    goal: str
    sentence: str
    state: str
    intention: int | None = None
    plan: str | None = None
    step: str | None = None
    waits_for: str | None = None
    because: tuple[str, ...] = ()

    def __str__(self) -> str:
        return self.sentence


def explain(intentions: Iterable[Intention], events: Iterable[Event], goal: Literal) -> Why:
    """The first intention for this goal, else the event that waits for a plan."""
    for intention in intentions:
        for height, means in enumerate(intention.stack):
            if _is_about(means.event, goal):
                return _about_intention(intention, height, means.event.plain)
    for event in events:
        if _is_about(event, goal):
            text = event.plain
            return Why(text, f"{text} waits for its turn: no plan has been chosen yet.", State.EVENT.value)
    text = show(goal)
    return Why(text, f"{text} is not pursued: it was never asked for, is reached, or was given up.", "unknown")


def _is_about(event: Event, goal: Literal) -> bool:
    return event.trigger in (Trigger.GOAL_ADDED, Trigger.GOAL_FAILED) and unify(goal, event.literal, [])


def _about_intention(intention: Intention, height: int, goal: str) -> Why:
    top = intention.stack[-1]
    because = tuple(str(means.event) for means in reversed(intention.stack[height:]))
    waits_for = _awaited(intention)
    reason = _reason(intention, top, waits_for)
    chain = "".join(f", needed for {means.event.plain}" for means in _goals_between(intention, height))
    return Why(
        goal,
        f"{goal} {reason}{chain}.",
        State.SUSPENDED.value if intention.held else intention.state.value,
        intention.number,
        top.plan.label,
        str(top.step.source) if top.step is not None else None,
        waits_for,
        because,
    )


def _goals_between(intention: Intention, height: int) -> list[Means]:
    """The goals from the top down to, and without, the one that was asked about."""
    between = reversed(intention.stack[height + 1 :])
    return [means for means in between if means.event.trigger is Trigger.GOAL_ADDED]


def _awaited(intention: Intention) -> str | None:
    waits_for: Any = intention.waits_for
    if intention.state is State.TIME and isinstance(waits_for, float):
        return f"the moment {waits_for:.3f}"
    return None if waits_for is None else str(getattr(waits_for, "what", waits_for))


def _reason(intention: Intention, top: Means, waits_for: str | None) -> str:
    if intention.held:
        return f"is suspended in plan {top.plan.label}"
    if intention.state is State.ACTION:
        return f"waits for action {waits_for} of plan {top.plan.label}"
    if intention.state in (State.TIME, State.ANSWER):
        return f"waits for {waits_for} in plan {top.plan.label}"
    if intention.state is State.EVENT:
        return f"waits until a plan is chosen for a sub-goal of plan {top.plan.label}"
    return f"is being worked on by plan {top.plan.label}"
