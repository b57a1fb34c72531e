"""One service to a data folder: the holder of its lock may serve from it, or put another database in its place."""

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from app.core.errors import StartError
from app.core.settings import Settings, make_data_folder

LOCK_NAME: Final = "service.lock"


class AlreadyRunning(StartError):
    """A service works in this data folder."""


@contextmanager
def the_only_one(settings: Settings, otherwise: str) -> Iterator[None]:
    """Lock the data folder; the lock ends with the process, however that ends. Raises AlreadyRunning."""
    make_data_folder(settings)
    path = settings.data / LOCK_NAME
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    with os.fdopen(descriptor, "r+") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            holder = file.read().strip() or "unknown"
            raise AlreadyRunning(f"A service is running in {settings.data} (process {holder}). {otherwise}") from None
        file.truncate(0)
        file.write(str(os.getpid()))
        file.flush()
        yield
