"""Common parts of the commands: load programs, report errors on the error stream, end with the right status."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer
from rich.console import Console

from bdi.language.errors import AgentSpeakSyntaxError, BdiError
from bdi.language.parser import load_program
from bdi.language.syntax import Program

DIFFERENT = 1
UNUSABLE = 2
PROGRAM = ".asl"


def output() -> Console:
    """Make the console for people; anew each time, so that it writes to the current standard output."""
    return Console(highlight=False, soft_wrap=True)


def aside(line: str) -> None:
    """Print a line that is no result to the error stream, so that results can be compared and piped."""
    typer.echo(line, err=True)


def complain(problem: str) -> typer.Exit:
    """Raise what this gives: the command ends with status 2."""
    aside(problem)
    return typer.Exit(UNUSABLE)


@contextmanager
def complaints() -> Iterator[None]:
    """Turn errors in the input into a sentence and status 2."""
    try:
        yield
    except BdiError as error:
        raise complain(str(error)) from error
    except OSError as error:
        raise complain(f"cannot use {error.filename}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise complain(f"a file is not text in UTF-8: {error.reason}") from error


def load(path: Path, compatible: bool = False) -> Program:
    """The program in this file; its warnings go to the error stream. Raises AgentSpeakError, OSError."""
    options: dict[str, Any] = {"compatible": True} if compatible else {}
    try:
        program = load_program(path, **options)
    except UnicodeDecodeError as error:
        raise complain(f"{path} is not a text file in UTF-8: {error.reason}") from error
    except AgentSpeakSyntaxError as error:
        if path.suffix in ("", PROGRAM):
            raise
        raise complain(f"{error}\n{path} is no {PROGRAM} file: is it an agent program?") from error
    for warning in getattr(program, "warnings", ()):
        aside(f"warning: {warning}")
    return program
