"""A backup: one archive with the database as it was at one moment, the service's keys, and a manifest to check it by.

The keys belong to it: without the server key no hand-over code in anybody's mail fits any more, and without the push
keys no browser is reached. So an archive is as secret as the data folder itself.
"""

import json
import os
import tarfile
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime
from hashlib import file_digest
from pathlib import Path
from typing import Final

from pydantic import BaseModel, ValidationError

from app.core.errors import StartError
from app.core.settings import Settings
from app.retention.database_copy import SQLITE_COPY, check_copy, copy_database

MANIFEST: Final = "manifest.json"
FORMAT: Final = 1

Progress = Callable[[float], None]
"""Called with the part that is done, 0 to 1."""


class BackupFailed(StartError):
    """No archive was left behind."""


class BackupUnusable(StartError):
    """Not an archive of ours, or not as it was written."""


class Entry(BaseModel):
    """One file of the archive."""

    name: str
    bytes: int
    sha256: str


class Manifest(BaseModel):
    """The contents of an archive; `left_out` says what it does not hold and why."""

    format: int
    version: str
    made_at: datetime
    revision: str
    database: str
    rows: dict[str, int]
    files: list[Entry]
    left_out: dict[str, str]


@dataclass(frozen=True)
class BackupRequest:
    """A request for a backup: of what, by which version, when."""

    settings: Settings
    version: str
    now: datetime
    with_keys: bool = True


def back_up(request: BackupRequest, to: Path, progress: Progress) -> Manifest:
    """Write the archive whole or not at all, beside a running service. Raises BackupFailed, DatabaseUnusable."""
    if to.exists():
        raise BackupFailed(f"{to} exists already, and no backup is written over. Choose another name.")
    try:
        with tempfile.TemporaryDirectory(prefix=".backup-", dir=to.parent) as folder:
            manifest = _gather(request, Path(folder), progress)
            unfinished = Path(folder) / "archive"
            _pack(Path(folder), [MANIFEST, *(file.name for file in manifest.files)], unfinished)
            unfinished.replace(to)
    except OSError as error:
        raise BackupFailed(f"{to} cannot be written: {error.strerror}.") from error
    _sync(to.parent)
    return manifest


def _gather(request: BackupRequest, folder: Path, progress: Progress) -> Manifest:
    name, rows, revision = copy_database(request.settings, folder, progress)
    keys = _copy_keys(request.settings, folder) if request.with_keys else []
    left_out = {"spool": "mails that were sent", "map": "belongs to the installation, as the settings do"}
    if not request.with_keys:
        left_out["keys"] = "as wished; without them no hand-over code that was mailed fits any more"
    manifest = Manifest(
        format=FORMAT,
        version=request.version,
        made_at=request.now,
        revision=revision,
        database="sqlite" if name == SQLITE_COPY else "postgresql",
        rows=rows,
        files=[_entry(folder / file) for file in (name, *keys)],
        left_out=left_out,
    )
    (folder / MANIFEST).write_text(manifest.model_dump_json(indent=2))
    return manifest


def keys_of(settings: Settings) -> dict[str, Path]:
    """Where the service's keys lie, by their names in an archive."""
    return {"server.key": settings.server_key_path, "push.key": settings.push_key_path}


def _copy_keys(settings: Settings, folder: Path) -> list[str]:
    there = {name: path for name, path in keys_of(settings).items() if path.is_file()}
    for name, path in there.items():
        (folder / name).touch(mode=0o600)
        (folder / name).write_bytes(path.read_bytes())
    return list(there)


def _entry(path: Path) -> Entry:
    with path.open("rb") as file:
        return Entry(name=path.name, bytes=path.stat().st_size, sha256=file_digest(file, "sha256").hexdigest())


def _pack(folder: Path, names: list[str], to: Path) -> None:
    with os.fdopen(os.open(to, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as file:
        with tarfile.open(fileobj=file, mode="w:gz", compresslevel=3) as archive:
            for name in names:
                archive.add(folder / name, arcname=name)
        file.flush()
        os.fsync(file.fileno())


def _sync(folder: Path) -> None:
    """A name that was just given survives a power cut only once its folder is on disk."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


@contextmanager
def opened(archive: Path, beside: Path) -> Iterator[tuple[Path, Manifest]]:
    """The files of an archive in a folder below `beside`, each as the manifest says. Raises BackupUnusable."""
    with tempfile.TemporaryDirectory(prefix=".restore-", dir=beside) as folder:
        try:
            with tarfile.open(archive, "r:gz") as file:
                file.extractall(folder, filter="data")
            manifest = Manifest.model_validate_json((Path(folder) / MANIFEST).read_text())
        except (OSError, tarfile.TarError, EOFError, ValidationError, json.JSONDecodeError) as error:
            raise _not_opened(archive, error) from error
        _compare(archive, Path(folder), manifest)
        check_copy(Path(folder), archive.name)
        yield Path(folder), manifest


def _not_opened(archive: Path, error: Exception) -> BackupUnusable:
    """A file that cannot be read, or a disk without room for what is in it, says nothing against the archive."""
    if isinstance(error, OSError) and error.strerror:
        return BackupUnusable(f"{archive} cannot be opened: {error.strerror}. Nothing has been changed.")
    reason = "its manifest cannot be read" if isinstance(error, ValidationError) else str(error)
    return BackupUnusable(f"{archive} is no backup of Campus Mail: {reason}.")


def _compare(archive: Path, folder: Path, manifest: Manifest) -> None:
    if manifest.format > FORMAT:
        raise BackupUnusable(
            f"{archive} was written by a newer version ({manifest.version}). Restore it with that one."
        )
    for file in manifest.files:
        path = folder / file.name
        if Path(file.name).name != file.name or not path.is_file() or _entry(path) != file:
            raise BackupUnusable(f"{archive} is damaged: {file.name} is not what was written. Take another backup.")
