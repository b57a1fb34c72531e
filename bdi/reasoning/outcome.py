"""What one cycle did to the outside."""

from typing import NamedTuple

from bdi.debug.trace import TraceEntry
from bdi.language.terms import Literal, show
from bdi.model.messages import Message


class Action(NamedTuple):
    """An action that was started. Its intention (a number) waits until `Finished(id)` comes in."""

    id: int
    term: Literal
    intention: int

    def __str__(self) -> str:
        return show(self.term)


class GoalFailure(NamedTuple):
    """A goal that no plan could rescue: its intention was dropped."""

    goal: str
    error: str
    message: str

    def __str__(self) -> str:
        return f"{self.goal}: {self.error} ({self.message})"


class Outcome(NamedTuple):
    """What one cycle did to the outside."""

    actions: tuple[Action, ...] = ()
    cancelled: tuple[int, ...] = ()
    messages: tuple[Message, ...] = ()
    printed: tuple[str, ...] = ()
    failures: tuple[GoalFailure, ...] = ()
    trace: tuple[TraceEntry, ...] = ()


QUIET = Outcome()  # of a cycle that did nothing outside
