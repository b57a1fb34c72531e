"""The agent between two cycles, read and never changed: its intentions as stacks, why each stands, what was chosen."""

from collections.abc import Iterable
from pathlib import PurePath
from typing import Final

from bdi import Agent, Changed, Deliberated, Failed, Place, Stepped, TraceEntry, Why
from bdi.debug.explain import explain_intention
from bdi.debug.trace import CHOSEN, WOULD_APPLY, brief
from bdi.language.syntax import BELIEF_ADDED
from bdi.model.intentions import Intention, branches_of
from bdi.model.intentions import Means as HeldMeans
from protocol.diagnostics import Because, IntentionReport, Means, NotChosen, TraceLine

LONGEST: Final = 300
LONGEST_SENTENCE: Final = 1000
MOST_GOALS: Final = 30
"""Of one stack; a recursion may be a thousand deep, and its newest goals say enough."""
MOST_PASSED_OVER: Final = 8


def short(text: str, most: int = LONGEST) -> str:
    """As much as a message may carry."""
    return text if len(text) <= most else text[: most - 1] + "…"


def intention_told(agent: Agent, intention: Intention) -> IntentionReport:
    """One intention as it stands now."""
    beside = tuple(one.number for one in branches_of(intention) if one is not intention)
    return IntentionReport(
        number=intention.number,
        state="suspended" if intention.suspended else intention.state.name.lower(),
        because=because(explain_intention(agent, intention)),
        stack=tuple(_means(agent.choices, means) for means in intention.stack[-MOST_GOALS:]),
        beside=beside[:MOST_GOALS],
    )


def because(why: Why) -> Because:
    """Return the reason of an action as it is sent."""
    return Because(
        kind=why.kind,
        sentence=short(why.sentence, LONGEST_SENTENCE),
        goal=short(why.goal),
        plan=None if why.plan is None else short(why.plan),
        what=None if why.waits_for is None else short(why.waits_for),
        left_s=None if why.left_s is None else round(why.left_s, 1),
        needed_for=tuple(map(short, why.needed_for[:MOST_GOALS])),
    )


def _means(choices: Iterable[Deliberated], means: HeldMeans) -> Means:
    choice = next((one for one in choices if one.event is means.event), None)
    return Means(
        goal=short(str(means.event)),
        plan=short(means.plan.label),
        place=_place(means.plan.plan.place),
        step=short(brief(means.step.source)) if means.step is not None else None,
        relevant=len(choice.options) if choice else None,
        passed_over=_passed_over(choice) if choice else (),
    )


def _place(place: Place) -> str | None:
    """`mission.asl:33`; what was made while running stands nowhere."""
    return short(f"{PurePath(place.source).name}:{place.line}") if place.line else None


def _passed_over(choice: Deliberated) -> tuple[NotChosen, ...]:
    """The plans that stand before the one that was taken, and why not they."""
    looked_at = [
        one for one in choice.verdicts if one.verdict not in (CHOSEN, WOULD_APPLY) and one.plan in choice.tried
    ]
    return tuple(NotChosen(plan=short(one.plan), why=short(one.why)) for one in looked_at[:MOST_PASSED_OVER])


def line_told(entry: TraceEntry) -> TraceLine:
    """An entry of the trace in words; at once, since what it holds goes on changing."""
    match entry:
        case Deliberated(cycle=cycle, event=event, plan=plan):
            return TraceLine(
                cycle=cycle,
                kind="chose",
                text=short(str(event)),
                plan=short(plan.label) if plan else None,
                place=_place(plan.plan.place) if plan else None,
                intention=event.intention.number if event.intention else None,
                passed_over=_passed_over(entry),
            )
        case Stepped(cycle=cycle, intention=intention, step=step):
            text, place = short(brief(step)), _place(step.place)
            return TraceLine(cycle=cycle, kind="did", text=text, place=place, intention=intention)
        case Changed(cycle=cycle, trigger=trigger, literal=literal):
            kind = "believed" if trigger is BELIEF_ADDED else "forgot"
            return TraceLine(cycle=cycle, kind=kind, text=short(str(literal)))
        case Failed(cycle=cycle, goal=goal, error=error, message=message):
            return TraceLine(cycle=cycle, kind="gave_up", text=short(f"{goal}: {error}, {message}"))
