"""`settings`: every key with its default, or whether a file is right."""

from pathlib import Path
from typing import Annotated

import typer

from bdi import BdiError
from maps import CampusMapError
from robot.core.config import ConfigError, load_settings
from robot.core.settings_file import complete_toml
from robot.ops.assembly import check_settings
from robot.ops.commands.asking import refuse


def settings(
    check: Annotated[Path | None, typer.Option(help="Say whether this file is right, and what is not.")] = None,
) -> None:
    """Print a complete settings file: every key, its meaning, its range and its default.

    With --check the file is read as the daemon would: keys, values, map, home dock, agent program, token file.
    Exit status 2: something in it is wrong, which is named.
    """
    if check is None:
        print(complete_toml(), end="")
        return
    try:
        check_settings(load_settings(check, {}))
    except (ConfigError, CampusMapError, BdiError) as problem:
        text = str(problem).removeprefix("settings: ")
        refuse(text if text.startswith(str(check)) else f"{check}: {text}")
    print(f"{check} is right.")
