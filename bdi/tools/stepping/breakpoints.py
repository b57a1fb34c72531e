"""Breakpoints:

    +!goto/2   +!goto   +!goto(post1)   -!goto    this event is chosen
    +at/1      -at(post1)                         this belief comes or goes, or its event is chosen
    @by_line   by_line                            this plan is chosen
    drive/1    drive(forward)                     this action starts

A plan with the annotation `@label[breakpoint]` is one by itself.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass

from bdi.language.errors import AgentSpeakSyntaxError, Place
from bdi.language.parser import parse_literal
from bdi.language.syntax import Trigger
from bdi.language.terms import Literal
from bdi.language.unify import renamed, unify
from bdi.reasoning.agent import Agent
from bdi.tools.stepping.stepper import Cycle

_PATTERN = re.compile(r"(?P<mark>[-+^][!?]?|@)?\s*(?P<name>~?[a-z]\w*(\.\w+)*)(?P<arity>/\d+)?(?P<args>\(.*\))?")
_BELIEFS = {"+": "added", "-": "removed"}


@dataclass(frozen=True, slots=True)
class Breakpoint:
    """`mark` is the trigger, "@" for a plan, "" for an action or plan; `arity` and `literal` narrow it down."""

    text: str
    mark: str
    name: str
    arity: int | None
    literal: Literal | None

    def hit(self, cycle: Cycle) -> str | None:
        """Describe the part of this cycle that it matches."""
        choice = cycle.choice
        if choice is not None and self.mark in ("@", "") and choice.plan is not None and choice.plan.label == self.name:
            return f"plan {self.name} is chosen"
        if self.mark == "":
            started = (action.term for action in cycle.outcome.actions)
            return next((f"action {term} starts" for term in started if self._is(term)), None)
        if self.mark in _BELIEFS:
            changed: tuple[str, ...] = getattr(cycle, _BELIEFS[self.mark])
            found = next((text for text in changed if self._is(parse_literal(text))), None)
            if found is not None:
                return f"{self.mark}{found}"
        if choice is not None and choice.event.trigger.value == self.mark and self._is(choice.event.literal):
            return f"event {choice.event}"
        return None

    def _is(self, term: Literal) -> bool:
        key = term.predicate
        name = f"~{key.name}" if key.negated else key.name
        if name != self.name or self.arity not in (None, key.arity):
            return False
        return self.literal is None or unify(renamed(self.literal, {}), renamed(term, {}), [])


def breakpoint_of(text: str) -> Breakpoint:
    """Raises AgentSpeakSyntaxError."""
    found = _PATTERN.fullmatch(text.strip())
    if found is None or (found["mark"] or "+") not in ("@", *(trigger.value for trigger in Trigger)):
        place = Place("<breakpoint>", 1, 1, text)
        raise AgentSpeakSyntaxError("this is no breakpoint", place, ("+!goto/2", "+at(post1)", "@label", "drive/1"))
    literal = parse_literal(f"{found['name']}{found['args']}") if found["args"] else None
    arity = int(found["arity"][1:]) if found["arity"] else len(literal.args) if literal else None
    return Breakpoint(text.strip(), found["mark"] or "", found["name"], arity, literal)


def is_written_in(name: str, agent: Agent) -> bool:
    """Return whether a plan is called so, or mentions it."""
    word = re.compile(rf"(?<!\w){re.escape(name)}(?!\w)")
    return any(plan.label == name or word.search(str(plan.plan)) for plan in agent.library.plans)


def stop_in(cycle: Cycle, breakpoints: Iterable[Breakpoint]) -> str | None:
    """Return the reason to stop after this cycle, in words."""
    choice = cycle.choice
    if choice is not None and choice.plan is not None and choice.plan.plan.has("breakpoint"):
        return f"plan {choice.plan.label} is a breakpoint"
    return next((why for each in breakpoints if (why := each.hit(cycle)) is not None), None)
