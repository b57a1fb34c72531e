"""How every command ends that cannot begin."""

from typing import NoReturn

import typer

UNFINISHED, MISUSE = 1, 2


def refuse(sentence: str) -> NoReturn:
    """Exit status 2: something to put right first."""
    typer.echo(sentence, err=True)
    raise typer.Exit(MISUSE)
