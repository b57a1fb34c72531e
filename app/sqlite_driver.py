"""aiosqlite with one change of threads for each statement, where it and SQLAlchemy take four.

A statement of ours takes SQLite some 20 µs; each change of threads takes longer than that. So a statement, its rows and
the end of its cursor are one errand to the connection's thread, and what only opens or closes a bracket (BEGIN,
SAVEPOINT, RELEASE) travels with the statement that follows it.
"""

import asyncio
import sqlite3
from collections.abc import Callable, Sequence
from typing import Any, Final, Self, TypeVar

import aiosqlite

T = TypeVar("T")

BRACKETS: Final = ("BEGIN", "SAVEPOINT", "RELEASE")


def connect(database: str, **options: Any) -> "Connection":
    """What SQLAlchemy calls for a new connection (its `async_creator_fn`)."""
    connection = Connection(lambda: sqlite3.connect(database, **options), iter_chunk_size=64)
    connection._thread.daemon = True  # as SQLAlchemy has it: a connection that nobody closed holds up no exit
    return connection


class Connection(aiosqlite.Connection):
    """Statements reach SQLite in the order in which they were asked for."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._brackets: list[str] = []

    def cursor(self) -> "Cursor":  # type: ignore[override]  # aiosqlite's own goes to the thread first
        return Cursor(self)

    def remember(self, bracket: str) -> None:
        """To be said before the next statement. An error of it is that statement's."""
        self._brackets.append(bracket)

    async def errand(self, what: Callable[[sqlite3.Connection], T]) -> T:
        """Do it in the connection's thread, to its end.

        Cancelled half-way, SQLAlchemy would throw the connection away, and with it what others have written in the
        same transaction. The cancellation comes all the same: at the next wait that is not for the database.
        """
        brackets, self._brackets = self._brackets, []
        outcome: asyncio.Future[T] = asyncio.get_running_loop().create_future()

        def do() -> T:
            for bracket in brackets:
                self._conn.execute(bracket)
            return what(self._conn)

        self._tx.put_nowait((outcome, do))
        try:
            return await asyncio.shield(outcome)
        except asyncio.CancelledError:
            return await _in_spite_of_it(outcome)

    async def commit(self) -> None:
        """Raises OperationalError if there is nothing to commit any more: a full disk undoes what was written."""
        if not self._brackets and not self._conn.in_transaction:
            raise sqlite3.OperationalError("the transaction has been undone")
        await self.errand(lambda connection: connection.commit())

    async def rollback(self) -> None:
        """Nobody has to wait for it: whatever is asked next comes after it."""
        self._brackets.clear()
        if self._conn.in_transaction:
            self._tx.put_nowait((None, self._conn.rollback))


async def _in_spite_of_it(outcome: asyncio.Future[T]) -> T:
    while not outcome.done():
        try:
            await asyncio.wait([outcome])
        except asyncio.CancelledError:
            continue
    if task := asyncio.current_task():
        task.uncancel()
        task.cancel()
    return outcome.result()


class Cursor:
    """One statement and all of its rows."""

    arraysize = 1

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._rows: list[Any] = []
        self.description: Any = None
        self.rowcount = -1
        self.lastrowid: int | None = None

    async def __aenter__(self) -> Self:
        return self

    async def execute(self, statement: str, parameters: Sequence[Any] = ()) -> None:
        if statement.startswith(BRACKETS):
            self._connection.remember(statement)
        else:
            await self._ask(lambda cursor: cursor.execute(statement, parameters))

    async def executemany(self, statement: str, parameters: Sequence[Sequence[Any]]) -> None:
        await self._ask(lambda cursor: cursor.executemany(statement, parameters))

    async def _ask(self, what: Callable[[sqlite3.Cursor], object]) -> None:
        def ask(connection: sqlite3.Connection) -> list[Any]:
            cursor = connection.cursor()
            try:
                what(cursor)
                self.description, self.lastrowid = cursor.description, cursor.lastrowid
                rows = cursor.fetchall() if cursor.description else []
                self.rowcount = cursor.rowcount
                return rows
            finally:
                cursor.close()

        self._rows = await self._connection.errand(ask)

    async def fetchall(self) -> list[Any]:
        rows, self._rows = self._rows, []
        return rows

    async def fetchmany(self, size: int | None = None) -> list[Any]:
        some, self._rows = self._rows[: size or 1], self._rows[size or 1 :]
        return some

    async def fetchone(self) -> Any:
        return self._rows.pop(0) if self._rows else None

    async def close(self) -> None:
        self._rows = []
