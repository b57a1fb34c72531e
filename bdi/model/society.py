"""The other agents as one agent sees them: it can send to them, create, kill and look them up."""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple, NoReturn, Protocol

from bdi.language.terms import Literal, Term
from bdi.model.intentions import Intention, StepFailed
from bdi.model.messages import Message


class Reader(Protocol):
    """A receiver of messages."""

    def read(self, message: Message) -> Any:
        """Raises UnknownPerformative, AgentSpeakSyntaxError, NotALiteral."""


class Society(Protocol):
    """The services of a multi-agent system for one agent. A request that fails raises StepFailed."""

    def names(self) -> Sequence[str]:
        """Return all agents, in the order in which they joined."""

    def readers(self, receiver: str, sender: str) -> Sequence[Reader]:
        """Return the receivers of a message to this name (`*`: a broadcast); none outside. Raises StepFailed."""

    def create(self, name: str, source: str, beliefs: Iterable[Literal], goals: Iterable[Literal]) -> str:
        """A new agent; its name, which differs if the wanted one is taken."""

    def clone(self, original: str, name: str) -> str: ...
    def kill(self, name: str) -> bool:
        """Remove an agent. Return False if there is none of this name."""

    def stop(self, at_s: float, exit_code: int) -> None: ...
    def save(self, target: str, agent: str, goals: Iterable[Literal]) -> None: ...

    # the directory facilitator
    def register(self, agent: str, service: str, kind: str) -> None: ...
    def deregister(self, agent: str, service: str, kind: str) -> None: ...
    def search(self, service: str, kind: str) -> Sequence[str]: ...
    def subscribe(self, agent: str, service: str, kind: str) -> None: ...


class Alone:
    """The society of a single agent: its messages go to the caller, and nothing else works."""

    def readers(self, receiver: str, sender: str) -> Sequence[Reader]:
        return ()

    def _fail(self, *_: object) -> NoReturn:
        raise StepFailed("alone", "this agent lives alone: it needs a MultiAgentSystem around it for this")

    names = create = clone = kill = stop = save = register = deregister = search = subscribe = _fail


ALONE: Society = Alone()


class Asked(NamedTuple):
    """A question whose answer an intention waits for, until `deadline_s` (None: for ever)."""

    intention: Intention
    pattern: Term
    deadline_s: float | None
    receivers: frozenset[str]  # who may still answer
