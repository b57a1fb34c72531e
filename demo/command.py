"""Makes the folders of a demonstration, and removes them afterwards."""

import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from app.core.logs import set_up_logs
from demo.fleet.run import run as run_fleet
from demo.fleet.settings import FleetDemo
from demo.run import run
from demo.settings import Demo


def demonstrate(data: Path | None, **wanted: Any) -> int:
    """Run a demonstration in `data`, or in a folder that is gone afterwards; the exit code. Raises StartError."""
    with _places(data) as (folder, door):
        return run(Demo(folder=folder, door=door, **wanted))


def demonstrate_fleet(data: Path | None, **wanted: Any) -> int:
    """The same with several robots. Raises StartError."""
    with _places(data) as (folder, door):
        return run_fleet(FleetDemo(folder=folder, door=door, **wanted))


@contextmanager
def _places(data: Path | None) -> Iterator[tuple[Path, Path]]:
    """Where everything lies, and where there will be a door: sockets have short paths."""
    set_up_logs("WARNING")
    with ExitStack() as closing:
        door_folder = Path(closing.enter_context(tempfile.TemporaryDirectory(prefix="cm-")))
        yield _folder(data, closing), door_folder / "door"


def _folder(wanted: Path | None, closing: ExitStack) -> Path:
    if wanted is None:
        return Path(closing.enter_context(tempfile.TemporaryDirectory(prefix="campus-mail-demo-")))
    wanted.mkdir(parents=True, exist_ok=True)
    wanted.chmod(0o700)
    return wanted.resolve()
