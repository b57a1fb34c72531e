"""A recording as something to step through: what came in then comes in again."""

from collections.abc import Iterator

from bdi.model.messages import Finished, Message
from bdi.reasoning.agent import Agent
from bdi.tools.recording.replaying import Recording, Run
from bdi.tools.simulation import Happened, Prepare


class _Replayed:
    """One agent of the recording."""

    def __init__(self, run: Run, prepare: Prepare) -> None:
        program = run.program()
        self.agent = run.new_agent(program)
        self.inputs: Iterator[tuple[list[str] | None, list[Message], list[Finished], float]] = iter(run.inputs())
        self.left = len(run.lines)
        prepare(self.agent, program)


class Rerun:
    """The agents of a recording, each with its own inputs."""

    def __init__(self, recording: Recording, prepare: Prepare) -> None:
        self.number = 0
        self._replayed = {run.agent: _Replayed(run, prepare) for run in recording.runs}

    @property
    def agents(self) -> dict[str, Agent]:
        return {name: each.agent for name, each in self._replayed.items()}

    @property
    def over(self) -> bool:
        return all(not each.left for each in self._replayed.values())

    def cycle(self) -> tuple[Happened, ...]:
        if self.over:
            return ()
        self.number += 1
        happened = []
        for name, each in self._replayed.items():
            if each.left:
                each.left -= 1
                outcome = each.agent.cycle(*next(each.inputs))
                happened.append(Happened(self.number, name, outcome, outcome.messages))
        return tuple(happened)
