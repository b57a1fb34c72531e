"""Output of every command: errors in sentences, tables for people, JSON for programs.

Exit status of every command: 0 done, 1 looked and found something wrong, 2 could not be done, and why is on stderr.
"""

import contextlib
import json
import sys
from collections.abc import Iterable, Iterator, Sequence
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.table import Table

from protocol.one_line import one_line

FOUND_WRONG, CANNOT, INTERRUPTED = 1, 2, 130
# Whatever is piped somewhere is not cut to the width of a terminal that is not there.
WIDTH_WITHOUT_TERMINAL = 160

AsJson = Annotated[bool, typer.Option("--json", help="One JSON document on stdout, for programs.")]
Email = Annotated[str, typer.Argument(help="Mail address of the person.")]


@contextlib.contextmanager
def demonstrating(what: str, *, as_json: bool, goes_on: bool) -> Iterator[None]:
    """Say what a demonstration starts before it is loaded, and, if Ctrl-C comes as early as that, that it stops.

    Where it `goes_on` until it is stopped, that is how it should end.
    """
    try:
        typer.echo(f"Campus Mail: starting {what} on this machine. Ctrl-C ends all of it.", err=as_json)
        with errors_in_words():
            yield
    except KeyboardInterrupt:
        typer.echo("Stopping: nothing has been started yet.", err=as_json)
        raise typer.Exit(0 if goes_on else INTERRUPTED) from None


@contextlib.contextmanager
def errors_in_words() -> Iterator[None]:
    """Print the error that keeps a command from its work as a sentence on stderr, never a traceback; exit code 2.

    Of its own accord a command speaks of what it knows; a disk that is full or gone may show anywhere.
    """
    try:
        yield
    except Exception as error:
        sentence = _sentence_of(error)
        if sentence is None:
            raise
        typer.echo(f"campus-mail: {sentence}", err=True)
        raise typer.Exit(CANNOT) from None


def _sentence_of(error: Exception) -> str | None:
    """None for an unforeseen error. Imports late: a demonstration speaks before it has loaded any of this."""
    from sqlalchemy.exc import DBAPIError

    from app.core.errors import ServiceError, StartError

    match error:
        case StartError() | ServiceError():
            return str(error)
        case DBAPIError():
            return f"The database could not be used, and nothing was changed: {error.orig}."
        case OSError():
            return f"{error.filename or 'Something'} could not be used: {error.strerror or error}."
    return None


def console() -> Console:
    """stdout, as wide as its terminal."""
    return Console() if sys.stdout.isatty() else Console(width=WIDTH_WITHOUT_TERMINAL)


def say_json(document: object) -> None:
    """Print for a program."""
    print(json.dumps(document, indent=2, ensure_ascii=False, default=str))


def say_table(columns: Sequence[str], rows: Iterable[Sequence[Any]], nothing: str) -> None:
    """Print for a person; `nothing` is the sentence for no rows."""
    table = Table(*columns, box=None, pad_edge=False)
    for row in rows:
        table.add_row(*(_in_words(value) for value in row))
    if table.row_count:
        console().print(table, markup=False)
    else:
        typer.echo(nothing)


def _in_words(value: object) -> str:
    if value is None or value == []:
        return "–"
    return one_line(", ".join(str(one) for one in value) if isinstance(value, list) else str(value))
