"""python -m bdi run"""

import json
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from bdi.debug.trace import TraceEntry
from bdi.language.syntax import Program
from bdi.language.terms import show
from bdi.reasoning.agent import Agent
from bdi.reasoning.output import QUIET, Outcome
from bdi.tools.console import aside, complaints
from bdi.tools.options import AsJson, Compatible, Cycles, Fail, Outside, Percepts, Programs, Seed
from bdi.tools.percept_file import read_percepts
from bdi.tools.recording.recorder import record
from bdi.tools.simulation import Happened, Simulation, setting_of

TRACE = Outcome._fields.index("trace")
NOTHING_DONE = """\
nothing was done: a program begins by itself with a goal, such as `!start.`; events come from --percepts FILE"""
GIVEN_UP = "why a goal failed: `python -m bdi step` shows it cycle by cycle, `check` looks for plans that are missing"


def run(
    programs: Programs,
    *,
    percepts: Percepts = None,
    cycles: Cycles = None,
    fail: Fail = None,
    seed: Seed = 0,
    trace: Annotated[bool, typer.Option("--trace", help="Show what is chosen, and which steps are taken.")] = False,
    save_trace: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Record the run, for `python -m bdi replay FILE`.")
    ] = None,
    outside: Outside = None,
    compatible: Compatible = False,
    as_json: AsJson = False,
) -> None:
    """Print "CYCLE ACTION" for every action that the program starts.

    An action succeeds at once: its intention goes on in the next cycle. An
    action named with --fail fails instead.

    Several programs are several agents, called like their files, that can send
    each other messages; each line then says whose it is: "CYCLE AGENT ACTION".

    [bold]Percept files[/bold] have one line a cycle: literals separated by
    spaces, or a JSON object. Without a file nothing is perceived.

    \b
      line(center) battery(80)
      {"percepts": ["line(lost)"], "messages": [["achieve", "g(1)"]]}
      {"percepts": null}                               nothing new
      {"agents": {"b": {"percepts": ["p"]}}}           for the agent b alone

    Only actions go to the output; what .print says, messages and goals that
    were given up go to the error stream.

    The run ends at an action called `done`, when nothing is left to do and the
    file is at its end, or after --cycles.

    [bold]Examples[/bold]

    \b
      python -m bdi run examples/agents/first_steps.asl
      python -m bdi run mail.asl --percepts walk.txt --fail drive --trace
      python -m bdi run mail.asl --save-trace walk.jsonl
      python -m bdi run buyer.asl seller.asl --cycles 100 --json
    """
    with complaints(), ExitStack() as closing:
        report = _Report(as_json, len(programs) > 1)
        stimuli = read_percepts(percepts) if percepts else ()

        file = closing.enter_context(save_trace.open("w", encoding="utf-8")) if save_trace else None

        def prepare(agent: Agent, program: Program) -> None:
            if trace:
                agent.listen(lambda entry: report.note(agent.name, entry))
            if file is not None:
                closing.callback(record(agent, file, program, compatible=compatible).close)

        setting = setting_of(
            programs, stimuli, fail=fail, cycles=cycles, seed=seed, compatible=compatible, outside=outside
        )
        simulation = Simulation(setting, prepare)
        for happened in simulation:
            report.named = report.named or len(simulation.agents) > 1
            report.show(happened)
        report.close(simulation)


@dataclass(slots=True)
class _Report:
    """Prints what happens, for people or as JSON lines."""

    as_json: bool
    named: bool  # whether to say which agent it was
    silent: bool = True  # nothing has come out yet
    given_up: bool = False  # whether a goal was

    def show(self, happened: Happened) -> None:
        self.silent = self.silent and happened.outcome[:TRACE] == QUIET[:TRACE] and not happened.sent
        self.given_up = self.given_up or bool(happened.outcome.failures)
        if self.as_json:
            self._json(happened)
            return
        outcome = happened.outcome
        number = f"{happened.cycle} {happened.agent}" if self.named else str(happened.cycle)
        for action in outcome.actions:
            typer.echo(f"{number} {action}")
        for line in outcome.printed:
            aside(f"{number} says: {line}")
        for message in happened.sent:
            aside(f"{number} to {message.receiver}: {message.performative} {show(message.content)}")
        for failure in outcome.failures:
            aside(f"{number} failed: {failure}")
        for cancelled in outcome.cancelled:
            aside(f"{number} cancelled: action {cancelled}")

    def _json(self, happened: Happened) -> None:
        outcome = happened.outcome
        whose = {"agent": happened.agent} if self.named else {}
        entry: dict[str, Any] = {
            "actions": [str(action) for action in outcome.actions],
            "cancelled": list(outcome.cancelled),
            "messages": [[each.receiver, each.performative, show(each.content)] for each in happened.sent],
            "printed": list(outcome.printed),
            "failures": [failure._asdict() for failure in outcome.failures],
        }
        filled = {key: value for key, value in entry.items() if value}
        if filled:
            typer.echo(json.dumps({"cycle": happened.cycle, **whose, **filled}))

    def close(self, simulation: Simulation) -> None:
        """Print hints about how the run ended."""
        for name in sorted(simulation.setting.failing - simulation.started):
            aside(f"--fail {name}: no action of this name was started")
        if self.silent:
            aside(NOTHING_DONE)
        if self.given_up:
            aside(GIVEN_UP)

    def note(self, agent: str, entry: TraceEntry) -> None:
        whose = {"agent": agent} if self.named else {}
        if self.as_json:
            typer.echo(json.dumps({**whose, "trace": entry.data()}))
        else:
            aside(f"    {agent + ' ' if self.named else ''}{entry}")
