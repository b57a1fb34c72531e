"""Explanations why a goal is not reached yet, or was given up: read from the intentions, worded by a table."""

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from types import MappingProxyType
from typing import Any

from bdi.debug.trace import Deliberated, Observed
from bdi.language.errors import AgentSpeakError
from bdi.language.parser import parse_event
from bdi.language.syntax import Trigger
from bdi.language.terms import Literal, show
from bdi.language.unify import renamed, unify
from bdi.model.intentions import Event, Intention, Means, State

UNKNOWN = "unknown"  # a goal that is not pursued

# What people read, by kind; another table says the same in another language.
WORDS: Mapping[str, str] = MappingProxyType(
    {
        "action": "{goal} waits for action {what} of plan {plan}",
        "moment": "{goal} waits {left_s:.1f} s more in plan {plan}",
        "event": "{goal} waits for {what} in plan {plan}",
        "condition": "{goal} waits until {what} holds: plan {plan} has nothing left to do",
        "answer": "{goal} waits for {what} in plan {plan}",
        "until": ", {left_s:.1f} s more at most",
        "suspended": "{goal} is suspended in plan {plan}",
        "suspended by": "{goal} is suspended in plan {plan}, by plan {what}",
        "turn": "{goal} waits for its turn in plan {plan}: {what} is atomic and goes first",
        "sub-goal": "{goal} waits until a plan is chosen for {what} in plan {plan}",
        "running": "{goal} is being worked on by plan {plan}",
        "pending": "{goal} waits for its turn: no plan has been chosen yet",
        "pending behind": "{goal} waits for its turn: no plan has been chosen yet, {what} is atomic and goes first",
        "pending suspended": "{goal} is suspended: no plan is chosen until it is resumed",
        "given up": "{goal} was given up: {what}",
        UNKNOWN: "{goal} is not pursued: it was never asked for, is reached, or was given up",
        "needed for": ", needed for {goal}",
        "plan of intention": "plan {plan} of intention {number}",
        "chosen only": "plan {plan} is the only one for {event}",
        "chosen first": "plan {plan} is the first of {count} for {event} that applied",
        "chosen after": "plan {plan} was chosen for {event}, since of the earlier ones {others}",
        "not chosen": "{plan} did not apply ({why})",
    }
)
PURSUED = (Trigger.GOAL_ADDED, Trigger.GOAL_FAILED)
_LOOKED_BACK = {Trigger.GOAL_ADDED, Trigger.TEST_ADDED}


@dataclass(frozen=True, slots=True)
class Why:
    """`sentence` is for people; the rest says the same as data. `kind` and `values` are what a table of words needs;
    `waits_for` is an action, event or answer as text, `left_s` how long it waits at most. `because` are the goals from
    the top of the intention down, `chosen` says why this plan (known while the agent has a listener)."""

    goal: str
    kind: str
    state: str
    intention: int | None = None
    plan: str | None = None
    step: str | None = None
    waits_for: str | None = None
    left_s: float | None = None
    because: tuple[str, ...] = ()
    chosen: str | None = None
    needed_for: tuple[str, ...] = field(default=())

    @property
    def sentence(self) -> str:
        return self.in_words(WORDS)

    def in_words(self, words: Mapping[str, str]) -> str:
        """The sentence by another table, which has the keys of WORDS."""
        values = {"goal": self.goal, "plan": self.plan, "what": self.waits_for, "left_s": self.left_s}
        text = words[self.kind].format(**values)
        if self.left_s is not None and self.kind != "moment":
            text += words["until"].format(**values)
        return text + "".join(words["needed for"].format(goal=goal) for goal in self.needed_for) + "."

    def data(self) -> dict[str, Any]:
        """Return the explanation as plain data for JSON."""
        return {"sentence": self.sentence, **asdict(self)}

    def __str__(self) -> str:
        return self.sentence


def explain(agent: Observed, goal: Literal) -> Why:
    """The first intention for this goal, else the event that waits for a plan, else how it ended."""
    for intention in agent.intentions.values():
        for height, means in enumerate(intention.stack):
            if _is_about(means.event, goal):
                return _about_intention(agent, intention, height)
    for event in (*agent.events, *agent.suspended_events):
        if _is_about(event, goal):
            return _about_event(agent, event)
    return _about_the_past(agent, goal)


def explain_intention(agent: Observed, intention: Intention) -> Why:
    """Explain an intention, seen from its topmost goal."""
    return _about_intention(agent, intention, len(intention.stack) - 1)


def _is_about(event: Event, goal: Literal) -> bool:
    return event.trigger in PURSUED and unify(renamed(goal, {}), renamed(event.literal, {}), [])


def _about_event(agent: Observed, event: Event) -> Why:
    if event in agent.suspended_events:
        return Why(event.plain, "pending suspended", State.SUSPENDED.value)
    blocked = _atomic_plan(agent, event.intention)
    kind = "pending behind" if blocked else "pending"
    return Why(event.plain, kind, State.EVENT.value, waits_for=blocked)


def _about_the_past(agent: Observed, goal: Literal) -> Why:
    for failure in reversed(agent.given_up):
        event = _event_of(failure.goal)
        if event and event[0] in _LOOKED_BACK and unify(renamed(goal, {}), renamed(event[1], {}), []):
            reason = f"{failure.error}, {failure.message}"
            return Why(show(event[1]), "given up", State.DONE.value, waits_for=reason)
    return Why(show(goal), UNKNOWN, UNKNOWN)


def _event_of(text: str) -> tuple[Trigger, Literal] | None:
    try:
        return parse_event(text)
    except AgentSpeakError:
        return None  # a goal with a value that has no notation, such as a map


def _about_intention(agent: Observed, intention: Intention, height: int) -> Why:
    top = intention.stack[-1]
    kind, what, left_s = _reason(agent, intention)
    return Why(
        intention.stack[height].event.plain,
        kind,
        State.SUSPENDED.value if intention.suspended else intention.state.value,
        intention.number,
        top.plan.label,
        str(top.step.source) if top.step is not None else None,
        what,
        left_s,
        tuple(str(means.event) for means in reversed(intention.stack[height:])),
        _why_chosen(agent.choices, top),
        tuple(means.event.plain for means in _goals_between(intention, height)),
    )


def _goals_between(intention: Intention, height: int) -> list[Means]:
    """The goals from the top down to, and without, the one that was asked about."""
    between = reversed(intention.stack[height + 1 :])
    return [means for means in between if means.event.trigger is Trigger.GOAL_ADDED]


def _reason(agent: Observed, intention: Intention) -> tuple[str, str | None, float | None]:
    """Kind, what it waits for, and how long at most."""
    waits_for: Any = intention.waits_for
    state = intention.state
    if intention.suspended:
        by = intention.suspended_by
        return ("suspended by" if by else "suspended"), by or None, None
    if state is State.ACTION:
        return "action", show(waits_for), None
    if state is State.TIME and isinstance(waits_for, float):
        return "moment", f"the moment {waits_for:.3f}", max(0.0, waits_for - agent.now)
    if state is State.TIME:
        return "event", str(getattr(waits_for, "what", waits_for)), _left(agent, getattr(waits_for, "deadline_s", None))
    if state is State.ANSWER:
        return "answer", str(waits_for), _left(agent, _answer_until(agent, intention))
    if state is State.CONDITION:
        return "condition", str(intention.stack[-1].plan.plan.condition), None
    if state is State.EVENT:
        event = next((each for each in agent.events if each.intention is intention), None)
        return "sub-goal", str(event) if event else None, None
    blocked = _atomic_plan(agent, intention)
    return ("turn", blocked, None) if blocked else ("running", None, None)


def _left(agent: Observed, deadline_s: float | None) -> float | None:
    return None if deadline_s is None else max(0.0, deadline_s - agent.now)


def _answer_until(agent: Observed, intention: Intention) -> float | None:
    return next((asked.deadline_s for asked in agent.asked.values() if asked.intention is intention), None)


def _atomic_plan(agent: Observed, intention: Intention | None) -> str | None:
    """The plan that holds the agent for itself, unless it belongs to this intention."""
    atomic = agent.atomic
    if atomic is None or atomic is intention:
        return None
    plan = next((means.plan.label for means in reversed(atomic.stack) if means.plan.atomic), "?")
    return WORDS["plan of intention"].format(plan=plan, number=atomic.number)


def _why_chosen(choices: Iterable[Deliberated], means: Means) -> str | None:
    """Return why this plan was chosen, if there was a listener then."""
    choice = next((each for each in reversed(list(choices)) if each.event is means.event), None)
    if choice is None:
        return None
    values = {"plan": means.plan.label, "event": str(choice.event), "count": len(choice.options)}
    earlier = [verdict for verdict in choice.verdicts if verdict.plan in choice.tried and verdict.why]
    others = [verdict for verdict in earlier if verdict.plan != means.plan.label]
    if others:
        reasons = [WORDS["not chosen"].format(plan=each.plan, why=each.why) for each in others]
        return WORDS["chosen after"].format(**values, others=", ".join(reasons))
    return WORDS["chosen only" if len(choice.options) == 1 else "chosen first"].format(**values)
