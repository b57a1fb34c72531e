"""What an agent tells the outside: the outcome of a cycle as it comes together, and the trace for those who listen."""

from collections import deque
from collections.abc import Callable

from bdi.debug.trace import Deliberated, Failed, TraceEntry
from bdi.language.terms import make
from bdi.model.messages import Message
from bdi.reasoning.outcome import Action, GoalFailure, Outcome

REMEMBERED = 50  # goals that were given up, and choices: what `why` looks back on


class Telling:
    """An agent with a name that has something to say."""

    __slots__ = (
        "_actions",
        "_cancelled",
        "_entries",
        "_explains",
        "_failures",
        "_last_message",
        "_listeners",
        "_messages",
        "_printed",
        "_reported",
        "choices",
        "cycles",
        "given_up",
        "name",
    )

    def __init__(self, name: str) -> None:
        self.name = name
        self.cycles = 0
        self._last_message = 0
        self._listeners: list[Callable[[TraceEntry], None]] = []
        self._explains = False  # whether a listener wants to hear why
        self.choices: deque[Deliberated] = deque(maxlen=REMEMBERED)  # while somebody listens
        self.given_up: deque[GoalFailure] = deque(maxlen=REMEMBERED)
        self._reset_outcome()

    def say(self, line: str) -> None:
        """.print"""
        self._printed.append(line)
        self._reported = True

    def send(self, message: Message) -> None:
        """.send"""
        self._messages.append(message)
        self._reported = True

    def new_message_id(self) -> str:
        self._last_message += 1
        return f"{self.name}-{self._last_message}"

    def _report(self, failure: GoalFailure) -> None:
        self._failures.append(failure)
        self.given_up.append(failure)
        self._reported = True
        if self._listeners:
            self._trace(Failed(self.cycles, *failure))

    def _trace(self, entry: TraceEntry) -> None:
        self._entries.append(entry)
        self._reported = True
        for listener in self._listeners:
            listener(entry)

    def _reset_outcome(self) -> None:
        self._reported = False
        self._actions: list[Action] = []
        self._cancelled: list[int] = []
        self._messages: list[Message] = []
        self._printed: list[str] = []
        self._failures: list[GoalFailure] = []
        self._entries: list[TraceEntry] = []

    def _take_actions(self) -> Outcome:
        """The outcome of a cycle that did nothing but start actions."""
        actions = tuple(self._actions)
        self._actions = []
        return make(Outcome, (actions, (), (), (), (), ()))

    def _take_outcome(self) -> Outcome:
        outcome = Outcome(
            tuple(self._actions),
            tuple(self._cancelled),
            tuple(self._messages),
            tuple(self._printed),
            tuple(self._failures),
            tuple(self._entries),
        )
        self._reset_outcome()
        return outcome
