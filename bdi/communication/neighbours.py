"""A system of several agents as each of them sees it: a `Society`."""

from collections.abc import Callable, Iterable, Sequence
from typing import Protocol

from bdi.communication.directory import Directory
from bdi.communication.mailboxes import Mailboxes
from bdi.communication.saving import text_of
from bdi.language.errors import AgentSpeakError
from bdi.language.syntax import Program
from bdi.language.terms import Literal, atom, structure
from bdi.model.intentions import StepFailed
from bdi.model.messages import EVERYBODY
from bdi.model.society import Reader
from bdi.reasoning.agent import Agent

Load = Callable[[str], Program]  # the program that `.create_agent` names
Save = Callable[[str, str], None]  # where to, and the text of the agent: `.save_agent`


class System(Protocol):
    """The interface of `MultiAgentSystem` for its agents."""

    load: Load | None
    save: Save | None
    mailboxes: Mailboxes
    directory: Directory

    @property
    def agents(self) -> dict[str, Agent]: ...
    def create(self, name: str, program: Program, beliefs: Iterable[Literal], goals: Iterable[Literal]) -> Agent: ...
    def clone(self, original: str, name: str) -> Agent: ...
    def kill(self, name: str) -> bool: ...
    def stop(self, at_s: float, exit_code: int) -> None: ...


class Neighbours:
    """The system as its agents see it: a `Society`."""

    def __init__(self, system: System) -> None:
        self._system = system

    def names(self) -> Sequence[str]:
        return list(self._system.agents)

    def readers(self, receiver: str, sender: str) -> Sequence[Reader]:
        agents = self._system.agents
        if receiver == EVERYBODY:
            return [agent.message_handling for name, agent in agents.items() if name != sender]
        if receiver in agents:
            return [agents[receiver].message_handling]
        if receiver in self._system.mailboxes.outside:
            return ()
        raise _unknown_receiver(receiver, self.names())

    def create(self, name: str, source: str, beliefs: Iterable[Literal], goals: Iterable[Literal]) -> str:
        """Without a source the agent has an empty program."""
        load = self._system.load
        if load is None and source:
            raise StepFailed("no_loader", "this system was given no way to load programs: give it load=")
        try:
            program = load(source) if load is not None and source else Program(name)
            return self._system.create(name, program, beliefs, goals).name
        except (AgentSpeakError, OSError) as problem:
            raise StepFailed("program_not_loaded", f"{source}: {problem}") from problem

    def clone(self, original: str, name: str) -> str:
        return self._system.clone(original, name).name

    def kill(self, name: str) -> bool:
        return self._system.kill(name)

    def stop(self, at_s: float, exit_code: int) -> None:
        self._system.stop(at_s, exit_code)

    def save(self, target: str, agent: str, goals: Iterable[Literal]) -> None:
        save = self._system.save
        if save is None:
            raise StepFailed("no_saver", "this system was given no way to save programs: give it save=")
        try:
            save(target, text_of(self._system.agents[agent], goals))
        except OSError as problem:
            raise StepFailed("program_not_saved", f"{target}: {problem}") from problem

    def register(self, agent: str, service: str, kind: str) -> None:
        self._system.mailboxes.deliver_all(self._system.directory.register(agent, service, kind))

    def deregister(self, agent: str, service: str, kind: str) -> None:
        self._system.mailboxes.deliver_all(self._system.directory.deregister(agent, service, kind))

    def search(self, service: str, kind: str) -> Sequence[str]:
        return self._system.directory.search(service, kind)

    def subscribe(self, agent: str, service: str, kind: str) -> None:
        self._system.mailboxes.deliver_all(self._system.directory.subscribe(agent, service, kind))


def _unknown_receiver(receiver: str, names: Sequence[str]) -> StepFailed:
    known = ", ".join(names)
    annots = (structure("receiver", atom(receiver)),)
    return StepFailed("unknown_receiver", f"there is no agent {receiver}; there are {known}", annots)
