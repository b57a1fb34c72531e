"""Several agents in one process.

    agents = [Agent(load_program("manager.asl"), name="manager"), Agent(load_program("bidder.asl"), name="bidder")]
    system = MultiAgentSystem(agents, load=load_program)
    while not (system.idle or system.stopped):
        outcomes = system.round({"manager": Stimuli(percepts={"order(1)"})}, now)

In a round every agent has one cycle, in the order in which they joined. What is sent in a round is read from the next
one on, in the order in which it was sent; agents that are created in a round run from the next one on. So equal inputs
give equal runs. Nothing here knows a clock, a thread or a file.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from bdi.communication.directory import Directory
from bdi.communication.mailboxes import Mailboxes
from bdi.communication.neighbours import Load, Neighbours, Save
from bdi.communication.saving import copy_beliefs, program_of
from bdi.language.errors import BdiError, DuplicateAgent, Place, UnknownAgent
from bdi.language.syntax import Belief, Goal, Program
from bdi.language.terms import Literal, Term
from bdi.model.messages import Finished, Message
from bdi.model.society import ALONE
from bdi.reasoning.agent import Agent
from bdi.reasoning.output import QUIET, Outcome

Make = Callable[[Program, str], Agent]  # an agent of this program and name, with the actions and the seed of the caller


@dataclass(frozen=True, slots=True)
class Stimuli:
    """The input of one agent in one round, as `Agent.cycle` takes it."""

    percepts: Iterable[Term | str] | None = None
    messages: Sequence[Message] = ()
    finished: Sequence[Finished] = ()


NOTHING_NEW = Stimuli()


@dataclass(slots=True)
class _Member:
    agent: Agent
    started: set[int] = field(default_factory=set)  # actions that are not over


class MultiAgentSystem:
    """Agents by name, and the messages between them.

    `load` reads the programs of `.create_agent`, `make` makes agents of them, `save` takes what `.save_agent` writes;
    without one of them the internal action fails by name. `outside` names receivers outside the system
    (every outside sender is added): messages to them stay in the outcomes.
    """

    def __init__(
        self,
        agents: Iterable[Agent] = (),
        load: Load | None = None,
        make: Make = Agent,
        save: Save | None = None,
        outside: Iterable[str] = (),
    ) -> None:
        self.rounds = 0
        self.now = 0.0
        self.exit_code: int | None = None
        self.traffic: tuple[Message, ...] = ()
        """What the agents sent in the last round, in order; broadcasts once for every receiver."""
        self.undelivered: tuple[Message, ...] = ()
        """Messages that were not read since the last round: their receiver was killed, or no longer understood them."""
        self.load, self._make, self.save = load, make, save
        self.mailboxes = Mailboxes(outside)
        self._members: dict[str, _Member] = {}
        self._killed: dict[str, _Member] = {}
        self._stop_at_s: float | None = None
        self.directory = Directory()
        for agent in agents:
            self.add(agent)

    # ---- who is there ----------------------------------------------------------------------------------------------

    @property
    def agents(self) -> dict[str, Agent]:
        """The living agents, in the order in which they joined."""
        return {name: member.agent for name, member in self._members.items()}

    def add(self, agent: Agent) -> None:
        """Let an agent join; it runs from the next round on. Raises DuplicateAgent."""
        if agent.name in self._members:
            raise DuplicateAgent(agent.name)
        agent.society = Neighbours(self)
        self._members[agent.name] = _Member(agent)
        self.mailboxes.open_inbox(agent.name)

    def free_name(self, wanted: str) -> str:
        """The name itself, or with _2, _3, … if it is taken."""
        name, count = wanted, 1
        while name in self._members or name in self._killed:
            count += 1
            name = f"{wanted}_{count}"
        return name

    def kill(self, name: str) -> bool:
        """Remove the agent: it has no more cycles. Agents that wait for its answer are notified that none will come.

        False: there is none of this name.
        """
        member = self._members.pop(name, None)
        if member is None:
            return False
        member.agent.society = ALONE
        self._killed[name] = member
        self.mailboxes.close_inbox(name)
        self.mailboxes.deliver_all(self.directory.forget(name))
        for other in self._members.values():
            for question in other.agent.message_handling.questions_to(name):
                self.mailboxes.deliver(Message(name, "sorry", "dead", other.agent.name, reply_to=question))
        return True

    def create(
        self, name: str, program: Program, beliefs: Iterable[Literal] = (), goals: Iterable[Literal] = ()
    ) -> Agent:
        """A new agent of this program, with further initial beliefs and goals. Its name may differ: see `free_name`."""
        here = Place(name)
        program = replace(
            program,
            beliefs=(*program.beliefs, *(Belief(each, here) for each in beliefs)),
            goals=(*program.goals, *(Goal(each, here) for each in goals)),
        )
        agent = self._make(program, self.free_name(name))
        self.add(agent)
        return agent

    def clone(self, original: str, name: str) -> Agent:
        """An agent with the beliefs, rules and plans of another, but without its goals and intentions.

        Raises UnknownAgent.
        """
        source = self._member(original).agent
        agent = self.create(name, program_of(source))
        copy_beliefs(source, agent)
        return agent

    # ---- a round ---------------------------------------------------------------------------------------------------

    def round(self, stimuli: Mapping[str, Stimuli] | None = None, now: float = 0.0) -> dict[str, Outcome]:
        """One cycle of every agent: what each did to the outside, by name. Killed ones cancel their actions.

        Raises UnknownAgent, and what `Agent.cycle` raises; then no agent has had a cycle.
        """
        stimuli = self._checked(stimuli or {})
        self.now = now
        self.rounds += 1
        turns = [(name, member, self.mailboxes.take(name)) for name, member in self._members.items()]
        outcomes: dict[str, Outcome] = {}
        for name, member, inbox in turns:
            if name in self._killed:
                self.mailboxes.lost += inbox
            else:
                outcomes[name] = self._cycle(member, inbox, stimuli.get(name, NOTHING_NEW))
        for name, member in self._killed.items():
            outcome = outcomes.get(name, QUIET)
            outcomes[name] = outcome._replace(cancelled=(*outcome.cancelled, *sorted(member.started)))
        self._killed = {}
        self.traffic, self.undelivered = tuple(self.mailboxes.sent), tuple(self.mailboxes.lost)
        self.mailboxes.sent, self.mailboxes.lost = [], []
        return outcomes

    @property
    def idle(self) -> bool:
        """Return whether no agent has anything left to do until something comes in from outside."""
        agents = self.agents.values()
        return not self._killed and self.mailboxes.is_empty and all(agent.idle for agent in agents)

    @property
    def stopped(self) -> bool:
        """Return whether an agent said `.stopMAS`, and the time that it gave is over."""
        return self._stop_at_s is not None and self.now >= self._stop_at_s

    def stop(self, at_s: float = 0.0, exit_code: int = 0) -> None:
        """The first agent that says so decides when, and with which exit code."""
        if self._stop_at_s is None:
            self._stop_at_s, self.exit_code = at_s, exit_code

    def _checked(self, stimuli: Mapping[str, Stimuli]) -> dict[str, Stimuli]:
        checked: dict[str, Stimuli] = {}
        for name, given in stimuli.items():
            agent = self._member(name).agent
            percepts = None if given.percepts is None else frozenset(given.percepts)
            if percepts is not None:
                agent.percepts.change(percepts)
            for message in given.messages:
                agent.message_handling.read(message)
            checked[name] = Stimuli(percepts, given.messages, agent.execution.started(given.finished))
        return checked

    def _cycle(self, member: _Member, inbox: list[Message], given: Stimuli) -> Outcome:
        agent, messages = member.agent, given.messages
        if messages:
            self.mailboxes.outside.update(message.sender for message in messages)
        if inbox:
            messages = [*self._readable(agent, inbox), *messages]
        outcome = (agent.recorder or agent).cycle(given.percepts, messages, given.finished, self.now)
        if given.finished:
            member.started -= {news.id for news in given.finished}
        if outcome is QUIET:
            return outcome
        member.started |= {action.id for action in outcome.actions}
        member.started -= set(outcome.cancelled)
        if not outcome.messages:
            return outcome
        return outcome._replace(messages=tuple(each for each in outcome.messages if not self.mailboxes.deliver(each)))

    def _readable(self, agent: Agent, inbox: list[Message]) -> Iterator[Message]:
        """A plan that understood a message when it was sent may be gone."""
        for message in inbox:
            try:
                agent.message_handling.read(message)
            except BdiError:
                self.mailboxes.lost.append(message)
            else:
                yield message

    def _member(self, name: str) -> _Member:
        member = self._members.get(name)
        if member is None:
            raise UnknownAgent(name, list(self._members))
        return member
