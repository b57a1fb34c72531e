"""Messages for the server, kept on the robot's disk until the server has committed them.

The journal is born with the database. Numbers begin at 1 and never go back, not even after everything has been
acknowledged; that is how the server knows a repeated message from a new one.
"""

import sqlite3
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from protocol.envelope import DURABLE, TO_SERVER, type_of
from protocol.ids import new_uuid
from protocol.parts import Part
from robot.mission.store import Store

_JOURNAL: Final = "outbox_journal"
_RECEIPTS: Final = "receipts"


class NotDurable(ValueError):
    """A message of this type is never kept: it is replaced by a newer one and handed to the link directly."""


@dataclass(frozen=True)
class Kept:
    """A message that waits for its acknowledgement."""

    seq: int
    message: Part


class Outbox:
    """Durable messages to the server, in the order in which they were put. Any thread may use it."""

    def __init__(self, store: Store) -> None:
        self._store = store
        with store.transaction() as database:
            journal = _journal(database)
            if journal is None:
                journal = _begin_journal(database)
        self._journal = journal

    @property
    def journal(self) -> str:
        """The name under which this outbox numbers its messages."""
        return self._journal

    def put(self, message: Part) -> int:
        """Keep an event, claim or clear; it is on the disk when its `seq` is returned.

        Inside `store.transaction()` it is on the disk when that ends. Raises NotDurable, StorageFull, StorageFailed.
        """
        name = type_of(message)
        if name not in DURABLE or name not in TO_SERVER:
            raise NotDurable(f"{name} is not kept; durable are {', '.join(sorted(DURABLE & TO_SERVER.keys()))}")
        with self._store.transaction() as database:
            values = (name, message.model_dump_json())
            cursor = database.execute("INSERT INTO outbox (type, body) VALUES (?, ?)", values)
            assert cursor.lastrowid is not None  # noqa: S101  # sqlite3 gives one for every INSERT
            return cursor.lastrowid

    def next_receipt(self) -> int:
        """The number of the next receipt, each given once. Put the receipt in the same transaction."""
        with self._store.transaction() as database:
            row = database.execute("SELECT value FROM facts WHERE name = ?", (_RECEIPTS,)).fetchone()
            number = int(row[0]) + 1 if row else 1
            database.execute("INSERT OR REPLACE INTO facts (name, value) VALUES (?, ?)", (_RECEIPTS, str(number)))
            return number

    def pending(self, after: int = 0, limit: int = 100) -> Sequence[Kept]:
        """The messages with a `seq` above `after` that are not acknowledged yet, oldest first, at most `limit`."""
        with self._store.transaction() as database:
            rows = database.execute(
                "SELECT seq, type, body FROM outbox WHERE seq > ? ORDER BY seq LIMIT ?", (after, limit)
            ).fetchall()
        return [Kept(seq, TO_SERVER[name].model_validate_json(body)) for seq, name, body in rows]

    def acknowledged(self, seq: int) -> None:
        """The server has committed everything up to `seq`: forget it."""
        with self._store.transaction() as database:
            database.execute("DELETE FROM outbox WHERE seq <= ?", (seq,))

    def waiting(self) -> int:
        """Return the number of unacknowledged messages."""
        with self._store.transaction() as database:
            return int(database.execute("SELECT count(*) FROM outbox").fetchone()[0])

    def last_seq(self) -> int:
        """The highest number given so far; 0 before the first."""
        with self._store.transaction() as database:
            return _last_seq(database)

    def resume_from(self) -> int:
        """The lowest number that can still be sent."""
        with self._store.transaction() as database:
            lowest = database.execute("SELECT min(seq) FROM outbox").fetchone()[0]
            return int(lowest) if lowest is not None else _last_seq(database) + 1

    def renew_journal(self) -> None:
        """Begin another journal; the numbers go on, and what waits belongs to the new one.

        For a database that was put back from an older copy: its next numbers would be ones that the server has already
        seen, and new messages would be taken for repeated ones.
        """
        with self._store.transaction() as database:
            self._journal = _begin_journal(database)


def _journal(database: sqlite3.Connection) -> str | None:
    row = database.execute("SELECT value FROM facts WHERE name = ?", (_JOURNAL,)).fetchone()
    return str(row[0]) if row else None


def _begin_journal(database: sqlite3.Connection) -> str:
    journal = new_uuid()
    database.execute("INSERT OR REPLACE INTO facts (name, value) VALUES (?, ?)", (_JOURNAL, journal))
    return journal


def _last_seq(database: sqlite3.Connection) -> int:
    row = database.execute("SELECT seq FROM sqlite_sequence WHERE name = 'outbox'").fetchone()
    return int(row[0]) if row else 0
