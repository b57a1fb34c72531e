"""Putting a backup in the place of what is there; what was there is kept aside, never overwritten."""

import shutil
from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import Final

from sqlalchemy import make_url
from sqlalchemy.engine import URL

from app.core.errors import StartError
from app.core.settings import Settings
from app.retention.backup import Manifest, keys_of, opened
from app.retention.data_folder_lock import the_only_one
from app.retention.database_copy import POSTGRESQL_COPY, SQLITE_COPY, dump_postgresql, load_postgresql

STOP_IT: Final = "Stop it first (systemctl stop campus-mail): no process may write while the database is exchanged."


class RestoreRefused(StartError):
    """Something is in the way that a restore would put aside; nothing has been changed."""


def restore(
    settings: Settings, archive: Path, now: datetime, *, replace: bool, is_empty: Callable[[], bool]
) -> tuple[Manifest, Path | None]:
    """The manifest of what is in place now, and the folder with what was there before.

    `is_empty` says of a PostgreSQL database whether anything is in it. Raises AlreadyRunning, RestoreRefused,
    BackupUnusable, CopyUnsound, NewerDatabase, having changed nothing.
    """
    with the_only_one(settings, STOP_IT), opened(archive, settings.data) as (folder, manifest):
        url = make_url(settings.url_of_database)
        _refuse_another_kind(url, manifest)
        in_the_way = _in_the_way(settings, url, manifest)
        if (in_the_way or not is_empty()) and not replace:
            named = ", ".join(path.name for path in in_the_way) or "a database"
            raise RestoreRefused(f"{settings.data} has {named} already. To put it aside and go on: --replace.")
        aside = _put_aside(settings, in_the_way, now) if replace else None
        if manifest.database == "postgresql":
            if aside is not None:
                dump_postgresql(url, aside / POSTGRESQL_COPY)
            load_postgresql(url, folder / POSTGRESQL_COPY)
        _put_in_place(settings, url, folder, manifest, aside)
        return manifest, aside


def _refuse_another_kind(url: URL, manifest: Manifest) -> None:
    here = url.get_backend_name()
    if here != manifest.database:
        raise RestoreRefused(
            f"The backup is of a {manifest.database} database, and CAMPUS_MAIL_DATABASE_URL names {here}. "
            "Set the URL to a database of the backup's kind."
        )


def _in_the_way(settings: Settings, url: URL, manifest: Manifest) -> list[Path]:
    """The database with its log, and the keys that the backup would write over."""
    held = {file.name for file in manifest.files}
    keys = [path for name, path in keys_of(settings).items() if name in held and path.exists()]
    if manifest.database != "sqlite":
        return keys
    database = Path(url.database or "")
    files = [database.with_name(database.name + ending) for ending in ("", "-wal", "-shm")]
    return [*(path for path in files if path.exists()), *keys]


def _put_aside(settings: Settings, files: list[Path], now: datetime) -> Path:
    aside = settings.data / f"before-restore-{now:%Y%m%dT%H%M%SZ}"
    aside.mkdir(mode=0o700)
    for path in files:
        shutil.move(path, aside / path.name)
    return aside


def _put_in_place(settings: Settings, url: URL, folder: Path, manifest: Manifest, aside: Path | None) -> None:
    places = {SQLITE_COPY: Path(url.database or ""), **keys_of(settings)}
    files = [file.name for file in manifest.files if file.name in places and file.name != POSTGRESQL_COPY]
    put: list[Path] = []
    try:
        for name in files:
            shutil.move(folder / name, places[name])
            put.append(places[name])
    except OSError as error:
        if manifest.database == "postgresql":
            done = "The database is restored, its keys are not: take them out of the archive."
        else:
            _put_back(put, [*places.values()], aside)
            done = "Nothing has been changed."
        raise RestoreRefused(f"{error.filename} cannot be written: {error.strerror}. {done}") from None


def _put_back(put: list[Path], places: list[Path], aside: Path | None) -> None:
    """As it was: away with what came out of the archive, and what was put aside comes back to where it was."""
    for path in put:
        path.unlink()
    if aside is None:
        return
    homes = {path.name: path.parent for path in places}
    for kept in list(aside.iterdir()):
        database = kept.name.removesuffix("-wal").removesuffix("-shm")
        shutil.move(kept, homes[database] / kept.name)
    aside.rmdir()
