"""A run that is looked at cycle by cycle, forwards and back."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from bdi.debug.explain import WORDS, explain_intention
from bdi.debug.trace import Deliberated, TraceEntry, brief
from bdi.language.syntax import Program
from bdi.language.terms import show
from bdi.model.intentions import Intention, Means
from bdi.model.messages import Message
from bdi.reasoning.agent import Agent
from bdi.reasoning.output import Outcome
from bdi.tools.simulation import Happened, Prepare


class Running(Protocol):
    """A simulation, or a recording that is run again."""

    number: int

    @property
    def agents(self) -> Mapping[str, Agent]: ...
    @property
    def over(self) -> bool: ...
    def cycle(self) -> tuple[Happened, ...]: ...


@dataclass(frozen=True, slots=True)
class Level:
    """One plan of an intention: the goal it is for, and its next step (empty after the last one)."""

    event: str
    plan: str
    line: int
    next_step: str


@dataclass(frozen=True, slots=True)
class Stack:
    """An intention as it is after a cycle, the newest plan first."""

    number: int
    state: str
    levels: tuple[Level, ...]

    def data(self) -> dict[str, Any]:
        plans = [{"event": e.event, "plan": e.plan, "line": e.line, "next": e.next_step or None} for e in self.levels]
        return {"number": self.number, "state": self.state, "plans": plans}


@dataclass(frozen=True, slots=True)
class Cycle:
    """The record of one agent in one cycle."""

    number: int
    agent: str
    entries: tuple[TraceEntry, ...]
    added: tuple[str, ...]
    removed: tuple[str, ...]
    outcome: Outcome
    sent: tuple[Message, ...]
    stacks: tuple[Stack, ...]
    waiting: tuple[str, ...]  # events of the world and new goals that no plan was chosen for yet

    @property
    def choice(self) -> Deliberated | None:
        return next((entry for entry in self.entries if isinstance(entry, Deliberated)), None)

    def data(self) -> dict[str, Any]:
        return {
            "cycle": self.number,
            "agent": self.agent,
            "entries": [entry.data() for entry in self.entries],
            "added": list(self.added),
            "removed": list(self.removed),
            "actions": [str(action) for action in self.outcome.actions],
            "cancelled": list(self.outcome.cancelled),
            "messages": [[each.receiver, each.performative, show(each.content)] for each in self.sent],
            "printed": list(self.outcome.printed),
            "failures": [failure._asdict() for failure in self.outcome.failures],
            "intentions": [stack.data() for stack in self.stacks],
            "waiting": list(self.waiting),
        }


class Stepper:
    """Steps through a run; `begin` starts it from its beginning, each time the same."""

    def __init__(self, begin: Callable[[Prepare], Running]) -> None:
        self._begin = begin
        self.running = self._start()

    def _start(self) -> Running:
        self._before: dict[str, dict[str, None]] = {}
        running = self._begin(_listen)
        for name, agent in running.agents.items():
            self._before[name] = _beliefs(agent)
        return running

    @property
    def number(self) -> int:
        return self.running.number

    @property
    def agents(self) -> Mapping[str, Agent]:
        return self.running.agents

    def cycle(self) -> list[Cycle]:
        """The next cycle of every agent; nothing when the run is over."""
        return [self._seen(happened) for happened in self.running.cycle()]

    def back_to(self, number: int) -> list[Cycle]:
        """Start again, up to this cycle (0: before the first one)."""
        self.running = self._start()
        cycles: list[Cycle] = []
        while self.number < number and (found := self.cycle()):
            cycles = found
        return cycles

    def _seen(self, happened: Happened) -> Cycle:
        agent = self.running.agents.get(happened.agent)
        before = self._before.get(happened.agent, {})
        now = before if agent is None else _beliefs(agent)
        self._before[happened.agent] = now
        return Cycle(
            happened.cycle,
            happened.agent,
            happened.outcome.trace,
            tuple(text for text in now if text not in before),
            tuple(text for text in before if text not in now),
            happened.outcome,
            happened.sent,
            stacks_of(agent) if agent else (),
            waiting_in(agent) if agent else (),
        )


def _listen(agent: Agent, program: Program) -> None:
    agent.listen(lambda entry: None, explain=True)


def _beliefs(agent: Agent) -> dict[str, None]:
    return dict.fromkeys(show(literal) for literal in agent.beliefs)


def waiting_in(agent: Agent) -> tuple[str, ...]:
    return tuple(str(event) for event in agent.events if event.intention is None)


def goals_of(agent: Agent) -> list[str]:
    """The goals of all intentions, as `why` can be asked about them."""
    events = [level.event for stack in stacks_of(agent) for level in stack.levels]
    return list(dict.fromkeys(event[2:] for event in events if event[1] in "!?"))


def stacks_of(agent: Agent) -> tuple[Stack, ...]:
    return tuple(_stack(agent, intention) for intention in agent.intentions.values() if intention.stack)


def _stack(agent: Agent, intention: Intention) -> Stack:
    levels = tuple(_level(means) for means in reversed(intention.stack))
    return Stack(intention.number, state_of(agent, intention), levels)


def state_of(agent: Agent, intention: Intention) -> str:
    """Describe the intention without its goal and plan."""
    return explain_intention(agent, intention).in_words(_SHORT).removesuffix(".")


_SHORT = {
    **WORDS,
    "action": "waits for action {what}",
    "moment": "waits {left_s:.1f} s more",
    "event": "waits for {what}",
    "answer": "waits for {what}",
    "suspended": "is suspended",
    "suspended by": "is suspended by plan {what}",
    "turn": "waits behind {what}",
    "sub-goal": "has posted {what}",
    "running": "goes on",
}


def _level(means: Means) -> Level:
    step = means.step
    following = brief(step.source) if step is not None else ""
    return Level(str(means.event), means.plan.label, means.plan.plan.place.line, following)
