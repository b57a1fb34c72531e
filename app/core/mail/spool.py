"""Mail as files in a folder, until a mail server is configured.

The file's name is the key of the sending: writing it a second time, after a crash say, changes nothing.
"""

import os
import re
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, TypeVar

from app.core.mail.message import Mail, message_of, name_of

UNFINISHED: Final = re.compile(r"[A-Za-z0-9._-]+\.eml\.tmp")
STALE_AFTER_S: Final = 3600.0
"""Real seconds. A younger file may be one that another process is writing."""

Given = TypeVar("Given")
Made = TypeVar("Made")


@dataclass(frozen=True)
class Unfinished:
    """A file that is written, but perhaps not on the disk yet."""

    descriptor: int
    path: str
    becomes: str


@dataclass(frozen=True)
class Spool:
    """A folder of .eml files, readable by the service's account alone."""

    folder: Path
    sender: str

    def send(self, mail: Mail) -> bool:
        """Write the file whole or not at all; False if this sending was written before."""
        unfinished = self._begin(mail)
        if unfinished is not None:
            _finish(unfinished)
        return unfinished is not None

    def file_of(self, mail: Mail) -> Path:
        return self.folder / f"{name_of(mail.key)}.eml"

    def files(self) -> Iterator[Path]:
        """Return all mails that are written whole."""
        return self.folder.glob("*.eml")

    def send_all(self, mails: Sequence[Mail]) -> list[Exception | None]:
        """The same for several: what went wrong with which, which is no other's concern.

        The disk is waited for when it has all of them to write, not after each.
        """
        begun = [_tried(self._begin, mail) for mail in mails]
        ended = [_tried(_finish, one) if isinstance(one, Unfinished) else one for one in begun]
        return [one if isinstance(one, Exception) else None for one in ended]

    def tidy(self) -> int:
        """Remove what a killed service has left half written, and nothing that is not of our naming."""
        before_s = time.time() - STALE_AFTER_S
        ours = (file for file in self.folder.glob("*.tmp") if UNFINISHED.fullmatch(file.name))
        stale = [file for file in ours if file.is_file() and file.lstat().st_mtime < before_s]
        for file in stale:
            file.unlink(missing_ok=True)
        return len(stale)

    def _begin(self, mail: Mail) -> Unfinished | None:
        path = f"{self.folder}/{name_of(mail.key)}.eml"
        if os.path.exists(path):  # noqa: PTH110  # a Path takes longer to make than the file to find
            return None
        contents = message_of(mail, self.sender).as_bytes()
        unfinished = f"{path}.tmp"
        descriptor = self._open(unfinished)
        try:
            _write(descriptor, contents)
            _begin_to_sync(descriptor)
        except BaseException:
            os.close(descriptor)
            raise
        return Unfinished(descriptor, unfinished, path)

    def _open(self, path: str) -> int:
        try:
            return os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
        except FileNotFoundError:  # the first mail of all
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            return os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)


def _write(descriptor: int, contents: bytes) -> None:
    written = 0
    while written < len(contents):
        written += os.write(descriptor, contents[written:])


def _begin_to_sync(descriptor: int) -> None:
    """Have the disk begin, without waiting for it. Where that cannot be said, the sync takes a little longer."""
    if hasattr(os, "posix_fadvise"):
        os.posix_fadvise(descriptor, 0, 0, os.POSIX_FADV_DONTNEED)


def _finish(unfinished: Unfinished) -> None:
    try:
        os.fsync(unfinished.descriptor)
    finally:
        os.close(unfinished.descriptor)
    os.replace(unfinished.path, unfinished.becomes)  # noqa: PTH105


def _tried(step: Callable[[Given], Made], given: Given) -> Made | Exception:
    try:
        return step(given)
    except Exception as problem:
        return problem
