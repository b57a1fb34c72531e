"""Makes the folders of a demonstration, and removes them afterwards."""

import tempfile
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from app.demo.run import run
from app.demo.settings import Demo
from app.logs import set_up_logs


def demonstrate(data: Path | None, **wanted: Any) -> int:
    """Run a demonstration in `data`, or in a folder that is gone afterwards; the exit code. Raises StartError."""
    set_up_logs("WARNING")
    with ExitStack() as closing:
        door_folder = Path(closing.enter_context(tempfile.TemporaryDirectory(prefix="cm-")))
        folder = _folder(data, closing)
        return run(Demo(folder=folder, door=door_folder / "door", **wanted))


def _folder(wanted: Path | None, closing: ExitStack) -> Path:
    if wanted is None:
        return Path(closing.enter_context(tempfile.TemporaryDirectory(prefix="campus-mail-demo-")))
    wanted.mkdir(parents=True, exist_ok=True)
    wanted.chmod(0o700)
    return wanted.resolve()
