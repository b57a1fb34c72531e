"""`enrol`: this robot becomes known to a service."""

import sys
from pathlib import Path
from typing import Annotated

import typer

from ..config import ConfigError, load_settings
from ..doctor.findings import Grade
from ..doctor.service import asked
from ..enrolment import checked_token, keep_token
from ..settings_file import write_settings
from .asking import INSTALLED, UNFINISHED, ConfigOption, refuse


def enrol(
    name: Annotated[str, typer.Argument(help="The robot's name, as the service knows it.")],
    server: Annotated[str, typer.Argument(help="wss://HOST/api/v1/robots/link")],
    config: ConfigOption = None,
    token_file: Annotated[
        Path | None, typer.Option(help="Where to keep it; default: NAME.token by the settings.")
    ] = None,
    token_stdin: Annotated[
        bool, typer.Option("--token-stdin", help="Read the token from stdin; else ask for it.")
    ] = False,
) -> None:
    """Make this robot known to a service: keep its token, write name, server and token_file into the settings.

    At the service, `python -m app robots enrol NAME` prints the token, once. Here it goes into a file that only its
    owner may read. The service is asked first whether it takes the token; if it cannot be reached, that is said.

    Exit status 1: the service refuses the token; nothing was written.
    """
    settings_file = config or INSTALLED
    try:
        _check(name, server)
        token = checked_token(sys.stdin.read() if token_stdin else typer.prompt("Token", hide_input=True))
        _verify(server, token)
        path = (token_file or settings_file.parent / f"{name}.token").absolute()
        keep_token(path, token)
        write_settings(settings_file, {"name": name, "server": server, "token_file": str(path)})
    except ConfigError as problem:
        refuse(str(problem))
    print(f"{name} is enrolled: token in {path}, settings in {settings_file}.")
    print("A running daemon takes it at its next start: sudo systemctl restart campus-mail-robot")


def _check(name: str, server: str) -> None:
    """Before a secret is asked for."""
    load_settings(None, {"name": name, "server": server})


def _verify(server: str, token: str) -> None:
    finding = asked(server, token)
    if finding.grade is Grade.FAIL:
        typer.echo(f"{finding.said}. Nothing was written.\n{finding.way_out}", err=True)
        raise typer.Exit(UNFINISHED)
    if finding.grade is Grade.WARN:
        typer.echo(f"The token could not be tried: {finding.said}", err=True)
