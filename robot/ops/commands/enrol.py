"""`enrol`: this robot becomes known to a service."""

import sys
from pathlib import Path
from typing import Annotated

import typer

from robot.core.config import ConfigError, load_settings
from robot.core.settings_file import write_settings
from robot.link.enrolment import checked_token, keep_secret, token_for
from robot.mission.signatures import new_key
from robot.ops.commands.asking import INSTALLED, UNFINISHED, ConfigOption, refuse
from robot.ops.doctor.findings import Grade
from robot.ops.doctor.service import asked


def enrol(
    name: Annotated[str, typer.Argument(help="The robot's name, as the service knows it.")],
    server: Annotated[str, typer.Argument(help="wss://HOST/api/v1/robots/link")],
    config: ConfigOption = None,
    token_file: Annotated[
        Path | None, typer.Option(help="Where to keep the token; default: NAME.token by the settings. The key: beside.")
    ] = None,
    code_stdin: Annotated[
        bool, typer.Option("--code-stdin", help="Read the code from stdin; else ask for it.")
    ] = False,
    token: Annotated[bool, typer.Option("--token", help="Ask for a token, not for a code.")] = False,
    token_stdin: Annotated[bool, typer.Option("--token-stdin", help="Read a token from stdin.")] = False,
) -> None:
    """Make this robot known to a service: keep its token and key, write name, server and both files into the settings.

    At the service, `python -m app robots enrol NAME` prints a one-time code. This robot makes a key, by which its
    receipts will be known, and exchanges the code for its token; both go into files that only their owner may read.
    With a token (`robots enrol NAME --token`) there is no key, and receipts are shown as unsigned.

    Exit status 1: the service refuses the token; nothing was written.
    """
    settings_file = config or INSTALLED
    token_path = (token_file or settings_file.parent / f"{name}.token").absolute()
    try:
        _check(name, server)
        if token or token_stdin:
            files = _by_token(server, token_path, from_stdin=token_stdin)
        else:
            files = _by_code(name, server, token_path, from_stdin=code_stdin)
        write_settings(settings_file, {"name": name, "server": server, **files})
    except ConfigError as problem:
        refuse(str(problem))
    print(f"{name} is enrolled: {', '.join(files.values())}; settings in {settings_file}.")
    print("A running daemon takes it at its next start: sudo systemctl restart campus-mail-robot")


def _by_code(name: str, server: str, token_path: Path, from_stdin: bool) -> dict[str, str]:
    pem, public_key = new_key()
    key_path = token_path.with_suffix(".key")
    code = sys.stdin.read() if from_stdin else typer.prompt("Code")
    # The key first: a code that was used up for a key that could not be kept would be lost.
    unfinished = key_path.with_suffix(".key.new")
    keep_secret(unfinished, pem, "key_file")
    try:
        keep_secret(token_path, token_for(code, name, server, public_key), "token_file")
        unfinished.replace(key_path)
    finally:
        unfinished.unlink(missing_ok=True)
    return {"token_file": str(token_path), "key_file": str(key_path)}


def _by_token(server: str, token_path: Path, from_stdin: bool) -> dict[str, str]:
    token = checked_token(sys.stdin.read() if from_stdin else typer.prompt("Token", hide_input=True))
    _verify(server, token)
    keep_secret(token_path, token, "token_file")
    return {"token_file": str(token_path)}


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
