"""Helpers shared by the maintainer's commands: which robot is meant, and how a command ends that cannot begin."""

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Annotated, NoReturn

import typer

from maps import CampusMapError
from robot.core.config import ConfigError, Settings, load_settings
from robot.ops.equipment import Equipment
from robot.simulated import SimulatedWorldError

UNFINISHED, MISUSE = 1, 2
INSTALLED = Path("/etc/campus-mail/robot.toml")
"""Where docs/how-to/install-a-robot.md puts the settings; the default of every command."""

OTHER_FOLDER = "Start it (systemctl start campus-mail-robot), or name the folder of one that runs: --data, --config."

ConfigOption = Annotated[
    Path | None,
    typer.Option("--config", envvar="CAMPUS_MAIL_ROBOT_CONFIG", help=f"Settings; default: {INSTALLED}, if there."),
]
DataOption = Annotated[Path | None, typer.Option("--data", help="Folder of the robot's memory, where it is another.")]
JsonOption = Annotated[bool, typer.Option("--json", help="One JSON object.")]


def refuse(sentence: str) -> NoReturn:
    """Exit status 2: something to put right first."""
    typer.echo(sentence, err=True)
    raise typer.Exit(MISUSE)


def settings_of(config: Path | None, data: Path | None = None) -> Settings:
    """The settings of the robot that is meant; ends the command if they are wrong."""
    try:
        return load_settings(settings_path(config), {"data": data})
    except ConfigError as problem:
        refuse(str(problem))


def settings_path(config: Path | None) -> Path | None:
    """The file that is meant, if there is one."""
    return config or (INSTALLED if INSTALLED.exists() else None)


@contextmanager
def simulated_bench(equipment: AbstractContextManager[Equipment]) -> Iterator[Equipment]:
    """A simulated robot's devices; ends the command if the settings allow none."""
    try:
        with equipment as opened:
            yield opened
    except (CampusMapError, SimulatedWorldError) as problem:
        refuse(str(problem))
