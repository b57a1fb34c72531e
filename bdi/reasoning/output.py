"""The outcome of a cycle as it accumulates, and the trace for listeners."""

from collections.abc import Callable
from typing import NamedTuple

from bdi.debug.trace import Failed, GoalFailure, TraceEntry
from bdi.language.terms import Literal, make, show
from bdi.model.messages import Message
from bdi.reasoning.circumstance import Circumstance


class Action(NamedTuple):
    """An action that was started. Its intention (a number) waits until `Finished(id)` comes in."""

    id: int
    term: Literal
    intention: int

    def __str__(self) -> str:
        return show(self.term)


class Outcome(NamedTuple):
    """The outputs of one cycle."""

    actions: tuple[Action, ...] = ()
    cancelled: tuple[int, ...] = ()
    messages: tuple[Message, ...] = ()
    printed: tuple[str, ...] = ()
    failures: tuple[GoalFailure, ...] = ()
    trace: tuple[TraceEntry, ...] = ()


QUIET = Outcome()  # of a cycle that did nothing outside


class Output:
    """Collects what one agent does to the outside, and calls its listeners."""

    __slots__ = (
        "_entries",
        "_failures",
        "_last_message",
        "_messages",
        "_printed",
        "actions",
        "agent",
        "cancelled",
        "explains",
        "listeners",
        "reported",
    )

    def __init__(self, agent: Circumstance) -> None:
        self.agent = agent
        self.listeners: list[Callable[[TraceEntry], None]] = []
        self.explains = False  # whether a listener wants to hear why
        self._last_message = 0
        self._reset()

    def say(self, line: str) -> None:
        """.print"""
        self._printed.append(line)
        self.reported = True

    def send(self, message: Message) -> None:
        """.send"""
        self._messages.append(message)
        self.reported = True

    def new_message_id(self) -> str:
        self._last_message += 1
        return f"{self.agent.name}-{self._last_message}"

    def report(self, failure: GoalFailure) -> None:
        self._failures.append(failure)
        self.agent.given_up.append(failure)
        self.reported = True
        if self.listeners:
            self.trace(Failed(self.agent.cycles, *failure))

    def trace(self, entry: TraceEntry) -> None:
        self._entries.append(entry)
        self.reported = True
        for listener in self.listeners:
            listener(entry)

    def _reset(self) -> None:
        self.reported = False
        self.actions: list[Action] = []
        self.cancelled: list[int] = []
        self._messages: list[Message] = []
        self._printed: list[str] = []
        self._failures: list[GoalFailure] = []
        self._entries: list[TraceEntry] = []

    def take(self) -> Outcome:
        """Return the outcome of the cycle and begin the next one."""
        if self.reported:
            outcome = Outcome(
                tuple(self.actions),
                tuple(self.cancelled),
                tuple(self._messages),
                tuple(self._printed),
                tuple(self._failures),
                tuple(self._entries),
            )
            self._reset()
            return outcome
        actions, self.actions = tuple(self.actions), []
        return make(Outcome, (actions, (), (), (), (), ()))

    def cancel(self, action: int) -> None:
        """Tell the body that an action is no longer wanted."""
        self.cancelled.append(action)
        self.reported = True

    # ---- listeners -------------------------------------------------------------------------------------------------

    def listen(self, callback: Callable[[TraceEntry], None], explain: bool) -> None:
        self.listeners.append(callback)
        self.explains = self.explains or explain

    def stop_listening(self, callback: Callable[[TraceEntry], None]) -> None:
        self.listeners.remove(callback)
        if not self.listeners:
            self.explains = False
            self.agent.choices.clear()
