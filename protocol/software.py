"""The version of this software, as service and robot give it to each other and to people."""

import tomllib
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Final

PROJECT: Final = Path(__file__).parents[1] / "pyproject.toml"


@cache
def version() -> str:
    """Return the version in pyproject.toml, or of the wheel that was installed."""
    if not PROJECT.is_file():
        return metadata.version("campus-mail")
    return str(tomllib.loads(PROJECT.read_text())["project"]["version"])
