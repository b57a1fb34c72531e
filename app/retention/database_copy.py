"""A copy of the database as it is at one moment, while others write, and a look at whether the copy is sound."""

import os
import shutil
import sqlite3
import subprocess
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any, Final

from sqlalchemy import Connection, create_engine, func, make_url, select
from sqlalchemy.engine import URL

from app.core.database.schema_version import DatabaseUnusable, refuse_unknown, revision_of
from app.core.errors import StartError
from app.core.settings import Settings
from app.models import metadata
from app.retention.database_checks import problems_of

SQLITE_COPY: Final = "campus-mail.sqlite"
POSTGRESQL_COPY: Final = "campus-mail.dump"
COUNTED: Final = ("people", "orders", "order_events", "notices", "robots")
POLL_EVERY_S: Final = 0.2


class CopyUnsound(StartError):
    """The copy is not a database to rely on."""


def copy_database(
    settings: Settings, folder: Path, progress: Callable[[float], None]
) -> tuple[str, dict[str, int], str]:
    """Name of the copy in `folder`, rows by table, schema revision. Raises DatabaseUnusable, CopyUnsound."""
    url = make_url(settings.url_of_database)
    if url.get_backend_name() != "sqlite":
        dump_postgresql(url, folder / POSTGRESQL_COPY)
        return POSTGRESQL_COPY, {}, "in the dump"
    copy = folder / SQLITE_COPY
    _copy_sqlite(Path(url.database or ""), copy, progress)
    rows, revision = check_copy(folder, "the database")
    return SQLITE_COPY, rows, revision


def check_copy(folder: Path, name: str) -> tuple[dict[str, int], str]:
    """Rows by table and revision of a SQLite copy that is whole. Raises CopyUnsound, NewerDatabase.

    Of a dump PostgreSQL's own tools have to judge: they refuse one that is damaged.
    """
    copy = folder / SQLITE_COPY
    if not copy.exists():
        return {}, ""
    engine = create_engine(f"sqlite:///{copy}")
    try:
        with engine.connect() as connection:
            found = problems_of(connection)
            if found:
                raise CopyUnsound(
                    f"What {name} holds is not sound, and is not to be relied on: {'; '.join(found[:5])}."
                )
            revision = revision_of(connection) or ""
            refuse_unknown(revision)
            return _counts(connection), revision
    finally:
        engine.dispose()


def _counts(connection: Connection) -> dict[str, int]:
    tables = (metadata.tables[name] for name in COUNTED)
    return {table.name: connection.scalar(select(func.count()).select_from(table)) or 0 for table in tables}


def _copy_sqlite(source: Path, copy: Path, progress: Callable[[float], None]) -> None:
    """In one step: a copy in many steps begins anew whenever a writer comes in between, and under load never ends."""
    if not source.is_file():
        raise DatabaseUnusable(f"There is no database at {source}. Which data folder is meant? CAMPUS_MAIL_DATA.")
    copy.touch(mode=0o600)
    try:
        with (
            closing(sqlite3.connect(f"file:{source}?mode=ro", uri=True)) as old,
            closing(sqlite3.connect(copy)) as new,
            _watched(copy, source.stat().st_size, progress),
        ):
            old.backup(new, pages=-1)
            new.execute("PRAGMA journal_mode=DELETE")
    except sqlite3.Error as error:
        raise DatabaseUnusable(f"The database {source} cannot be copied: {error}.") from error


@contextmanager
def _watched(copy: Path, size: int, progress: Callable[[float], None]) -> Iterator[None]:
    """Tell how far a copy has grown until it is done."""
    done = threading.Event()

    def watch() -> None:
        while not done.wait(POLL_EVERY_S):
            progress(min(copy.stat().st_size / max(size, 1), 1.0))

    watcher = threading.Thread(target=watch)
    watcher.start()
    try:
        yield
    finally:
        done.set()
        watcher.join()
        progress(1.0)


def dump_postgresql(url: URL, to: Path) -> None:
    """PostgreSQL's own dump, in its own format. Raises DatabaseUnusable."""
    _postgresql("pg_dump", url, "--format=custom", "--no-owner", f"--file={to}")
    to.chmod(0o600)


def load_postgresql(url: URL, dump: Path) -> None:
    """Put a dump in the place of what is there, all or nothing. Raises DatabaseUnusable."""
    words = ("--clean", "--if-exists", "--no-owner", "--single-transaction", "--exit-on-error")
    _postgresql("pg_restore", url, *words, f"--dbname={url.database}", str(dump))


def _postgresql(program: str, url: URL, *words: str) -> None:
    if shutil.which(program) is None:
        raise DatabaseUnusable(
            f"{program} is not on this machine's PATH. Install PostgreSQL's client programs (apt install "
            "postgresql-client), of the server's version or a newer one."
        )
    ran = subprocess.run(
        [program, *words], env=_libpq(url), stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False
    )
    if ran.returncode != 0:
        raise DatabaseUnusable(f"{program} failed: {ran.stderr.strip()}")


def _libpq(url: URL) -> Mapping[str, str]:
    """Where and as whom, for PostgreSQL's programs; in the environment, since others can read command lines."""
    query: Mapping[str, Any] = url.query
    given = {
        "PGHOST": url.host or query.get("host"),
        "PGPORT": url.port,
        "PGUSER": url.username,
        "PGPASSWORD": url.password,
        "PGDATABASE": url.database,
    }
    return {**os.environ, **{name: str(value) for name, value in given.items() if value is not None}}
