"""python-agentspeak as a worker, run by the Python of its own environment: python python_agentspeak.py FOLDER.

It is used through its public names alone. What it has not, this driver does for it, in as little time as it can:
percepts are compared with the last ones, and the differences go straight into its set of beliefs, or by a call where
a plan is about them; `.drop_all_intentions` is an action of ours. One cycle is the changes of percepts, the goal, and
one `step`, which does less than a cycle of AgentSpeak: a goal takes its plan in the step that posts it, and an action
is three steps.
"""

import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import agentspeak
import agentspeak.runtime
import agentspeak.stdlib
from agentspeak import GoalType, Literal, Trigger
from agentspeak.runtime import Intention
from worker import Cycle, Worker, serve

LITERAL = re.compile(r"(\w+)(?:\((.*)\))?$")
EXTERNAL = ("done", "drive", "turn", "setDestination", "station")


class PythonAgentSpeak:
    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.acted = 0
        self._literals: dict[str, Any] = {}
        self.actions = agentspeak.Actions(agentspeak.stdlib.actions)
        for name in EXTERNAL:
            self.actions.add(name, None, self._act)
        self.actions.add(".drop_all_intentions", 0, self._drop_others)

    def _act(self, agent: Any, term: Any, intention: Any) -> Iterator[None]:
        self.acted += 1
        yield

    def _drop_others(self, agent: Any, term: Any, intention: Any) -> Iterator[None]:
        for stack in list(agent.intentions):
            if not stack or stack[-1] is not intention:
                agent.intentions.remove(stack)
        yield

    def start(self, name: str, *, traced: bool = False) -> Cycle:
        if traced:
            raise NotImplementedError("python-agentspeak has no trace")
        agent = self._agent(name)
        literal, plans, beliefs = self.literal, agent.plans, agent.beliefs
        before: frozenset[str] = frozenset()

        def cycle(percepts: frozenset[str], goal: str) -> None:
            nonlocal before
            for gone in before - percepts:
                belief = literal(gone)
                predicate = belief.functor, len(belief.args)
                if (Trigger.removal, GoalType.belief, *predicate) in plans:
                    agent.call(Trigger.removal, GoalType.belief, belief, Intention())
                else:
                    beliefs[predicate].discard(belief)
            for new in percepts - before:
                belief = literal(new)
                predicate = belief.functor, len(belief.args)
                if (Trigger.addition, GoalType.belief, *predicate) in plans:
                    agent.call(Trigger.addition, GoalType.belief, belief, Intention())
                else:
                    beliefs[predicate].add(belief)
            before = percepts
            if goal:
                agent.call(Trigger.addition, GoalType.achievement, literal(goal), Intention(), delayed=True)
            agent.step()

        return cycle

    def prepare(self, name: str, goal: str) -> Callable[[], None]:
        agent = self._agent(name)
        wanted = self.literal(goal)
        before = self.acted

        def run() -> None:
            agent.call(Trigger.addition, GoalType.achievement, wanted, Intention(), delayed=True)
            step = agent.step
            while self.acted == before:
                if not step():
                    raise RuntimeError(f"nothing left to do before {goal} was reached")

        return run

    def literal(self, text: str) -> Any:
        """The literal of a percept or goal with atoms and numbers as arguments; remembered."""
        known = self._literals.get(text)
        if known is None:
            match = LITERAL.match(text)
            assert match, text
            name, arguments = match.groups()
            terms = [] if arguments is None else [_constant(each) for each in arguments.split(",")]
            known = self._literals[text] = Literal(name, terms)
        return known

    def _agent(self, name: str) -> Any:
        environment = agentspeak.runtime.Environment()
        text = (self.folder / f"{name}.asl").read_text()
        return environment.build_agent(agentspeak.StringSource(name, text), self.actions)


def _constant(text: str) -> Any:
    return int(text) if text.isdigit() else Literal(text)


if __name__ == "__main__":
    serve(Worker(PythonAgentSpeak(Path(sys.argv[1])), Path(sys.argv[1])))
