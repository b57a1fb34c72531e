"""aiosqlite, but what is short is done at once, on the event loop.

A short statement takes SQLite some 10 µs and holds up no other work. The way to a thread and back takes longer, four
times for each statement as aiosqlite and SQLAlchemy have it, and on a busy event loop every one of these ways waits
for its turn
at the interpreter (decision 0034). So only what may take long goes to the connection's thread: the wait for the write
lock, the commit with its sync, and whatever is not known to be short. A question that turns out not to be short is
interrupted, asked again in the thread, and goes there at once the next time.
"""

import asyncio
import re
import sqlite3
import time
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, Final, Self, TypeVar

import aiosqlite

from app.core.database.deadline import left_s
from app.core.database.shielded import shielded

T = TypeVar("T")

SHORT_STEPS: Final = 50_000
"""Steps of SQLite's machine that a question may take on the event loop: about a millisecond."""
SHORT_ROWS: Final = 100
"""Rows that are written on the event loop by one statement."""
BREATH_S: Final = 0.002
"""Real seconds after which others get their turn, however much there is to ask."""

BRACKETS: Final = ("PRAGMA synchronous=", "BEGIN", "SAVEPOINT", "RELEASE")
LOCKS: Final = "BEGIN IMMEDIATE"
QUESTION: Final = re.compile(r"SELECT\b")
SMALL_CHANGE: Final = re.compile(
    r"INSERT INTO \w+ \([^)]*\) VALUES \([^)]*\)( ON CONFLICT DO NOTHING)?( RETURNING [\w, ]+)?$"
    r"|UPDATE \w+ SET .* WHERE \w+\.\w+ = \?( AND \w+\.\w+ = \?)*$",
    re.DOTALL,
)
"""One row each: by its values, or by a key."""


def connect(database: str, **options: Any) -> "Connection":
    """Open a connection for SQLAlchemy (its `async_creator_fn`)."""
    options["check_same_thread"] = False  # two threads, but never at the same time: each errand is waited for
    connection = Connection(lambda: sqlite3.connect(database, **options), iter_chunk_size=64)
    connection._thread.daemon = True  # as SQLAlchemy has it: a connection that was not closed holds up no exit
    return connection


@lru_cache(maxsize=2000)
def is_question(statement: str) -> bool:
    return QUESTION.match(statement) is not None


@lru_cache(maxsize=2000)
def is_small_change(statement: str) -> bool:
    return SMALL_CHANGE.match(statement) is not None


class Connection(aiosqlite.Connection):
    """Statements reach SQLite in the order in which they were asked for."""

    _long: set[str] = set()  # noqa: RUF012  # what one connection has learned is true for all
    """Questions that have turned out not to be short."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._brackets: list[str] = []
        self._has_transaction = False
        self._is_asking = False
        self._is_guarded = False
        self._breathed_at_s = 0.0

    def cursor(self) -> "Cursor":  # type: ignore[override]  # aiosqlite's own goes to the thread first
        return Cursor(self)

    def remember(self, bracket: str) -> None:
        """To be said before the next statement. An error of it is that statement's."""
        self._brackets.append(bracket)

    async def ask(self, statement: str, what: Callable[[sqlite3.Connection], T], rows: int = 1) -> T:
        """Do it at once if it is short, else in the thread."""
        if self._has_begun():
            if is_small_change(statement) and rows <= SHORT_ROWS:
                return await self._at_once(what)
            if is_question(statement) and statement not in self._long:
                try:
                    return await self._ask_at_once(what)
                except sqlite3.OperationalError as error:
                    if "interrupted" not in str(error):
                        raise
                    self._long.add(statement)
        return await self.errand(what)

    def _has_begun(self) -> bool:
        """Take the write lock that was asked for, if it is free: to wait for it is left to the thread."""
        if LOCKS not in self._brackets:
            return True
        before = self._brackets[: self._brackets.index(LOCKS)]
        self._conn.execute("PRAGMA busy_timeout=0")
        try:
            for bracket in [*before, LOCKS]:
                self._open(bracket)
        except sqlite3.OperationalError:  # if it is not for the lock, the thread finds out
            return False
        finally:
            self._conn.execute(f"PRAGMA busy_timeout={left_s() * 1e3:.0f}")
        del self._brackets[: len(before) + 1]
        return True

    async def _ask_at_once(self, what: Callable[[sqlite3.Connection], T]) -> T:
        if not self._is_guarded:
            self._conn.set_progress_handler(self._takes_long, SHORT_STEPS)
            self._is_guarded = True
        self._is_asking = True
        try:
            return await self._at_once(what)
        finally:
            self._is_asking = False

    def _takes_long(self) -> bool:
        return self._is_asking

    async def _at_once(self, what: Callable[[sqlite3.Connection], T]) -> T:
        answer = self._now(what)
        loop = asyncio.get_running_loop()
        if time.monotonic() - self._breathed_at_s > BREATH_S:
            self._is_asking = False
            breath: asyncio.Future[None] = loop.create_future()
            loop.call_soon(breath.set_result, None)
            await shielded(breath)
            self._breathed_at_s = time.monotonic()
        return answer

    def _now(self, what: Callable[[sqlite3.Connection], T]) -> T:
        self._refuse_if_undone()
        brackets, self._brackets = self._brackets, []
        for bracket in brackets:
            self._open(bracket)
        return what(self._conn)

    def _open(self, bracket: str) -> None:
        self._conn.execute(bracket)
        self._has_transaction |= bracket.startswith("BEGIN")

    def _refuse_if_undone(self) -> None:
        """A full disk undoes the whole transaction. A savepoint would begin another, and its release commit that one:
        those who wrote before would be told that what they wrote is there."""
        if self._has_transaction and not self._conn.in_transaction:
            raise sqlite3.OperationalError("the transaction has been undone")

    async def errand(self, what: Callable[[sqlite3.Connection], T]) -> T:
        """Do it in the connection's thread, to its end."""
        outcome: asyncio.Future[T] = asyncio.get_running_loop().create_future()
        self._tx.put_nowait((outcome, lambda: self._now(what)))
        answer = await shielded(outcome)
        self._breathed_at_s = time.monotonic()
        return answer

    async def commit(self) -> None:
        """Raises OperationalError if there is nothing to commit any more."""
        await self.errand(lambda connection: connection.commit())
        self._has_transaction = False

    async def rollback(self) -> None:
        self._brackets.clear()
        self._has_transaction = False
        if self._conn.in_transaction:
            self._conn.rollback()


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
            what = self._errand(lambda cursor: cursor.execute(statement, parameters))
            self._rows = await self._connection.ask(statement, what)

    async def executemany(self, statement: str, parameters: Sequence[Sequence[Any]]) -> None:
        what = self._errand(lambda cursor: cursor.executemany(statement, parameters))
        self._rows = await self._connection.ask(statement, what, len(parameters))

    def _errand(self, what: Callable[[sqlite3.Cursor], object]) -> Callable[[sqlite3.Connection], list[Any]]:
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

        return ask

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
