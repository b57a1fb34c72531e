"""SQLAlchemy's dialect for the standard `sqlite3` on an event loop.

A short statement takes SQLite some 10 µs; the way to a thread and back takes longer, and on a busy event loop it waits
for its turn at the interpreter (decision 0034). So only what may take long goes to the connection's thread: the commit
with its sync, and each statement that is not known to be short. On the event loop nothing waits: a statement that meets
a lock, or a query that takes long, fails there at once and is repeated in the thread.
"""

import asyncio
import sqlite3
from collections import deque
from collections.abc import Callable, Iterator
from functools import lru_cache, partial, partialmethod
from itertools import islice
from math import inf
from queue import SimpleQueue
from threading import Thread
from time import monotonic, thread_time
from typing import Any, Final, TypeVar
from weakref import finalize

from sqlalchemy import BinaryExpression, BooleanClauseList, Insert, SelectBase, Update
from sqlalchemy.dialects import registry
from sqlalchemy.dialects.sqlite.pysqlite import SQLiteDialect_pysqlite
from sqlalchemy.sql.operators import and_, eq
from sqlalchemy.util import await_

from app.core.database.deadline import left_s
from app.core.database.shielded import shielded

T = TypeVar("T")

DRIVER: Final = "sqlite+campus"
SHORT_S: Final = 0.001
"""Seconds of processor time that a query may take on the event loop."""
INSTRUCTIONS: Final = 2_000
"""Instructions of SQLite's virtual machine between two looks at the time: some 50 µs."""
SHORT_ROWS: Final = 100
"""Rows, or values of one row, that one statement writes on the event loop."""
TURN_S: Final = 0.002
"""Real seconds after which other tasks get their turn, however many short statements there are to run."""


class Dialect(SQLiteDialect_pysqlite):
    driver = "campus"
    is_async = True
    supports_statement_cache = True

    def connect(self, *arguments: Any, **options: Any) -> Any:
        return Connection(*arguments, **options)

    def do_execute(self, cursor: Any, statement: str, parameters: Any, context: Any = None) -> None:
        cursor.execute(statement, parameters, context)

    def do_executemany(self, cursor: Any, statement: str, parameters: Any, context: Any = None) -> None:
        cursor.executemany(statement, parameters, context)

    # Past SQLAlchemy, which takes longer over these words than SQLite does.
    def do_savepoint(self, connection: Any, name: str) -> None:
        connection.connection.driver_connection.defer(f"SAVEPOINT {name}")

    def do_release_savepoint(self, connection: Any, name: str) -> None:
        connection.connection.driver_connection.defer(f"RELEASE {name}")


registry.register("sqlite.campus", __name__, "Dialect")


@lru_cache(maxsize=1000)
def limit_s_of(statement: object) -> float:
    """Return the time that a statement may take on the event loop; 0: it has to run in the thread.

    A query is interrupted after its time. A change cannot be: SQLite would undo the whole transaction. So it has to be
    small for certain: one row for each set of parameters, by its values or by its key.
    """
    if isinstance(statement, SelectBase):
        return SHORT_S
    if isinstance(statement, Insert):
        return inf if statement.select is None else 0
    if isinstance(statement, Update) and statement.table.primary_key:
        where = statement.whereclause
        terms = where.clauses if isinstance(where, BooleanClauseList) and where.operator is and_ else [where]
        given = {term.left for term in terms if isinstance(term, BinaryExpression) and term.operator is eq}
        return inf if given.issuperset(statement.table.primary_key) else 0
    return 0


class Connection(sqlite3.Connection):
    """Statements reach SQLite in the order in which they were asked for, one at a time."""

    _long: set[str] = set()  # noqa: RUF012  # what one connection has learned is true for all
    """Statements that took long the last time."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        # Two threads, but never at the same time. `database.py` begins the transactions.
        super().__init__(*arguments, **{**options, "check_same_thread": False, "isolation_level": None, "timeout": 0})
        self._queue: SimpleQueue[Any] = SimpleQueue()
        finalize(self, self._queue.put, None)
        self._deferred: deque[str] = deque()
        self._has_begun = False
        self._turn_ends_s = 0.0
        Thread(target=_serve, args=(self._queue,), daemon=True).start()

    def cursor(self, *_: Any) -> Any:
        return super().cursor(Cursor)

    def defer(self, statement: str) -> None:
        """Run it before the next statement. An error of it is that statement's."""
        self._deferred.append(statement)

    async def run(self, statement: str, limit_s: float, what: Callable[[], T]) -> T:
        """Run what is short at once, all else in the thread."""
        if limit_s == 0 or statement in self._long:
            return await self._in_thread(partial(self._patiently, statement, left_s(), what))
        try:
            answer = self._in_turn(what, limit_s)
        except sqlite3.OperationalError as error:
            code = getattr(error, "sqlite_errorcode", sqlite3.SQLITE_OK) & 0xFF  # none: it is an error of ours
            if code == sqlite3.SQLITE_INTERRUPT:
                self._long.add(statement)
            elif code != sqlite3.SQLITE_BUSY:
                raise
            return await self.run(statement, 0, what)
        if monotonic() > self._turn_ends_s:
            await shielded(asyncio.ensure_future(asyncio.sleep(0)))
            self._turn_ends_s = monotonic() + TURN_S
        return answer

    async def _in_thread(self, what: Callable[[], T]) -> T:
        """Run it in the connection's thread, to its end."""
        outcome: asyncio.Future[T] = asyncio.get_running_loop().create_future()
        self._queue.put((outcome, what))
        answer = await shielded(outcome)
        self._turn_ends_s = monotonic() + TURN_S
        return answer

    def _patiently(self, statement: str, wait_s: float, what: Callable[[], T]) -> T:
        begun_s = thread_time()
        self._execute(f"PRAGMA busy_timeout={wait_s * 1e3:.0f}")
        try:
            return self._in_turn(what)
        finally:
            self._execute("PRAGMA busy_timeout=0")
            if thread_time() - begun_s < SHORT_S / 4:
                self._long.discard(statement)

    def _in_turn(self, what: Callable[[], T], limit_s: float = inf) -> T:
        # A full disk undoes the whole transaction. A savepoint would begin another, and its release commit that one:
        # writers whose rows are gone would be told that they are committed.
        if self._has_begun and not self.in_transaction:
            raise sqlite3.OperationalError("the transaction has been undone")
        while self._deferred:
            self._execute(self._deferred[0])
            self._deferred.popleft()
            self._has_begun = self.in_transaction
        if limit_s == inf:
            return what()
        late_s = thread_time() + limit_s
        self.set_progress_handler(lambda: thread_time() > late_s, INSTRUCTIONS)
        try:
            return what()
        finally:  # in the thread it would wait for the interpreter each time
            self.set_progress_handler(None, 0)

    def _execute(self, statement: str) -> None:
        super().cursor().execute(statement)

    def commit(self) -> None:
        """Raises OperationalError if there is nothing to commit any more."""
        await_(self._in_thread(partial(self._in_turn, super().commit)))
        self._has_begun = False

    def rollback(self) -> None:
        self._deferred.clear()
        self._has_begun = False
        super().rollback()

    def close(self) -> None:
        await_(self._in_thread(super().close))


def _serve(queue: "SimpleQueue[tuple[asyncio.Future[Any], Callable[[], Any]] | None]") -> None:
    while item := queue.get():
        outcome, what = item
        try:
            tell = partial(outcome.set_result, what())
        except BaseException as error:  # told to the caller
            tell = partial(outcome.set_exception, error)
        outcome.get_loop().call_soon_threadsafe(tell)
        del item, outcome, what, tell  # which would keep the connection alive, and with it this thread


class Cursor(sqlite3.Cursor):
    """One statement and all of its rows."""

    connection: Connection
    _rows: Iterator[Any] = iter(())

    def _run(self, execute: Any, statement: str, parameters: Any = (), context: Any = None) -> None:
        limit_s = limit_s_of(context.compiled.statement) if context and context.compiled else 0
        if limit_s == inf and len(parameters) > SHORT_ROWS:
            limit_s = 0
        what = partial(self._all_rows, execute, statement, parameters)
        self._rows = iter(await_(self.connection.run(statement, limit_s, what)))

    execute: Any = partialmethod(_run, sqlite3.Cursor.execute)
    executemany: Any = partialmethod(_run, sqlite3.Cursor.executemany)

    def _all_rows(self, execute: Any, statement: str, parameters: Any) -> list[Any]:
        execute(self, statement, parameters)
        return super().fetchall() if self.description else []

    def fetchone(self) -> Any:
        return next(self._rows, None)

    def fetchmany(self, size: int | None = 1) -> list[Any]:
        return list(islice(self._rows, size or 1))

    def fetchall(self) -> list[Any]:
        return list(self._rows)

    async def _async_soft_close(self) -> None:
        """Required by SQLAlchemy's asyncio. The rows have been read."""
