"""Sub-plans: plans that exist only while the plan that they stand behind is being carried out.

    +!patrol(Room) <- !walk(1); !walk(2).
    {
      +!walk(N)  <- drive(Room,N).     // a goal of this plan: goes before the plans of the program
      -!walk(N)  <- report(Room,N).    // its failure
      +?door(D)  <- ask(Room,D).       // a question of this plan that no belief answers
      +noise(P)  <- look(P).           // what happens meanwhile: a reaction beside the intention
    }

A sub-plan knows the variables of the plans around it, with the values of the moment in which its event is looked at;
what it finds out stays its own. A reaction ends with the goal that it belongs to. A suspended goal does not react.
"""

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from typing import Protocol

from bdi.language.syntax import BELIEF_ADDED, BELIEF_REMOVED, Plan, Trigger, with_terms
from bdi.language.terms import Literal, Term, Var
from bdi.language.unify import Trail, renamed, substituted, undo, unify
from bdi.model.intentions import Event, Intention, Means
from bdi.model.logic import Frame, Logic
from bdi.model.plans import CompiledPlan, Library, Options, applies, relevant

Around = Sequence[Means]  # the plan that a sub-plan stands in, on top of those that led there


class Selects(Protocol):
    def select_event(self) -> Event | None: ...
    def select_intention(self) -> Intention | None: ...


class HasIntentions(Protocol):
    """An agent, as far as sub-plans go."""

    library: Library
    logic: Logic
    events: deque[Event]
    intentions: dict[int, Intention]


class Reaction(Event):
    """An event of the world that a sub-plan reacts to: its only option."""

    __slots__ = ()

    @property
    def plan(self) -> "Scoped":
        found: Scoped = self.options[0]
        return found

    @property
    def around(self) -> Around:
        return self.plan.stands_in


class Scoped(CompiledPlan):
    """A sub-plan, with the values that the variables around it have."""

    __slots__ = ("_inner", "_values", "goal", "stands_in")

    def __init__(self, inner: CompiledPlan, stands_in: Around) -> None:
        for name in CompiledPlan.__slots__:
            if name != "__weakref__":
                setattr(self, name, getattr(inner, name))
        self.applicable = self._apply
        self.stands_in = stands_in
        self.goal = stands_in[-1].event  # a plan that pursues its own goal again gets another one
        self._inner = inner
        self._values = _values_of(inner.around, stands_in[-1])

    def _apply(self, event: Event) -> Frame | None:
        inner = self._inner
        frame = inner.applicable((event, self._values) if self.around else event)
        self.first, self.condition, self.places = inner.first, inner.condition, inner.places  # compiled by now
        return frame

    def concerns(self, literal: Literal) -> bool:
        trail: Trail = []
        found = unify(substituted(self.plan.head, self._known()), renamed(literal, {}), trail)
        undo(trail, 0)
        return found

    def as_seen(self) -> Plan:
        known = self._known()
        return with_terms(self.plan, lambda term: substituted(term, known))

    def _known(self) -> dict[Var, Term]:
        return dict(zip(self.around, self._values, strict=True))


def _values_of(variables: tuple[Var, ...], means: Means) -> list[Term]:
    """Return the values of the variables around a sub-plan; free ones are its own."""
    names: dict[Var, Term] = {}
    places = means.plan.places
    values = [means.frame[places[variable.name]] for variable in variables]
    return [Var("_") if value is None else renamed(value, names) for value in values]


class Scopes:
    """Looks up sub-plans, and sees to their reactions while the agent selects; an agent that has some has one."""

    def __init__(self, mind: HasIntentions, drop: Callable[[Intention], None], selector: Selects) -> None:
        self.selector = selector
        self._mind = mind
        self._drop = drop
        self._reacting = False  # whether a reaction may be there

    def options(self, stack: Around, trigger: Trigger, literal: Literal) -> Options:
        """The sub-plans for what this stack pursues, those of the innermost plan first, then the plans of the agent;
        none where no sub-plan is relevant."""
        library = self._mind.library
        found: list[CompiledPlan] = []
        for around in _all_around(stack):
            found += _relevant(around, trigger, literal)
        if found:
            found += relevant(library.options(trigger, literal.predicate), literal)
        return Options.of_the_moment(found, library.compiler)

    def awaits(self, event: Event) -> bool:
        """Return whether a sub-plan may react to this event of the world."""
        literal = event.literal
        return any(
            _relevant(around, event.trigger, literal)
            for intention in self._awake()
            for around in _of_stack(intention.stack)
        )

    # ---- while the agent selects -----------------------------------------------------------------------------------

    def select_event(self) -> Event | None:
        while True:
            event = self.selector.select_event()
            if not isinstance(event, Reaction):
                if event is not None and event.intention is None and event.trigger in (BELIEF_ADDED, BELIEF_REMOVED):
                    self._offer(event)
                return event
            if self._is_pursued(event):
                return event

    def select_intention(self) -> Intention | None:
        if self._reacting:
            self._end_reactions()
        return self.selector.select_intention()

    def _offer(self, event: Event) -> None:
        """Every intention may react by one sub-plan."""
        done: set[tuple[int, str]] = set()
        for intention in self._awake():
            plan = self._reacting_plan(intention, event)
            if plan is None or (id(plan.goal), plan.label) in done:
                continue  # nothing, or another branch of the same plan does
            done.add((id(plan.goal), plan.label))
            options = Options.of_the_moment([plan], self._mind.library.compiler)
            self._mind.events.append(Reaction(event.trigger, event.key, event.args, event.annots, options))
            self._reacting = True

    def _reacting_plan(self, intention: Intention, event: Event) -> Scoped | None:
        """Return the first sub-plan that applies, from the top of the stack down."""
        literal = event.literal
        for around in _of_stack(intention.stack):
            for plan in _candidates(around, event.trigger, literal):
                if applies(plan, event, self._mind.logic.trail):
                    return plan
        return None

    def _awake(self) -> list[Intention]:
        return [intention for intention in self._mind.intentions.values() if not intention.suspended]

    def _end_reactions(self) -> None:
        """Drop the reactions whose goal is over."""
        reactions = [each for each in self._mind.intentions.values() if _reaction_of(each.stack) is not None]
        self._reacting = bool(reactions) or any(isinstance(event, Reaction) for event in self._mind.events)
        for intention in reactions:
            reaction = _reaction_of(intention.stack)
            if reaction is not None and not self._is_pursued(reaction):
                self._drop(intention)

    def _is_pursued(self, reaction: Reaction) -> bool:
        """Return whether the plan around is still being carried out, perhaps by a branch of its intention."""
        goal = reaction.plan.goal
        return any(means.event is goal for each in self._mind.intentions.values() for means in each.stack)


def _of_stack(stack: Around) -> Iterator[Around]:
    """The plans with sub-plans, the top one first."""
    for height in range(len(stack), 0, -1):
        if stack[height - 1].plan.subplans is not None:
            yield stack[:height]


def _all_around(stack: Around) -> Iterator[Around]:
    """Yield the plans with sub-plans, also those around the sub-plan that this stack grew from."""
    yield from _of_stack(stack)
    reaction = _reaction_of(stack)
    if reaction is not None:
        yield from _all_around(reaction.around)


def _reaction_of(stack: Around) -> Reaction | None:
    return stack[0].event if stack and isinstance(stack[0].event, Reaction) else None


def _candidates(around: Around, trigger: Trigger, literal: Literal) -> list[Scoped]:
    return [Scoped(plan, around) for plan in around[-1].plan.subplans.options(trigger, literal.predicate)]


def _relevant(around: Around, trigger: Trigger, literal: Literal) -> list[Scoped]:
    return [plan for plan in _candidates(around, trigger, literal) if plan.concerns(literal)]
