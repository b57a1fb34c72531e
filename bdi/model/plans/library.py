"""The plans of an agent, found by trigger and predicate."""

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any, Protocol

from bdi.language.syntax import Plan, Trigger, variables_of
from bdi.language.terms import (
    ANNOTATED,
    IN_SPACE,
    PRIVATE_SPACE,
    Atom,
    Literal,
    Predicate,
    Structure,
    Var,
    plain,
    space_of,
)
from bdi.language.unify import Trail, renamed, undo, unify
from bdi.model.intentions import NOT_WORKED_OUT, Event, Step
from bdi.model.logic import Frame

Applicable = Callable[[Any], "Frame | None"]  # the event (of a sub-plan: with the values around) → the filled frame


class PlanCompiler(Protocol):
    def compile(self, plan: "CompiledPlan", forget: Callable[[], None]) -> Applicable: ...
    def choice(self, options: "Options", forget: Callable[[], None]) -> "Choose": ...
    def choose_one_by_one(self, options: "Options", event: Event) -> "tuple[CompiledPlan, Frame] | None": ...


class CompiledPlan:
    """A plan of one agent. Compiled when it is first considered."""

    __slots__ = (
        "__weakref__",
        "_compiler",
        "applicable",
        "around",
        "atomic",
        "condition",
        "first",
        "is_special",
        "label",
        "makes_room",
        "places",
        "plan",
        "subplans",
    )

    def __init__(self, plan: Plan, compiler: PlanCompiler, outer: frozenset[str] = frozenset()) -> None:
        self.plan = plan
        self.label = str(plan.label.predicate)
        self.atomic = plan.has("atomic")
        self.makes_room = plan.trigger in (Trigger.GOAL_ADDED, Trigger.GOAL_FAILED) and not self.atomic
        self.is_special = self.atomic or plan.condition is not None
        self.applicable: Applicable = self._compile_then_apply
        self.first: Step | None = None
        self.condition: Callable[[Frame], bool] | None = None
        self.around = tuple(_meant(plan, outer)) if outer else ()  # the variables around that it means
        self.places: dict[str, int] = {}  # in the frame, by name: for its sub-plans
        self.subplans = Library(compiler, plan.subplans, self._names()) if plan.subplans else None
        self._compiler = compiler

    def _compile_then_apply(self, event: Event) -> Frame | None:
        self.applicable = self._compiler.compile(self, self.forget_compiled)
        return self.applicable(event)

    def forget_compiled(self) -> None:
        """Compile the context again: its assumptions have changed."""
        self.applicable = self._compile_then_apply

    def _names(self) -> frozenset[str]:
        """Return the names of the variables that its sub-plans may use."""
        return frozenset(each.name for each in (*variables_of(self.plan), *self.around) if each.name != "_")

    def as_seen(self) -> Plan:
        """The plan as written; of a sub-plan, with the values of the variables around it."""
        return self.plan

    def concerns(self, literal: Literal) -> bool:
        """Return whether the head unifies: then the plan is relevant."""
        trail: Trail = []
        try:
            return unify(self.plan.head, renamed(literal, {}), trail)
        except NOT_WORKED_OUT:
            return False
        finally:
            undo(trail, 0)


class Options(list[CompiledPlan]):
    """Plans in source order. `choose(event)` is the first that applies, with its frame; or None."""

    __slots__ = ("__weakref__", "_compiler", "_parts", "choose")

    def __init__(self, plans: Iterable[CompiledPlan], compiler: PlanCompiler) -> None:
        super().__init__(plans)
        self._compiler = compiler
        self._parts: dict[tuple[int | CompiledPlan, ...], Options] = {}
        self.choose: Choose = self._compile_then_choose

    @staticmethod
    def of_the_moment(plans: Iterable[CompiledPlan], compiler: PlanCompiler) -> "Options":
        """Make options for one event: not worth compiling together."""
        options = Options(plans, compiler)
        options.choose = partial(compiler.choose_one_by_one, options)
        return options

    def _compile_then_choose(self, event: Event) -> "tuple[CompiledPlan, Frame] | None":
        self.choose = self._compiler.choice(self, self.changed)
        return self.choose(event)

    def changed(self) -> None:
        """Plans have come or gone, or what their contexts were compiled with has changed."""
        self.choose = self._compile_then_choose
        self._parts.clear()

    def part(self, places: tuple[int, ...]) -> "Options":
        """The plans at these places; the same list every time, so that it is compiled once."""
        found = self._parts.get(places)
        if found is None:
            found = self._parts[places] = Options([self[place] for place in places], self._compiler)
        return found

    def followed_by(self, last: CompiledPlan) -> "Options":
        """These, then one more; the same list every time."""
        found = self._parts.get((last,))
        if found is None:
            found = self._parts[last,] = Options([*self, last], self._compiler)
        return found


Choose = Callable[[Event], "tuple[CompiledPlan, Frame] | None"]


def _meant(plan: Plan, outer: frozenset[str]) -> Iterable[Var]:
    """Which variables around it a sub-plan means, by name, or the sub-plans in it."""
    found = {each.name: each for inner in plan.subplans for each in _meant(inner, outer)}
    return (found | {each.name: each for each in variables_of(plan) if each.name in outer}).values()


def relevant(options: Options, literal: Literal) -> Options:
    """Return the plans whose head unifies with the event; if all do, the list itself, which is kept up to date."""
    places = tuple([place for place, plan in enumerate(options) if plan.concerns(literal)])
    return options if len(places) == len(options) else options.part(places)


def applies(plan: CompiledPlan, event: Event, trail: Trail) -> bool:
    """Return whether the plan could be taken; nothing stays bound."""
    try:
        return plan.applicable(event) is not None
    except NOT_WORKED_OUT:
        return False
    finally:
        undo(trail, 0)


class Library:
    """Plans by trigger and predicate, each list in source order. A list, once handed out, is kept up to date."""

    def __init__(
        self, compiler: PlanCompiler, plans: tuple[Plan, ...] = (), outer: frozenset[str] = frozenset()
    ) -> None:
        self.compiler = compiler
        self._outer = outer  # names of variables around sub-plans
        self.plans: list[CompiledPlan] = []
        self._options: dict[tuple[Trigger, Predicate], Options] = {}
        for plan in plans:
            self.add(plan)

    def options(self, trigger: Trigger, key: Predicate) -> Options:
        """The plans that could react: those with this predicate, and those whose trigger is a variable."""
        found = self._options.get((trigger, key))
        if found is None:
            plans = [plan for plan in self.plans if _reacts(plan.plan, trigger, key)]
            found = self._options[trigger, key] = Options(plans, self.compiler)
        return found

    def add(self, plan: Plan, first: bool = False) -> CompiledPlan:
        compiled = CompiledPlan(plan, self.compiler, self._outer)
        for plans in (self.plans, *self._options_with(plan)):
            plans.insert(0 if first else len(plans), compiled)
            if isinstance(plans, Options):
                plans.changed()
        return compiled

    def remove(self, label: str) -> bool:
        """Return whether there was a plan with this label."""
        doomed = [plan for plan in self.plans if plan.label == label]
        for plan in doomed:
            for plans in (self.plans, *self._options_with(plan.plan)):
                plans.remove(plan)
                if isinstance(plans, Options):
                    plans.changed()
        return bool(doomed)

    def _options_with(self, plan: Plan) -> list[Options]:
        return [found for (trigger, key), found in self._options.items() if _reacts(plan, trigger, key)]


def _reacts(plan: Plan, trigger: Trigger, key: Predicate) -> bool:
    if plan.trigger is not trigger:
        return False
    return isinstance(plan.head, Var) or plan.head.predicate is key or _names_in_space(plan.head, key)


def _names_in_space(head: Literal, key: Predicate) -> bool:
    """Return whether `+NS::p(X)` or `+n::X` is about events like these."""
    if head.predicate is not IN_SPACE:
        return False
    space, inner = head.args
    if isinstance(inner, Structure) and inner.predicate is ANNOTATED:
        inner = inner.args[0]
    if isinstance(inner, Atom | Structure) and inner.predicate is not plain(key):
        return False
    return space is space_of(key) if isinstance(space, Atom) else not key.namespace.startswith(PRIVATE_SPACE)
