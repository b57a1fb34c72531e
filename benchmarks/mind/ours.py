"""Our interpreter as a worker: python -m benchmarks.mind.ours FOLDER."""

import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from bdi import Agent, Finished, Message, load_program
from bdi.debug.trace import TraceEntry
from benchmarks.mind.worker import Cycle, Worker, serve


def heard(entry: TraceEntry) -> None:
    """A listener that does nothing: what tracing itself costs."""


class Ours:
    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.acted = 0

    def start(self, name: str, *, traced: bool = False) -> Cycle:
        agent = self._agent(name)
        if traced:
            agent.listen(heard)
        run = agent.cycle
        finished: Sequence[Finished] = ()

        def cycle(percepts: frozenset[str], goal: str) -> None:
            nonlocal finished
            outcome = run(percepts, [Message("user", "achieve", goal)] if goal else (), finished, 0.0)
            if outcome.actions:
                finished = [Finished(action.id) for action in outcome.actions]
                self.acted += len(finished)
            else:
                finished = ()

        return cycle

    def prepare(self, name: str, goal: str) -> Callable[[], None]:
        agent = self._agent(name)
        message = Message("user", "achieve", goal)

        def run() -> None:
            cycle = agent.cycle
            actions = cycle(None, [message]).actions
            while not actions:
                actions = cycle().actions

        return run

    def _agent(self, name: str) -> Agent:
        return Agent(load_program(self.folder / f"{name}.asl"))


if __name__ == "__main__":
    serve(Worker(Ours(Path(sys.argv[1])), Path(sys.argv[1])))
