"""The trace of an agent: one entry for each choice, step and change, in order, made while there are listeners.

An entry holds the event, plan or step itself and becomes words only when it is asked for them (`str`) or for data that
JSON can hold (`data`): listening costs little. Ask at once: the variables of an event get values later.
"""

from collections import deque
from random import Random
from typing import Any, NamedTuple, Protocol, TypeAlias

from bdi.language.syntax import Simple, Step, Trigger
from bdi.language.terms import Literal, show
from bdi.model.beliefs import Beliefs
from bdi.model.intentions import Event, Intention
from bdi.model.logic import Logic
from bdi.model.plans import CompiledPlan, Library
from bdi.model.society import Asked

CHOSEN, WOULD_APPLY, HEAD, CONTEXT, ERROR = "chosen", "would apply", "head", "context", "error"


class GoalFailure(NamedTuple):
    """A goal that no plan could rescue: its intention was dropped."""

    goal: str
    error: str
    message: str

    def __str__(self) -> str:
        return f"{self.goal}: {self.error} ({self.message})"


class Verdict(NamedTuple):
    """The reason why one plan was or was not taken. `verdict` is chosen, would apply (but stands later), head (it does
    not unify), context (it does not hold) or error (the context cannot be worked out)."""

    plan: str
    source: str
    line: int
    verdict: str
    why: str
    bindings: tuple[tuple[str, str], ...] = ()

    def data(self) -> dict[str, Any]:
        return {**self._asdict(), "bindings": dict(self.bindings)}


class Deliberated(NamedTuple):
    """An event was selected, and for it a plan (None: no plan applied) out of these. The verdicts are there if a
    listener asked for them."""

    cycle: int
    event: Event
    plan: CompiledPlan | None
    options: tuple[CompiledPlan, ...]
    verdicts: tuple[Verdict, ...] = ()

    @property
    def tried(self) -> tuple[str, ...]:
        """The labels of the plans that were looked at, up to the one that was taken."""
        labels = [option.label for option in self.options]
        return tuple(labels if self.plan is None else labels[: self.options.index(self.plan) + 1])

    def data(self) -> dict[str, Any]:
        return {
            "kind": "deliberated",
            "cycle": self.cycle,
            "event": str(self.event),
            "plan": self.plan.label if self.plan else None,
            "tried": list(self.tried),
            "options": [verdict.data() for verdict in self.verdicts],
        }

    def __str__(self) -> str:
        event = f"{self.cycle} {self.event}{_error_of(self.event)}"
        if self.plan:
            line = self.plan.plan.place.line
            where = f" (line {line})" if line else ""
            return f"{event}: plan {self.plan.label}{where}, of {len(self.options)} relevant"
        return f"{event}: none of {len(self.options)} relevant plans applies"


def _error_of(event: Event) -> str:
    """[error(E)] of a goal that has failed."""
    return next((f"[{show(each)}]" for each in event.annots if getattr(each, "functor", "") == "error"), "")


class Stepped(NamedTuple):
    """An intention takes a step."""

    cycle: int
    intention: int
    step: Step

    def data(self) -> dict[str, Any]:
        place = self.step.place
        return {
            "kind": "stepped",
            "cycle": self.cycle,
            "intention": self.intention,
            "step": brief(self.step),
            "source": place.source,
            "line": place.line,
        }

    def __str__(self) -> str:
        return f"{self.cycle} intention {self.intention}: {brief(self.step)}"


class Changed(NamedTuple):
    """A belief came (or got another source or annotation), or went."""

    cycle: int
    trigger: Trigger
    literal: Literal

    def data(self) -> dict[str, Any]:
        return {"kind": "changed", "cycle": self.cycle, "change": self.trigger.value, "belief": show(self.literal)}

    def __str__(self) -> str:
        return f"{self.cycle} {self.trigger}{show(self.literal)}"


class Failed(NamedTuple):
    """A goal was given up."""

    cycle: int
    goal: str
    error: str
    message: str

    def data(self) -> dict[str, Any]:
        return {"kind": "failed", **self._asdict()}

    def __str__(self) -> str:
        return f"{self.cycle} {self.goal} given up: {self.error}, {self.message}"


TraceEntry: TypeAlias = Deliberated | Stepped | Changed | Failed


def brief(step: Step) -> str:
    """A step in one line: of a loop or branch only its condition."""
    if isinstance(step, Simple):
        return str(step)
    text = str(step)
    return text if len(text) <= 40 else f"{text.partition('{')[0].strip()} {{…}}"


class Observed(Protocol):
    """An agent as explanations see it; they only read."""

    name: str
    cycles: int
    now: float
    random: Random
    beliefs: Beliefs
    library: Library
    logic: Logic
    events: deque[Event]
    suspended_events: list[Event]
    intentions: dict[int, Intention]
    atomic: Intention | None
    asked: dict[str, Asked]
    choices: deque[Deliberated]
    given_up: deque[GoalFailure]
