"""The robot's one database file: what must survive a power cut.

SQLite with a write-ahead log and *full* sync: when a transaction returns, it is on the disk. Outbox and memory share
the file, so that "the mail is aboard" and "tell the server so" are one transaction: both happen, or neither.

StoreError
├── StorageFull    no room left; nothing of the transaction was written
├── StorageFailed  the disk or the file cannot be read or written
├── StorageInUse   another process has this file
└── StorageNewer   written by a later version of this program
"""

import fcntl
import sqlite3
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final, Self, TextIO

from robot.core.errors import RobotError

LAYOUT_VERSION: Final = 1
MAX_BYTES: Final = 64 * 1024 * 1024
"""Some 100,000 events: months without a server. A bound, so that a full outbox is an error here and not a full disk."""

_LAYOUT: Final = """
CREATE TABLE outbox (seq INTEGER PRIMARY KEY AUTOINCREMENT, type TEXT NOT NULL, body TEXT NOT NULL);
CREATE TABLE inbox (journal TEXT NOT NULL, seq INTEGER NOT NULL, type TEXT NOT NULL, body TEXT NOT NULL,
                    PRIMARY KEY (journal, seq));
CREATE TABLE facts (name TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE reported (mission_id TEXT NOT NULL, key TEXT NOT NULL, PRIMARY KEY (mission_id, key));
"""


class StoreError(RobotError):
    """The robot's memory cannot be written or read back."""


class StorageFull(StoreError):
    """There is no room left. The transaction was undone as a whole: nothing is half written."""


class StorageFailed(StoreError):
    """The disk refused, or the file is no database of ours."""


class StorageInUse(StoreError):
    """Another process holds this robot's memory: two daemons must never drive one robot."""


class StorageNewer(StoreError):
    """The file was written by a later version of this program, whose meaning this one does not know."""


class Store:
    """The open database file. Any thread may use it; transactions take turns."""

    def __init__(self, path: Path | None, max_bytes: int = MAX_BYTES) -> None:
        """Open or make `path`; None is a store that forgets everything when closed, for worlds that are only stepped.

        Raises StorageFailed, StorageInUse or StorageNewer.
        """
        self.path = path
        self._turn = threading.RLock()
        self._depth = 0
        self._spoiled = False
        self._lock_file: TextIO | None = None
        try:
            if path is not None:
                self._lock_file = _claim(path)
            self._connection = sqlite3.connect(path or ":memory:", isolation_level=None, check_same_thread=False)
        except (OSError, sqlite3.Error) as error:
            raise StorageFailed(f"{path} cannot be opened: {error}") from None
        try:
            self._prepare(max_bytes)
        except BaseException:
            self.close()
            raise

    def _prepare(self, max_bytes: int) -> None:
        with self._named_errors():
            self._connection.execute("PRAGMA journal_mode = WAL")
            self._connection.execute("PRAGMA synchronous = FULL")
            page_bytes = self._connection.execute("PRAGMA page_size").fetchone()[0]
            self._connection.execute(f"PRAGMA max_page_count = {max(1, max_bytes // page_bytes)}")
        with self.transaction() as connection:
            version = connection.execute("PRAGMA user_version").fetchone()[0]
            if version > LAYOUT_VERSION:
                raise StorageNewer(f"{self.path} has layout {version}; this program knows {LAYOUT_VERSION}: update it")
            if version == 0:
                for statement in _LAYOUT.split(";"):
                    connection.execute(statement)
                connection.execute(f"PRAGMA user_version = {LAYOUT_VERSION}")

    @contextmanager
    def transaction(self) -> Iterator[sqlite3.Connection]:
        """Commit everything or nothing to the disk. Inside another transaction of the same thread it joins that one.

        Raises StorageFull or StorageFailed. A failure inside spoils the whole transaction, and a caller that catches it
        half-way gets another at the end: SQLite may already have undone the first half.
        """
        with self._turn, self._named_errors():
            self._begin()
            try:
                yield self._connection
            except BaseException:
                self._spoiled = True
                raise
            finally:
                self._depth -= 1
                if self._depth == 0:
                    self._finish()
            if self._depth == 0 and self._spoiled:
                raise StorageFailed(f"{self.path}: a part of this transaction failed, so that all of it was undone")

    def _begin(self) -> None:
        if self._depth == 0:
            self._spoiled = False
            self._connection.execute("BEGIN IMMEDIATE")
        self._depth += 1

    def _finish(self) -> None:
        try:
            if not self._spoiled:
                self._connection.execute("COMMIT")
        finally:
            if self._connection.in_transaction:
                self._connection.execute("ROLLBACK")

    @contextmanager
    def _named_errors(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.Error as error:
            if getattr(error, "sqlite_errorcode", None) == sqlite3.SQLITE_FULL:
                raise StorageFull(
                    f"no room left for {self.path}: free some, or let the robot reach its server"
                ) from None
            raise StorageFailed(f"{self.path}: {error}") from error

    def close(self) -> None:
        """Let go of the file."""
        self._connection.close()
        if self._lock_file is not None:
            self._lock_file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _claim(path: Path) -> TextIO:
    lock_file = path.with_name(path.name + ".lock").open("a")
    try:
        fcntl.flock(lock_file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        lock_file.close()
        raise StorageInUse(
            f"{path} is in use: another process holds this robot's memory; stop that robot daemon first"
        ) from None
    return lock_file
