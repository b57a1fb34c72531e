"""A disk without room: a small file system of the test's own where that is allowed, else a limit on files' size."""

import os
import resource
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

SMALL = "3m"


@contextmanager
def small_disk(folder: Path) -> Iterator[None]:
    """Hold what is in `folder` on a disk of 3 MB."""
    if os.geteuid() != 0:
        yield
        return
    held = {file.name: file.read_bytes() for file in folder.iterdir()}
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={SMALL}", "tmpfs", folder], check=True)
    try:
        for name, contents in held.items():
            (folder / name).write_bytes(contents)
        yield
    finally:
        subprocess.run(["umount", "--lazy", folder], check=True)


@contextmanager
def no_room(folder: Path) -> Iterator[None]:
    """While this lasts nothing more can be written there."""
    if os.geteuid() != 0:
        with _no_file_grows():
            yield
        return
    ballast = folder / "ballast"
    try:
        with ballast.open("wb", buffering=0) as file:
            while True:
                file.write(bytes(4096))
    except OSError:  # full
        yield
    finally:
        ballast.unlink()


@contextmanager
def _no_file_grows() -> Iterator[None]:
    before, most = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1, most))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (before, most))
