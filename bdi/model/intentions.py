"""Events, and intentions: stacks of plans that are being carried out."""

from collections.abc import Callable, Sequence
from enum import Enum
from typing import Any

from bdi.language.arithmetic import ArithmeticFailure
from bdi.language.errors import AgentSpeakError, BdiError
from bdi.language.syntax import Trigger
from bdi.language.terms import Literal, Predicate, Term, Var, literal_of, show
from bdi.language.unify import resolve, resolve_all


class State(Enum):
    """The states of an intention."""

    RUNNING = "is running"
    ACTION = "waits for an action"
    EVENT = "waits until a plan is chosen"
    TIME = "waits for a moment"
    ANSWER = "waits for an answer"
    CONDITION = "waits until its goal condition holds"
    SUSPENDED = "is suspended"
    DONE = "is done"


# By themselves for what runs in every cycle, as in `syntax`.
RUNNING, WAITS_FOR_ACTION, WAITS_FOR_EVENT = State.RUNNING, State.ACTION, State.EVENT


class Step:
    """One compiled step of a plan body. `run(intention, means)`; `next` is the step after it, None at the end."""

    __slots__ = ("next", "run", "source")

    def __init__(self, run: Callable[..., None], source: Any, following: "Step | None") -> None:
        self.run = run
        self.source = source
        self.next = following

    def runs(self, run: Callable[..., None]) -> None:
        """Take the function, now that it has been compiled (again)."""
        self.run = run


class Event:
    """Something a plan could react to. With an `intention`, that one waits for the outcome (an internal event)."""

    __slots__ = ("__weakref__", "annots", "args", "intention", "key", "options", "returns", "trigger")
    under = 0  # height of the stack that a failure plan is put on
    of_atomic = False  # whether it is the failure of an atomic plan

    def __init__(
        self,
        trigger: Trigger,
        key: Predicate,
        args: tuple[Term, ...],
        annots: tuple[Term, ...],
        options: Any,
        intention: "Intention | None" = None,
        returns: tuple[tuple[Var, Var], ...] = (),
    ) -> None:
        self.trigger = trigger
        self.key = key
        self.args = args
        self.annots = annots
        self.options = options  # the plans filed under trigger and predicate
        self.intention = intention
        self.returns = returns  # variable of the caller, variable of this event that it gets its value from

    @property
    def around(self) -> "Sequence[Means]":
        """The plan that a reacting sub-plan stands in, on top of those that led there."""
        return ()

    @property
    def literal(self) -> Literal:
        return literal_of(self.key, resolve_all(self.args), resolve_all(self.annots))

    @property
    def plain(self) -> str:
        """Return the literal of the event without annotations."""
        return show(literal_of(self.key, resolve_all(self.args)))

    def __str__(self) -> str:
        try:
            return f"{self.trigger}{self.plain}"
        except RecursionError:  # an argument has become a part of itself
            return f"{self.trigger}{self.key}"


def event_of(trigger: Trigger, literal: Literal, options: Any, intention: "Intention | None" = None) -> Event:
    """The event about this literal."""
    return Event(trigger, literal.predicate, literal.args, literal.annots, options, intention)


class FailureEvent(Event):
    """A failed goal; the plan that takes care of it goes where the failed plan was."""

    __slots__ = ("of_atomic", "under")


class Means:
    """A plan that is being carried out: its variables, its next step, and the event that it answers."""

    __slots__ = ("event", "frame", "level", "loops", "plan", "step")

    def __init__(self, plan: Any, frame: list[Any], event: Event) -> None:
        self.plan = plan
        self.frame = frame
        self.event = event
        self.step: Step | None = plan.first
        self.level: int | None = None  # how urgent it is, where the program states priorities
        self.loops: tuple[Any, ...] = ()  # what running `for` and `while` loops have to remember

    @property
    def holds_agent(self) -> bool:
        """Return whether it is not interleaved with others: an atomic plan, or one that takes care of its failure."""
        return self.plan.atomic or self.event.of_atomic


class Intention:
    """A stack of means; the top one runs."""

    __slots__ = (
        "action",
        "atomic",
        "fork",
        "guarded",
        "last",
        "number",
        "stack",
        "state",
        "suspended",
        "suspended_by",
        "waits_for",
    )

    def __init__(self, number: int) -> None:
        self.number = number
        self.stack: list[Means] = []
        self.state = State.RUNNING
        self.suspended = False  # suspended by .suspend: keeps its state, takes no steps
        self.suspended_by = ""  # the plan that suspended it
        self.action: int | None = None  # id of the started action it waits for
        self.waits_for: Any = None  # moment or message id, by state
        self.atomic = False
        self.guarded = False  # whether one of its plans has a goal condition
        self.fork: Fork | None = None
        self.last: Step | None = None  # that it took

    def is_beside(self, other: "Intention") -> bool:
        """Return whether both are branches of one intention, or the same."""
        if self.fork is None or other.fork is None:
            return self is other
        return self.fork.outermost() is other.fork.outermost()

    def goals(self) -> list[Literal]:
        """The achievement and test goals it pursues, the first cause first."""
        return [means.event.literal for means in self.stack if means.event.trigger in GOALS]

    def __str__(self) -> str:
        return f"intention {self.number} ({' > '.join(str(means.event) for means in self.stack)})"


class Fork:
    """Branches `a |&| b` or `a ||| b` of one intention, each run as an intention of its own, or forked again."""

    __slots__ = ("branches", "frames", "height", "outer", "wait_for_all")

    def __init__(self, wait_for_all: bool, height: int, outer: "Fork | None") -> None:
        self.wait_for_all = wait_for_all
        self.branches: list[Intention | Fork] = []
        self.frames: list[list[Any]] = []  # of the branches that are done
        self.height = height  # of the stack where the fork is: failing below it fails all branches
        self.outer = outer

    def intentions(self) -> "list[Intention]":
        """Return all that run for it, those of inner forks too."""
        found: list[Intention] = []
        for branch in self.branches:
            found += branch.intentions() if isinstance(branch, Fork) else [branch]
        return found

    def outermost(self) -> "Fork":
        return self if self.outer is None else self.outer.outermost()

    def give_place(self, new: "Intention | Fork") -> None:
        """Replace this fork in the one around it."""
        if self.outer is not None:
            branches = self.outer.branches
            branches[branches.index(self)] = new


def branches_of(intention: Intention) -> list[Intention]:
    """The intention, with the branches that run beside it."""
    return [intention] if intention.fork is None else intention.fork.outermost().intentions()


GOALS = frozenset({Trigger.GOAL_ADDED, Trigger.TEST_ADDED, Trigger.GOAL_FAILED, Trigger.TEST_FAILED})
FAILURE_OF = {Trigger.GOAL_ADDED: Trigger.GOAL_FAILED, Trigger.TEST_ADDED: Trigger.TEST_FAILED}


class StepFailed(BdiError):
    """A step of a plan cannot be done: `error` names the kind (`no_applicable`, `test_goal_failed`, …)."""

    def __init__(self, error: str, message: str, annots: tuple[Term, ...] = ()) -> None:
        super().__init__(message)
        self.error = error
        self.message = message
        self.annots = annots


# A condition that runs into one of these does not hold.
NOT_WORKED_OUT = (ArithmeticFailure, StepFailed, AgentSpeakError, RecursionError)


def answered(returns: tuple[tuple[Var, Var], ...]) -> StepFailed | None:
    """The caller's variables get what the goal has found out; or that is nothing that could be worked out."""
    try:
        for outer, inner in returns:
            value = resolve(inner)
            if value is not outer and outer.ref is None:
                outer.ref = value
    except ArithmeticFailure as problem:
        return StepFailed("arithmetic", str(problem))
    except RecursionError:
        return StepFailed("recursion", "an answer goes too deep")
    return None
