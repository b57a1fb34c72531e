"""The event and the intention whose turn it is: in order, or by a table that the program states among its beliefs:

    priorities([safety, health, map, mission, navigation, movement]).   // levels, the most urgent first
    priority(+bumped, safety).                                         // of an event, as +b(_), -b(_) or "+!g(_)"
    @charge[priority(health)] +!charge <- dock.                        // of a plan

The level of an event is that of the first `priority` that unifies, or else of the plan that would be chosen for it; a
goal is at least as urgent as the intention that wants it. An intention is as urgent as the most urgent goal or plan on
its stack, the plan that takes care of a failure as the plan that failed. What has no level comes last, or where the
table has the level `default`. In each cycle the most urgent event and the most urgent intention that can go on have
their turn; within a level all is as without a table: events first in, first out, intentions round robin.

A level has no turn while a more urgent one always has something to do. An intention that waits for an action or a
moment has nothing to do, so that the others go on meanwhile. An atomic plan goes before everything.
"""

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from bdi.language.errors import AgentSpeakSyntaxError, Place, WrongPriority
from bdi.language.parser import parse_event
from bdi.language.syntax import BELIEF_ADDED, BELIEF_REMOVED, Belief, Plan, Program, Trigger
from bdi.language.terms import (
    NEGATIVE,
    POSITIVE,
    Atom,
    Code,
    List,
    Literal,
    String,
    Structure,
    Term,
    Var,
    predicate,
    show,
)
from bdi.language.unify import undo, unify
from bdi.model.intentions import Event, Intention, Means
from bdi.model.plans import CompiledPlan, applies
from bdi.model.subplans import Reaction, Scopes, Selects
from bdi.reasoning.circumstance import Circumstance

LEVELS, LEVEL = predicate("priorities", 1), predicate("priority", 2)
OF_PLAN = predicate("priority", 1)
DEFAULT = "default"
BELIEF_EVENTS = (BELIEF_ADDED, BELIEF_REMOVED)
_SIGNS = {POSITIVE: BELIEF_ADDED, NEGATIVE: BELIEF_REMOVED}


class Entry(NamedTuple):
    trigger: Trigger
    pattern: Literal
    level: int


class Table:
    """The levels of a program as numbers: 0 is the most urgent."""

    def __init__(self, names: Iterable[str]) -> None:
        self.ranks = {name: rank for rank, name in enumerate(names)}
        self.none = len(self.ranks)  # says nothing: less than any level
        self.default = self.ranks.get(DEFAULT, self.none)
        self.entries: list[Entry] = []

    def rank(self, level: Term, place: Place) -> int:
        """Raises WrongPriority."""
        rank = self.ranks.get(show(level))
        if rank is None:
            raise WrongPriority(f"{show(level)} is no level of the table", place, tuple(self.ranks))
        return rank

    def of_plan(self, plan: Plan) -> int:
        """Return the level in its label. An unknown level, of a plan that another agent sent, counts as none."""
        level = _level_of(plan)
        return self.none if level is None else self.ranks.get(show(level), self.none)

    def final(self, level: int) -> int:
        return self.default if level == self.none else level


def table_of(program: Program) -> Table | None:
    """The table that a program states, if it does. Raises WrongPriority."""
    beliefs = [belief for belief in program.beliefs if isinstance(belief, Belief)]
    stated = [belief for belief in beliefs if belief.literal.predicate is LEVELS]
    if not stated:
        return None
    if len(stated) > 1:
        raise WrongPriority("the table of priorities is stated twice", stated[1].place)
    table = Table(_names(stated[0]))
    for belief in beliefs:
        if belief.literal.predicate is LEVEL:
            table.entries.append(_entry(belief, table))
    for plan in _with_subplans(program.plans):
        level = _level_of(plan)
        if level is not None:
            table.rank(level, plan.place)
    return table


def _level_of(plan: Plan) -> Term | None:
    """@label[priority(LEVEL)]"""
    annots = (annot for annot in plan.label.annots if isinstance(annot, Structure))
    return next((annot.args[0] for annot in annots if annot.predicate is OF_PLAN), None)


def _names(belief: Belief) -> list[str]:
    levels = belief.literal.args[0]
    names = [level.functor for level in levels if isinstance(level, Atom)] if isinstance(levels, List) else []
    if not isinstance(levels, List) or len(set(names)) < len(levels) or not names:
        raise WrongPriority("a table of priorities is a list of different names", belief.place)
    return names


def _entry(belief: Belief, table: Table) -> Entry:
    what, level = belief.literal.args
    event = _event_in(what)
    if event is None:
        raise WrongPriority(f"{show(what)} is no event", belief.place, ("+b(_)", "-b(_)", '"+!g(_)"'))
    return Entry(*event, table.rank(level, belief.place))


def _event_in(what: Term) -> tuple[Trigger, Literal] | None:
    """+b(_)   "+!g(_)"   {+!g(_)}"""
    if isinstance(what, String):
        try:
            return parse_event(str.__str__(what))
        except AgentSpeakSyntaxError:
            return None
    if isinstance(what, Code) and isinstance(what.body, Plan) and not isinstance(what.body.head, Var):
        return what.body.trigger, what.body.head
    if isinstance(what, Structure) and what.predicate in _SIGNS and isinstance(what.args[0], Atom | Structure):
        return _SIGNS[what.predicate], what.args[0]
    return None


def _with_subplans(plans: Iterable[Plan]) -> Iterator[Plan]:
    for plan in plans:
        yield plan
        yield from _with_subplans(plan.subplans)


class Priorities:
    """Selects for one agent by its table; while an atomic plan runs, as without one."""

    def __init__(self, table: Table, mind: Circumstance, otherwise: Selects) -> None:
        self._otherwise = otherwise
        self._table = table
        self._mind = mind

    def select_event(self) -> Event | None:
        """The most urgent event, of several the first; those that no plan is about are passed over."""
        mind = self._mind
        if mind.atomic is not None:
            return self._otherwise.select_event()
        best: Event | None = None
        urgency = 0
        for event in list(mind.events):
            is_ignored = not event.options and event.intention is None and event.trigger in BELIEF_EVENTS
            if is_ignored and (mind.scopes is None or not mind.scopes.awaits(event)):
                mind.events.remove(event)
                continue
            level = self.of_event(event)
            if best is None or level < urgency:
                best, urgency = event, level
        if best is not None:
            mind.events.remove(best)
        return best

    def select_intention(self) -> Intention | None:
        """The most urgent intention that can go on, of several the one that waits longest."""
        if self._mind.atomic is not None:
            return self._otherwise.select_intention()
        running = self._mind.running
        best = min(running, key=self.of_intention, default=None)
        if best is not None:
            running.remove(best)
        return best

    def of_event(self, event: Event) -> int:
        level = self._entry_of(event)
        if level is None:
            level = self._of_chosen_plan(event)
        if event.intention is not None:
            stack = event.intention.stack
            level = min(level, self._of_means(stack, len(stack) - 1))
        return self._table.final(min(level, self._around(event)))

    def of_intention(self, intention: Intention) -> int:
        return self._table.final(self._of_means(intention.stack, len(intention.stack) - 1))

    def settle(self, event: Event, plan: CompiledPlan) -> int:
        """The level of a plan that is about to be put on its stack, with what it inherits."""
        stack = [] if event.intention is None else event.intention.stack
        below = event.under if event.trigger in (Trigger.GOAL_FAILED, Trigger.TEST_FAILED) else len(stack) - 1
        return min(self._own(event, plan), self._of_means(stack, min(below, len(stack) - 1)))

    def _of_means(self, stack: list[Means], height: int) -> int:
        if height < 0:
            return self._table.none
        means = stack[height]
        level = means.level
        if level is None:  # a branch begins with a means of its own
            level = means.level = min(self._own(means.event, means.plan), self._of_means(stack, height - 1))
        return level

    def _own(self, event: Event, plan: CompiledPlan) -> int:
        level = self._entry_of(event)
        level = self._table.none if level is None else level
        return min(level, self._table.of_plan(plan.plan), self._around(event))

    def _around(self, event: Event) -> int:
        """A reaction of a sub-plan is as urgent as the goal that it belongs to."""
        stack = list(event.around) if isinstance(event, Reaction) else []
        return self._of_means(stack, len(stack) - 1)

    def _entry_of(self, event: Event) -> int | None:
        trail = self._mind.logic.trail
        for entry in self._table.entries:
            if entry.trigger is event.trigger and entry.pattern.predicate is event.key:
                found = unify(entry.pattern, event.literal, trail)
                undo(trail, 0)
                if found:
                    return entry.level
        return None

    def _of_chosen_plan(self, event: Event) -> int:
        """Contexts are asked only where it matters which plan it would be."""
        of_plan = self._table.of_plan
        levels = {of_plan(plan.plan) for plan in event.options}
        if len(levels) > 1:
            return next(
                (of_plan(plan.plan) for plan in event.options if applies(plan, event, self._mind.logic.trail)),
                self._table.none,
            )
        return levels.pop() if levels else self._table.none


class InOrder:
    """Selects without a table of priorities."""

    __slots__ = ("agent",)

    def __init__(self, agent: Circumstance) -> None:
        self.agent = agent

    def select_event(self) -> Event | None:
        """First in, first out, passing over what no plan is about; while an atomic plan runs only its own events."""
        agent = self.agent
        events = agent.events
        if agent.atomic is None:
            while events:
                event = events.popleft()
                if event.options or event.intention is not None or event.trigger not in BELIEF_EVENTS:
                    return event
                if agent.scopes is not None and agent.scopes.awaits(event):
                    return event
            return None
        for event in events:
            if event.intention is not None and event.intention.atomic:
                events.remove(event)
                return event
        return None

    def select_intention(self) -> Intention | None:
        """Round robin; an atomic plan runs alone."""
        agent = self.agent
        if agent.atomic is None:
            return agent.running.popleft() if agent.running else None
        for intention in agent.running:
            if intention.atomic or intention is agent.atomic:
                agent.running.remove(intention)
                if not intention.atomic:
                    agent.atomic = None
                return intention
        return None


class Selection:
    """The selector of one agent: sub-plans come first, then the table of its program or the order."""

    __slots__ = ("_agent", "_drop", "_in_order", "priorities", "selector")

    def __init__(self, agent: Circumstance, drop: Callable[[Intention], None]) -> None:
        self._agent = agent
        self._drop = drop
        self._in_order = InOrder(agent)
        self.priorities: Priorities | None = None
        self.selector: Selects = self._in_order

    def follow(self, table: Table) -> None:
        """Select by this table from now on."""
        self.priorities = Priorities(table, self._agent, otherwise=self._in_order)
        if self._agent.scopes is None:
            self.selector = self.priorities
        else:
            self._agent.scopes.selector = self.priorities

    def heed_subplans(self, plans: Iterable[Plan]) -> None:
        """Look for sub-plans from now on if one of these plans has some."""
        agent = self._agent
        if agent.scopes is None and any(plan.subplans for plan in plans):
            self.selector = agent.scopes = Scopes(agent, self._drop, self.selector)
            agent.attentive = True
