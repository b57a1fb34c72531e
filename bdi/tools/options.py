"""Arguments and options that several commands take."""

from pathlib import Path
from typing import Annotated

import typer

Program = Annotated[Path, typer.Argument(help="The agent program, an .asl file.")]
Programs = Annotated[
    list[Path],
    typer.Argument(metavar="PROGRAM", help="Agent programs, .asl files. Each agent is called like its file."),
]
Percepts = Annotated[Path | None, typer.Option(help="Percepts and messages, one line a cycle (see `run --help`).")]
Cycles = Annotated[int | None, typer.Option(min=1, help="Stop after so many cycles, of 1,000,000 at most.")]
Fail = Annotated[list[str] | None, typer.Option(help="Actions of this name fail; may be repeated.")]
Seed = Annotated[int, typer.Option(help="For .random: equal seeds give equal runs.")]
Compatible = Annotated[
    bool, typer.Option("--compatible", help="Take Jason 2 and the paper's notation too, with warnings.")
]
AsJson = Annotated[bool, typer.Option("--json", help="For programs: JSON instead of text.")]
Outside = Annotated[
    list[str] | None, typer.Option(metavar="NAME", help="Messages may go to this name, which no program has.")
]
