"""How every command speaks: errors in sentences, tables for people, JSON for programs.

Exit status of every command: 0 done, 1 looked and found something wrong, 2 could not be done, and why is on stderr.
"""

import contextlib
import json
import sys
from collections.abc import Iterable, Iterator, Sequence
from typing import Annotated, Any, NoReturn

import typer
from rich.console import Console
from rich.table import Table
from sqlalchemy.exc import DBAPIError

from app.errors import ServiceError, StartError
from app.settings import Settings, load_settings
from app.settings_errors import in_sentences

FOUND_WRONG, CANNOT = 1, 2
# Whatever is piped somewhere is not cut to the width of a terminal that is not there.
WIDTH_WITHOUT_TERMINAL = 160

AsJson = Annotated[bool, typer.Option("--json", help="One JSON document on stdout, for programs.")]
Email = Annotated[str, typer.Argument(help="Mail address of the person.")]


class Refused(StartError):
    """A command will not do this; the sentence says why and what to do instead."""


@contextlib.contextmanager
def errors_in_words() -> Iterator[None]:
    """What keeps a command from its work is a sentence on stderr and exit code 2, never a traceback.

    Of its own accord a command speaks of what it knows; a disk that is full or gone may show anywhere.
    """
    try:
        yield
    except (StartError, ServiceError) as error:
        _say_why(str(error))
    except DBAPIError as error:
        _say_why(f"The database could not be used, and nothing was changed: {error.orig}.")
    except OSError as error:
        _say_why(f"{error.filename or 'Something'} could not be used: {error.strerror or error}.")


def _say_why(sentence: str) -> NoReturn:
    typer.echo(f"campus-mail: {sentence}", err=True)
    raise typer.Exit(CANNOT) from None


def settings_with(**given: object) -> Settings:
    """The settings of the environment, and what was given as an option. Raises StartError."""
    settings = load_settings()
    wanted = {name: value for name, value in given.items() if value is not None}
    try:
        return Settings.model_validate({**settings.model_dump(), **wanted})
    except ValueError as error:
        raise StartError(f"The options cannot be used. {in_sentences(error, Settings.model_fields)}") from None


def console() -> Console:
    """stdout, as wide as its terminal."""
    return Console() if sys.stdout.isatty() else Console(width=WIDTH_WITHOUT_TERMINAL)


def say_json(document: object) -> None:
    """What a program reads."""
    print(json.dumps(document, indent=2, ensure_ascii=False, default=str))


def say_table(columns: Sequence[str], rows: Iterable[Sequence[Any]], nothing: str) -> None:
    """What a person reads; `nothing` is the sentence for no rows."""
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
    return ", ".join(str(one) for one in value) if isinstance(value, list) else str(value)
