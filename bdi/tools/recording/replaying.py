"""Recorded runs, run again: the same program, chance and inputs must give the same cycles.

recording = read_recording(path)
recording.runs[0].replay()      # None, or the first difference
"""

import json
from array import array
from base64 import b64decode
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from bdi.builtin import Table
from bdi.language.errors import BdiError, Place
from bdi.language.parser import literal_from, parse_program
from bdi.language.syntax import Belief, Goal, Program
from bdi.model.messages import Finished, Message
from bdi.reasoning.agent import Agent
from bdi.reasoning.output import Outcome
from bdi.tools.recording.recorded_replies import replayed
from bdi.tools.recording.recorder import VERSION, digest, result_of

RESULTS = ("actions", "cancelled", "messages_out", "printed", "failures", "trace", "events", "intentions")


class NotARecording(BdiError):
    """A file that no Recorder wrote, or that was changed since."""


class NotReplayable(BdiError):
    """A run that took more than a recording holds."""


class Difference(NamedTuple):
    """The first thing that came out otherwise: `what` is actions, messages_out, …"""

    agent: str
    cycle: int
    what: str
    recorded: Any
    replayed: Any


@dataclass(slots=True)
class Run:
    """The recorded run of one agent.

    `internal_actions` are those that the agent had beside ours. They are Python, which a recording does not hold: set
    them before the replay.
    """

    head: dict[str, Any]
    lines: list[dict[str, Any]] = field(default_factory=list)
    ended: bool = False
    internal_actions: Table | None = None

    @property
    def agent(self) -> str:
        return str(self.head["agent"])

    def program(self) -> Program:
        """The program as it was when it was recorded. Raises NotReplayable."""
        texts: dict[str, str] = self.head["sources"]

        def read(path: Path) -> str:
            if str(path) not in texts:
                raise FileNotFoundError(2, "not in the recording", str(path))
            return texts[str(path)]

        source = self.head["program"]
        if source not in texts:
            raise NotReplayable(
                f"the run of {self.agent} cannot be replayed: a recording does not hold what a clone has of the agent "
                "that it was made of"
            )
        options: dict[str, Any] = {"compatible": True} if self.head.get("compatible") else {}
        return parse_program(texts[source], source, read, **options)

    def _with_given(self, program: Program) -> Program:
        """Add the beliefs and goals that the agent was created with."""
        here = Place(self.agent)
        beliefs = [Belief(literal_from(text), here) for text in self.head.get("beliefs", ())]
        goals = [Goal(literal_from(text), here) for text in self.head.get("goals", ())]
        return replace(program, beliefs=(*program.beliefs, *beliefs), goals=(*program.goals, *goals))

    def new_agent(self, program: Program | None = None) -> Agent:
        """The agent as it was before its first cycle; with another program, that one in its place."""
        agent = Agent(
            self._with_given(program or self.program()),
            name=self.agent,
            actions=self.head["actions"],
            internal_actions=self.internal_actions,
        )
        agent.random.setstate(_chance(self.head["chance"]))
        agent.society = replayed(answer for line in self.lines for answer in line.get("society", ()))
        return agent

    def inputs(self) -> Iterable[tuple[list[str] | None, list[Message], list[Finished], float]]:
        """The inputs, cycle by cycle."""
        percepts: list[str] | None = None
        for line in self.lines:
            now = line.get("percepts", percepts)
            percepts = percepts if now is None else now
            messages = [Message(**message) for message in line.get("messages", ())]
            yield now, messages, [Finished(**news) for news in line.get("finished", ())], line["now"]

    def replay(
        self, program: Program | None = None, on_cycle: Callable[[int, Agent, Outcome], None] | None = None
    ) -> Difference | None:
        """Run it again; return the first difference, or None. `on_cycle` is called with each outcome."""
        agent = self.new_agent(program)
        entries = any("trace" in line for line in self.lines)
        if entries:
            agent.listen(lambda entry: None)
        for line, given in zip(self.lines, self.inputs(), strict=True):
            try:
                outcome = agent.cycle(*given)
            except BdiError as error:
                return Difference(self.agent, line["cycle"], "input", "taken", f"refused: {error}")
            if on_cycle:
                on_cycle(line["cycle"], agent, outcome)
            result = json.loads(json.dumps(result_of(agent, outcome, entries)))
            for what in RESULTS:
                if line.get(what) != result.get(what):
                    return Difference(self.agent, line["cycle"], what, line.get(what), result.get(what))
        return None


class Recording(NamedTuple):
    """`cut_off` says what is missing at the end, or nothing."""

    runs: list[Run]
    cut_off: str


def read_recording(path: Path) -> Recording:
    """Raises NotARecording; OSError if the file cannot be read."""
    runs: dict[str, Run] = {}
    lines = path.read_text(encoding="utf-8", errors="replace").split("\n")
    for number, text in enumerate(lines, 1):
        if not text:
            continue
        try:
            _take(runs, json.loads(text))
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            if number == len(lines) and runs:
                return Recording(list(runs.values()), f"the file breaks off in line {number}")
            raise NotARecording(f"{path}:{number}: this is no line of a recording: {_said(error)}") from error
    if not runs:
        raise NotARecording(f"{path} is empty; record a run with `python -m bdi run PROGRAM --save-trace FILE`")
    open_ended = [run.agent for run in runs.values() if not run.ended]
    return Recording(list(runs.values()), f"the end of {', '.join(open_ended)} is missing" if open_ended else "")


def _said(error: Exception) -> str:
    if isinstance(error, json.JSONDecodeError):
        return "it is no JSON, or breaks off"
    if isinstance(error, KeyError):
        return f"{error} is missing"
    return str(error) if isinstance(error, ValueError) else "it holds something else"


def _take(runs: dict[str, Run], line: dict[str, Any]) -> None:
    if "recording" in line:
        if line["recording"] != VERSION:
            raise ValueError(f"version {line['recording']}, not {VERSION}")
        if digest(line["sources"]) != line["sha256"]:
            raise ValueError("its program was changed")
        runs[line["agent"]] = Run(line)
    elif "end" in line:
        runs[line["agent"]].ended = True
    else:
        _ = line["now"], line["cycle"]
        runs[line["agent"]].lines.append(line)


def _chance(saved: Sequence[Any]) -> Any:
    version, words, gauss = saved
    return version, tuple(array("I", b64decode(words))), gauss
