"""Run AgentSpeak programs without a body, and see what they do."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from bdi.agent import Agent
from bdi.errors import BdiError
from bdi.messages import Finished, Message
from bdi.outcome import Outcome
from bdi.parser import load_program
from bdi.percept_file import Stimulus, read_percepts
from bdi.terms import show

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
)

CYCLE_MS = 100  # the paper's cycle (section 5.2); here it only gives `.wait` a clock
LONGEST_RUN = 1_000_000


@app.callback()
def commands() -> None:
    """Run AgentSpeak programs without a body, and see what they do."""


@app.command()
def run(
    program: Annotated[Path, typer.Argument(help="The agent program, an .asl file.")],
    *,
    percepts: Annotated[Path | None, typer.Option(help="One line a cycle, as described above.")] = None,
    cycles: Annotated[int | None, typer.Option(min=1, help="Stop after so many cycles.")] = None,
    fail: Annotated[list[str] | None, typer.Option(help="Actions of this name fail; may be repeated.")] = None,
    seed: Annotated[int, typer.Option(help="For .random: equal seeds give equal runs.")] = 0,
    trace: Annotated[bool, typer.Option("--trace", help="Show what is chosen, and which steps are taken.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object a line.")] = False,
) -> None:
    """Print "CYCLE ACTION" for every action that the program starts.

    An action succeeds at once: its intention goes on in the next cycle. An action named with --fail fails instead.

    A percept file has one line a cycle: literals separated by spaces, or a JSON object
    {"percepts": ["line(center)"], "messages": [["achieve", "g(1)"]]} with null for "nothing new". Without a file
    nothing is perceived.

    Only actions go to the output; what `.print` says, messages and goals that were given up go to the error stream.

    The run ends at an action called `done`, when nothing is left to do and the file is at its end, or after --cycles.
    """
    try:
        stimuli = read_percepts(percepts) if percepts else None
        agent = Agent(load_program(program), name=program.stem, random_seed=seed)
        report = _Report(as_json)
        if trace:
            agent.listen(lambda entry: report.note(str(entry)))
        _run(agent, stimuli, cycles or LONGEST_RUN, frozenset(fail or ()), report)
    except BdiError as error:
        _complain(str(error))
    except OSError as error:
        _complain(f"cannot read {error.filename}: {error.strerror}")
    except UnicodeDecodeError as error:
        _complain(f"{percepts or program} is not a text file: {error.reason}")


def _complain(problem: str) -> None:
    typer.echo(problem, err=True)
    raise typer.Exit(2)


def _aside(line: str) -> None:
    """Whatever is no action goes to the error stream, so that the output can be compared."""
    typer.echo(line, err=True)


@dataclass(slots=True)
class _Report:
    """Prints what happens, for people or as JSON lines."""

    as_json: bool

    def cycle(self, number: int, outcome: Outcome) -> None:
        if self.as_json:
            self._json(number, outcome)
            return
        for action in outcome.actions:
            print(f"{number} {action}")
        for line in outcome.printed:
            _aside(f"{number} says: {line}")
        for message in outcome.messages:
            _aside(f"{number} to {message.receiver}: {message.performative} {show(message.content)}")
        for failure in outcome.failures:
            _aside(f"{number} failed: {failure}")
        for cancelled in outcome.cancelled:
            _aside(f"{number} cancelled: action {cancelled}")

    def _json(self, number: int, outcome: Outcome) -> None:
        entry: dict[str, Any] = {
            "cycle": number,
            "actions": [str(action) for action in outcome.actions],
            "cancelled": list(outcome.cancelled),
            "messages": [[each.receiver, each.performative, show(each.content)] for each in outcome.messages],
            "printed": list(outcome.printed),
            "failures": [failure._asdict() for failure in outcome.failures],
        }
        filled = {key: value for key, value in entry.items() if value}
        if len(filled) > 1:
            print(json.dumps(filled))

    def note(self, line: str) -> None:
        if self.as_json:
            print(json.dumps({"trace": line}))
        else:
            _aside(f"    {line}")


def _run(
    agent: Agent, stimuli: Iterator[Stimulus] | None, cycles: int, failing: frozenset[str], report: _Report
) -> None:
    finished: list[Finished] = []
    queue = stimuli or iter(())
    for number in range(1, cycles + 1):
        stimulus = next(queue, None)
        if stimulus is None and stimuli is not None:
            stimuli = None
        if stimulus is None and agent.idle and number > 1:
            return
        percepts = stimulus.percepts if stimulus else ()
        messages = [Message("user", kind, content) for kind, content in stimulus.messages] if stimulus else []
        outcome = agent.cycle(percepts, messages, finished, number * CYCLE_MS / 1000)
        report.cycle(number, outcome)
        finished = [
            Finished(action.id, "failed", f"{action} was told to fail")
            if action.term.functor in failing
            else Finished(action.id)
            for action in outcome.actions
        ]
        if any(action.term.functor == "done" for action in outcome.actions):
            return


if __name__ == "__main__":
    app(prog_name="python -m bdi")
