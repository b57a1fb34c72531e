"""The others, as one agent sees them: whom it can write to, create, kill, and what it can look up about them."""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple, NoReturn, Protocol

from bdi.language.terms import Literal, Term
from bdi.model.intentions import Intention, StepFailed
from bdi.model.messages import Message


class Reader(Protocol):
    """Whoever gets a message."""

    def read(self, message: Message) -> Any:
        """Raises UnknownPerformative, AgentSpeakSyntaxError, NotALiteral."""


class Society(Protocol):
    """What an agent can ask of those it lives with. Whatever cannot be done raises StepFailed."""

    def names(self) -> Sequence[str]:
        """All agents, in the order in which they joined."""

    def readers(self, receiver: str, sender: str) -> Sequence[Reader]:
        """Who would read a message to this name (`*`: to everybody); nobody for one outside. Raises StepFailed."""

    def create(self, name: str, source: str, beliefs: Iterable[Literal], goals: Iterable[Literal]) -> str:
        """A new agent; its name, which differs if the wanted one is taken."""

    def clone(self, original: str, name: str) -> str: ...
    def kill(self, name: str) -> bool:
        """False: there is none of this name."""

    def stop(self, at_s: float, exit_code: int) -> None: ...
    def save(self, target: str, agent: str, goals: Iterable[Literal]) -> None: ...

    # the directory facilitator
    def register(self, agent: str, service: str, kind: str) -> None: ...
    def deregister(self, agent: str, service: str, kind: str) -> None: ...
    def search(self, service: str, kind: str) -> Sequence[str]: ...
    def subscribe(self, agent: str, service: str, kind: str) -> None: ...


class Alone:
    """The society of an agent that lives by itself: it can write to whoever the caller knows, and nothing else."""

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
