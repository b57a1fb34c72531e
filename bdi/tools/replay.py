"""python -m bdi replay"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer
from rich.markup import escape

from bdi.reasoning.agent import Agent
from bdi.reasoning.output import Outcome
from bdi.tools.console import DIFFERENT, aside, complaints, load, output
from bdi.tools.options import AsJson
from bdi.tools.recording.recorder import digest
from bdi.tools.recording.replaying import Difference, Recording, Run, read_recording


def replay(
    recording: Annotated[Path, typer.Argument(help="A file that `run --save-trace FILE` wrote.")],
    *,
    program: Annotated[
        Path | None, typer.Option(help="Give the recorded inputs to this program in place of the recorded one.")
    ] = None,
    show: Annotated[bool, typer.Option("--show", help="Print the actions, like `run`.")] = False,
    as_json: AsJson = False,
) -> None:
    """Run a recording again and compare every cycle with what was recorded.

    The recording holds the whole program, so it needs no other file. Every
    action, message, printed line and failure must come out the same, in the
    same cycle; the first difference is named. A recording that breaks off is
    replayed as far as it goes.

    [bold]Examples[/bold]

    \b
      python -m bdi run mail.asl --percepts walk.txt --save-trace walk.jsonl
      python -m bdi replay walk.jsonl
      python -m bdi replay walk.jsonl --program mail.asl    what did I change?

    Exit status: 0 all the same, 1 something differs, 2 not usable.
    """
    with complaints():
        recorded = read_recording(recording)
        other = load(program) if program else None
        found: list[tuple[Run, Difference | None]] = []
        for run in recorded.runs:
            if other is None and not as_json:
                _note_changes(run)
            found.append((run, run.replay(other, _printer(run, len(recorded.runs) > 1) if show else None)))
    if as_json:
        typer.echo(json.dumps(_data(recording, recorded, found), indent=2))
    else:
        _tell(recording, recorded, found)
    if any(difference for _, difference in found):
        raise typer.Exit(DIFFERENT)


def _note_changes(run: Run) -> None:
    """A program that has changed on disk since is still replayed as it was."""
    sources = {name: Path(name) for name in run.head["sources"]}
    if not all(path.is_file() for path in sources.values()):
        return
    now = {name: path.read_text(encoding="utf-8", errors="replace") for name, path in sources.items()}
    if digest(now) != run.head["sha256"]:
        source = run.head["program"]
        aside(f"{source} has changed since; replayed as it was (--program {source} takes the new one)")


def _printer(run: Run, named: bool) -> Callable[[int, Agent, Outcome], None]:
    def on_cycle(cycle: int, agent: Agent, outcome: Outcome) -> None:
        for action in outcome.actions:
            typer.echo(f"{cycle} {run.agent} {action}" if named else f"{cycle} {action}")

    return on_cycle


def _data(path: Path, recorded: Recording, found: list[tuple[Run, Difference | None]]) -> dict[str, object]:
    runs = [
        {
            "agent": run.agent,
            "program": run.head["program"],
            "cycles": difference.cycle if difference else len(run.lines),
            "difference": difference._asdict() if difference else None,
        }
        for run, difference in found
    ]
    return {"recording": str(path), "cut_off": recorded.cut_off or None, "runs": runs}


def _tell(path: Path, recorded: Recording, found: list[tuple[Run, Difference | None]]) -> None:
    console = output()
    if recorded.cut_off:
        aside(f"{path}: {recorded.cut_off}; replayed as far as it goes")
    for run, difference in found:
        who = escape(f"{run.agent} ({run.head['program']})")
        if difference is None:
            cycles = f"{len(run.lines)} cycle{'' if len(run.lines) == 1 else 's'}"
            console.print(f"[green]same[/green]     {who}  [dim]{cycles}[/dim]")
            continue
        console.print(f"[bold red]DIFFERS[/bold red]  {who}  [dim]in cycle {difference.cycle}: {difference.what}[/dim]")
        console.print(f"    [red]- {escape(_words(difference.recorded))}[/red]  [dim](recorded)[/dim]")
        console.print(f"    [green]+ {escape(_words(difference.replayed))}[/green]  [dim](replayed)[/dim]")


def _words(value: object) -> str:
    if value is None:
        return "nothing"
    if isinstance(value, list):
        return ", ".join(_words(item[1] if _is_action(item) else item) for item in value)
    return value if isinstance(value, str) else json.dumps(value)


def _is_action(item: object) -> bool:
    return isinstance(item, list) and len(item) == 3 and isinstance(item[0], int)
