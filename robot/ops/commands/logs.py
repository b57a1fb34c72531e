"""`logs`: what the daemon has written, and what a black box holds."""

import shutil
import subprocess
from pathlib import Path
from typing import Annotated

import typer

from robot.core.config import Settings
from robot.core.errors import RobotError
from robot.core.json_socket import ask
from robot.drive_loop.black_box import rows
from robot.ops.black_box_table import table
from robot.ops.commands.asking import OTHER_FOLDER, UNFINISHED, ConfigOption, DataOption, refuse, settings_of
from robot.ops.control import SOCKET_NAME

UNIT = "campus-mail-robot"
NEWEST_LINES = 100
LOOK_THERE = "Is it installed, and has it run (systemctl status {unit})? If so, ask as root: not everybody may read it."
WRITES_ELSEWHERE = (
    "A daemon started by hand writes to its terminal, or into a file if the setting log_file names one (--config)."
)


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
    except RobotError as error:
        refuse(f"{error} {OTHER_FOLDER}")
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
    """By the tools that every system has: they know rotated files and journals. The exit status."""
    if file is None:
        return journal_of(UNIT, newest, follow)
    if not file.exists() and not follow:
        refuse(f"{file} (the setting log_file) is not there yet. Has the daemon run with these settings?")
    return _run(["tail", "-n", str(newest), *(["-F"] if follow else []), "--", str(file)])


def journal_of(unit: str, newest: int, follow: bool) -> int:
    """Print systemd's journal of this unit. Where it has nothing, that is said; --follow then waits for more."""
    journalctl = ["journalctl", "--no-pager", "--unit", unit]
    if not shutil.which(journalctl[0]):
        refuse(f"There is no journalctl here, since there is no systemd. {WRITES_ELSEWHERE}")
    if not subprocess.run([*journalctl, "--quiet", "-n", "1"], check=False, capture_output=True).stdout:
        nothing = (
            f"The journal has nothing of {unit} that you may read. {LOOK_THERE.format(unit=unit)} {WRITES_ELSEWHERE}"
        )
        if not follow:
            refuse(nothing)
        typer.echo(nothing, err=True)
    return _run([*journalctl, "-n", str(newest), *(["-f"] if follow else [])])


def _run(command: list[str]) -> int:
    try:
        return UNFINISHED if subprocess.run(command, check=False).returncode else 0
    except KeyboardInterrupt:
        return 0
