"""What the agent is busy with: events to react to, and intentions, each a stack of half-done plans."""

from collections.abc import Callable
from enum import Enum
from typing import Any

from bdi.arithmetic import ArithmeticFailure
from bdi.errors import AgentSpeakError, BdiError
from bdi.syntax import Trigger
from bdi.terms import Literal, Term, Var, literal_of, show
from bdi.unify import resolve_all


class State(Enum):
    """Why an intention does or does not go on."""

    RUNNING = "is running"
    ACTION = "waits for an action"
    EVENT = "waits until a plan is chosen"
    TIME = "waits for a moment"
    ANSWER = "waits for an answer"
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


class Event:
    """Something a plan could react to. With an `intention`, that one waits for the outcome (an internal event)."""

    __slots__ = ("annots", "args", "intention", "key", "options", "returns", "trigger", "under")

    def __init__(
        self,
        trigger: Trigger,
        literal: Literal,
        options: Any,
        intention: "Intention | None" = None,
        *,
        returns: tuple[tuple[Var, Var], ...] = (),
        under: int = 0,
    ) -> None:
        self.trigger = trigger
        self.key = literal.predicate
        self.args = literal.args
        self.annots = literal.annots
        self.options = options  # the plans filed under trigger and predicate
        self.intention = intention
        self.returns = returns  # variable of the caller, variable of this event that it gets its value from
        self.under = under  # height of the stack that a failure plan is put on

    @property
    def literal(self) -> Literal:
        return literal_of(self.key, resolve_all(self.args), resolve_all(self.annots))

    @property
    def plain(self) -> str:
        """What it is about, as people read it: without annotations."""
        return show(literal_of(self.key, resolve_all(self.args)))

    def __str__(self) -> str:
        return f"{self.trigger}{self.plain}"


class Means:
    """A plan that is being carried out: its variables, its next step, and the event that it answers."""

    __slots__ = ("event", "frame", "loops", "plan", "step")

    def __init__(self, plan: Any, frame: list[Any], event: Event) -> None:
        self.plan = plan
        self.frame = frame
        self.event = event
        self.step: Step | None = plan.first
        self.loops: list[Any] = []  # what running `for` and `while` loops have to remember


class Intention:
    """A stack of means; the top one runs."""

    __slots__ = ("action", "atomic", "fork", "guarded", "held", "number", "stack", "state", "waits_for")

    def __init__(self, number: int) -> None:
        self.number = number
        self.stack: list[Means] = []
        self.state = State.RUNNING
        self.held = False  # suspended by .suspend: keeps its state, takes no steps
        self.action: int | None = None  # id of the started action it waits for
        self.waits_for: Any = None  # moment or message id, by state
        self.atomic = False
        self.guarded = False  # whether one of its plans has a goal condition
        self.fork: Fork | None = None

    def goals(self) -> list[Literal]:
        """The achievement and test goals it pursues, the first cause first."""
        return [means.event.literal for means in self.stack if means.event.trigger in GOALS]

    def __str__(self) -> str:
        return f"intention {self.number} ({' > '.join(str(means.event) for means in self.stack)})"


class Fork:
    """Branches `a |&| b` or `a ||| b` of one intention, each run as an intention of its own."""

    __slots__ = ("branches", "height", "outer", "wait_for_all")

    def __init__(self, wait_for_all: bool, height: int, outer: "Fork | None") -> None:
        self.wait_for_all = wait_for_all
        self.branches: list[Intention] = []
        self.height = height  # of the stack where the fork is: failing below it fails all branches
        self.outer = outer


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
