"""python -m bdi step"""

import json
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from bdi.tools.console import complain, complaints
from bdi.tools.options import AsJson, Compatible, Cycles, Fail, Outside, Percepts, Seed
from bdi.tools.percept_file import read_percepts
from bdi.tools.recording.replaying import read_recording
from bdi.tools.simulation import Prepare, Simulation, setting_of
from bdi.tools.stepping.dialogue import Dialogue
from bdi.tools.stepping.rerun import Rerun
from bdi.tools.stepping.stepper import Running, Stepper

MaybePrograms = Annotated[
    list[Path] | None, typer.Argument(metavar="PROGRAM", help="Agent programs, .asl files; none with --recording.")
]


def step(
    programs: MaybePrograms = None,
    *,
    percepts: Percepts = None,
    recording: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Step through what `run --save-trace FILE` recorded.")
    ] = None,
    commands: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Read commands from a file, one a line, not the keyboard.")
    ] = None,
    cycles: Cycles = None,
    fail: Fail = None,
    seed: Seed = 0,
    outside: Outside = None,
    compatible: Compatible = False,
    as_json: AsJson = False,
) -> None:
    """Go through a run cycle by cycle and see why each plan was or was not taken.

    [bold]Commands[/bold]

    \b
      Enter, n [N]    the next cycle, or the next N
      c               go on to the next breakpoint
      b WHAT          a breakpoint: +!goto/2, +at(post1), @label, drive/1
      b, d [WHAT]     list breakpoints, delete one or all
      f WHAT, f       show only cycles about this, show all again
      w GOAL          why is the goal not reached yet?
      p FORMULA, p    what is believed: answers to a formula, or all
      i               intentions
      a NAME          look at another agent with w, p and i
      back [N]        N cycles back
      h, q            help, quit

    A plan @label\\[breakpoint] is a breakpoint. Commands may also come from a
    pipe or a file.

    [bold]Examples[/bold]

    \b
      python -m bdi step mail.asl --percepts walk.txt
      python -m bdi step --recording walk.jsonl
      printf 'b +!dock\\nc\\nw dock\\n' | python -m bdi step mail.asl
    """
    with complaints():
        if bool(programs) is (recording is not None):
            raise complain("give a PROGRAM, or --recording FILE that `run --save-trace FILE` wrote")
        if recording is not None:
            recorded = read_recording(recording)

            def begin(prepare: Prepare) -> Running:
                return Rerun(recorded, prepare)
        else:
            stimuli = read_percepts(percepts) if percepts else ()
            setting = setting_of(
                programs or (), stimuli, fail=fail, cycles=cycles, seed=seed, compatible=compatible, outside=outside
            )

            def begin(prepare: Prepare) -> Running:
                return Simulation(setting, prepare)

        console = Console(highlight=False)
        dialogue = Dialogue(Stepper(begin), console, json.dumps if as_json else None)
        dialogue.hold(_lines(commands, console, echo=not as_json))


def _lines(commands: Path | None, console: Console, echo: bool) -> Iterator[str]:
    """Yield the commands, typed, piped or from a file. Those not typed are echoed to complete the output."""
    if commands is None and sys.stdin.isatty():
        yield from _typed(console)
        return
    source = sys.stdin if commands is None else commands.read_text(encoding="utf-8").splitlines()
    for line in source:
        if echo:
            console.print(f"[dim]>[/dim] {line.strip()}", markup=True)
        yield line


def _typed(console: Console) -> Iterator[str]:
    with suppress(ImportError):
        import readline  # noqa: F401  # arrow keys and history while typing, where there is one

    while True:
        try:
            yield console.input("[dim]>[/dim] ")
        except EOFError:
            console.print()
            return
        except KeyboardInterrupt:
            console.print("[dim]q leaves[/dim]")
