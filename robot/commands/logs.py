"""`logs`: what the daemon has written, and what a black box holds."""

import subprocess
from pathlib import Path
from typing import Annotated

import typer

from ..black_box import rows
from ..black_box_table import table
from ..config import Settings
from ..control import SOCKET_NAME
from ..errors import RobotError
from ..json_socket import ask
from .asking import OTHER_FOLDER, UNFINISHED, ConfigOption, DataOption, refuse, settings_of

UNIT = "campus-mail-robot"
NEWEST_LINES = 100


def logs(
    config: ConfigOption = None,
    data: DataOption = None,
    follow: Annotated[bool, typer.Option("--follow", "-f", help="Go on until Ctrl-C.")] = False,
    lines: Annotated[int, typer.Option("--lines", "-n", min=1, help="So many of the newest.")] = NEWEST_LINES,
    black_box: Annotated[Path | None, typer.Option("--black-box", help="Show this file as a table.")] = None,
    dump: Annotated[
        bool, typer.Option("--dump", help="Have the running robot write its black box; show the table.")
    ] = False,
    raw: Annotated[bool, typer.Option("--raw", help="Of a black box every byte, not only what changed.")] = False,
) -> None:
    """The daemon's log: the file of the setting log_file, or systemd's journal.

    A black box (in the folder black_box of the data folder) holds the last minute before a fault: what the base said
    and was told, what was decided, perceived and done. --black-box FILE shows one; --dump writes one now.
    """
    settings = settings_of(config, data)
    if dump:
        black_box = _dumped(settings)
    if black_box:
        _show(black_box, raw)
    else:
        raise typer.Exit(_shown(settings.log_file, lines, follow))


def _dumped(settings: Settings) -> Path:
    try:
        answer = ask(settings.data / SOCKET_NAME, {"do": "black_box"}, limit_s=15.0)
    except RobotError as nobody:
        refuse(f"{nobody} {OTHER_FOLDER}")
    if not answer["ok"]:
        refuse(answer["error"])
    return Path(answer["file"])


def _show(file: Path, raw: bool) -> None:
    try:
        for line in table(rows(file), raw):
            print(line)
    except RobotError as problem:
        refuse(str(problem))


def _shown(file: Path | None, newest: int, follow: bool) -> int:
    """By the tools that every system has: they know rotated files and journals. Their exit status."""
    if file is None:
        command = ["journalctl", "--no-pager", "-u", UNIT, "-n", str(newest), *(["-f"] if follow else [])]
        way_out = "Set log_file where there is no systemd."
    else:
        command = ["tail", "-n", str(newest), *(["-F"] if follow else []), "--", str(file)]
        way_out = "Has the daemon run with these settings?"
    try:
        return UNFINISHED if subprocess.run(command, check=False).returncode else 0
    except FileNotFoundError:
        refuse(f"There is no {command[0]} here. {way_out}")
    except KeyboardInterrupt:
        return 0
