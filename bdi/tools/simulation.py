"""Agents without bodies: percepts come from a file, and every action succeeds (or fails) at once."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from bdi.communication.system import MultiAgentSystem, Stimuli
from bdi.language.errors import UnknownAgent
from bdi.language.syntax import Program
from bdi.model.messages import Finished, Message
from bdi.reasoning.agent import Agent
from bdi.reasoning.output import Action, Outcome
from bdi.tools.console import load
from bdi.tools.percept_file import NOTHING, USER, Stimulus

CYCLE_MS = 100  # the paper's cycle (section 5.2); here it only gives `.wait` a clock
LONGEST_RUN = 1_000_000
END = "done"  # an action of this name ends a run

Prepare = Callable[[Agent, Program], None]  # may listen to an agent before its first cycle


class Happened(NamedTuple):
    """The outputs of one agent in one cycle, with all messages that it sent."""

    cycle: int
    agent: str
    outcome: Outcome
    sent: tuple[Message, ...]


@dataclass(frozen=True, slots=True)
class Setting:
    """Everything that a run depends on, so that equal settings give equal runs."""

    programs: tuple[Path, ...]
    stimuli: tuple[Stimulus, ...] = ()
    failing: frozenset[str] = frozenset()
    cycles: int = LONGEST_RUN
    seed: int = 0
    compatible: bool = False
    outside: tuple[str, ...] = ()


class Simulation:
    """The agents of a setting, one for each program and called like it, cycle by cycle.

    A run goes on until an action called `done`, until nothing is left to do and the file is at its end, until
    `.stopMAS`, or until so many cycles. Raises BdiError and OSError for programs that cannot be used.
    """

    def __init__(self, setting: Setting, prepare: Prepare = lambda agent, program: None) -> None:
        self.setting = setting
        self.number = 0
        self.started: set[str] = set()  # names of actions
        self._prepare = prepare
        self._ended = False
        self._met: set[str] = set()  # names of agents, those that are gone too
        self._finished: dict[str, list[Finished]] = {}
        self.system = MultiAgentSystem(load=self._load, make=self._make, save=_save, outside=(USER, *setting.outside))
        for path in setting.programs:
            program = load(path, setting.compatible)
            self.system.add(self._make(program, self.system.free_name(path.stem)))

    def _make(self, program: Program, name: str) -> Agent:
        agent = Agent(program, name=name, random_seed=self.setting.seed)
        self._met.add(name)
        self._prepare(agent, program)
        return agent

    def _load(self, name: str) -> Program:
        """Load the program of `.create_agent`: a path, or one beside the first program."""
        path = Path(name)
        return load(path if path.exists() else self.setting.programs[0].parent / name, self.setting.compatible)

    @property
    def agents(self) -> dict[str, Agent]:
        return self.system.agents

    @property
    def over(self) -> bool:
        scripted = self.number < len(self.setting.stimuli)
        idle = self.number > 0 and not scripted and self.system.idle
        return self._ended or self.number >= self.setting.cycles or idle or self.system.stopped

    def __iter__(self) -> Iterator[Happened]:
        while happened := self.cycle():
            yield from happened

    def cycle(self) -> tuple[Happened, ...]:
        """Run the next cycle of each agent; return nothing when the run is over.

        Raises UnknownAgent for percepts of an agent that never was there.
        """
        if self.over:
            return ()
        scripted = self.setting.stimuli
        stimulus = scripted[self.number] if self.number < len(scripted) else NOTHING
        self.number += 1
        for name, _ in stimulus.others:
            if name not in self._met:
                raise UnknownAgent(name, list(self.system.agents))
        given = {name: self._stimuli(name, stimulus.of(name)) for name in self.system.agents}
        self._finished = {}
        outcomes = self.system.round(given, self.number * CYCLE_MS / 1000)
        for name, outcome in outcomes.items():
            if outcome.actions:
                self._finished[name] = [self._news_of(action) for action in outcome.actions]
                self.started.update(action.term.functor for action in outcome.actions)
                self._ended = END in self.started
        traffic = self.system.traffic
        return tuple(
            Happened(self.number, name, outcome, tuple(each for each in traffic if each.sender == name))
            for name, outcome in outcomes.items()
        )

    def _stimuli(self, name: str, stimulus: Stimulus) -> Stimuli:
        return Stimuli(stimulus.percepts, stimulus.messages_to(name), self._finished.get(name, ()))

    def _news_of(self, action: Action) -> Finished:
        if action.term.functor in self.setting.failing:
            return Finished(action.id, "failed", f"{action} was told to fail")
        return Finished(action.id)


def _save(target: str, text: str) -> None:
    """.save_agent"""
    Path(target).write_text(text, encoding="utf-8")


def setting_of(
    programs: Sequence[Path],
    stimuli: Sequence[Stimulus],
    *,
    fail: Sequence[str] | None,
    cycles: int | None,
    seed: int,
    compatible: bool,
    outside: Sequence[str] | None,
) -> Setting:
    """A setting from what a command was given."""
    longest = cycles or LONGEST_RUN
    return Setting(
        tuple(programs), tuple(stimuli), frozenset(fail or ()), longest, seed, compatible, tuple(outside or ())
    )
