"""A robot becomes known to a service: its token into a file of its own, name and address into the settings."""

import os
import re
import tempfile
from pathlib import Path

from .config import ConfigError
from .durable_file import replace

LONGEST_TOKEN = 512
_TOKEN = re.compile(r"[\x21-\x7e]+")


def checked_token(text: str) -> str:
    """Without the line's end. Raises ConfigError when it cannot be one: nothing, or more than one word."""
    token = text.strip()
    if not _TOKEN.fullmatch(token) or len(token) > LONGEST_TOKEN:
        way_out = "`python -m app robots enrol NAME` at the service prints it, once."
        raise ConfigError("the token", "token", "is one word of printable characters", way_out)
    return token


def keep_token(path: Path, token: str) -> None:
    """Write it, readable by its owner alone from the first moment. Raises ConfigError."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)  # mkstemp makes it 0600
        with os.fdopen(handle, "w", encoding="ascii") as file:
            file.write(f"{token}\n")
            file.flush()
            os.fsync(file.fileno())
        replace(Path(name), path)
    except OSError as error:
        way_out = "Run this as the robot's user: sudo -u campus-mail …"
        raise ConfigError(str(path), "token_file", f"cannot be written: {error.strerror}", way_out) from None
