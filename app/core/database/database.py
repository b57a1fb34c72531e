"""The database: one transaction per request, and what is to be said aloud only after its commit.

SQLite by default (write-ahead log, full sync: what was acknowledged survives a power cut), PostgreSQL by URL.
"""

import asyncio
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from contextlib import asynccontextmanager
from functools import cache
from typing import Annotated, Any, TypeVar

from fastapi import Depends
from pydantic_core import from_json, to_json
from sqlalchemy import URL, ColumnElement, Connection, Insert, event, insert, inspect, make_url
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.exc import ArgumentError
from sqlalchemy.ext.asyncio import AsyncConnection, AsyncEngine, create_async_engine
from sqlalchemy.orm import configure_mappers
from sqlalchemy.pool import AsyncAdaptedQueuePool, StaticPool
from sqlmodel import SQLModel
from sqlmodel.ext.asyncio.session import AsyncSession
from starlette.requests import HTTPConnection

from app.core.database import postgresql_driver
from app.core.database.deadline import WAIT_S
from app.core.database.group_commit import AFTER_COMMIT, CONNECTION, Writers
from app.core.database.shielded import shielded
from app.core.database.sqlite_driver import DRIVER
from app.core.errors import StartError
from app.core.parts import find_part, part

Row = TypeVar("Row", bound=SQLModel)

PRAGMAS = ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON")
INSERTS: Mapping[str, Any] = {"sqlite": sqlite.insert, "postgresql": postgresql.insert}
BEGIN_DURABLE = ("PRAGMA synchronous=FULL", "BEGIN IMMEDIATE")
BEGIN_FLEETING = ("PRAGMA synchronous=NORMAL", "BEGIN IMMEDIATE")
WRITE_AND_TAKE_BACK = (
    "INSERT INTO alembic_version (version_num) VALUES ('trial')",
    "DELETE FROM alembic_version WHERE version_num = 'trial'",
)
"""No reader ever sees that row, and its pages are written. (SQLite leaves a page alone that would stay the same.)"""


class Database:
    """Opens sessions. Writers take SQLite's write lock at once, because a reader that becomes one can be refused."""

    def __init__(self, url: str) -> None:
        """Opens nothing yet. Raises StartError for a URL that leads nowhere."""
        try:
            named = make_url(url)
            address = named.set(drivername=DRIVER) if named.get_backend_name() == "sqlite" else named
            # pydantic's JSON takes a third of the time of the standard library's.
            self.engine: AsyncEngine = create_async_engine(
                address, json_serializer=_json_text, json_deserializer=from_json, **_options(address)
            )
        except (ArgumentError, ImportError) as error:  # not repeated: a URL may hold a password
            raise StartError(f"CAMPUS_MAIL_DATABASE_URL cannot be used: {error}.") from None
        self.name = named.render_as_string(hide_password=True)
        self.writing = self.engine.execution_options(begin=BEGIN_DURABLE)
        if self.engine.dialect.name == "sqlite":
            event.listen(self.engine.sync_engine, "connect", _prepare_sqlite)
            event.listen(self.engine.sync_engine, "begin", _begin_sqlite)
            fleeting = self.engine.execution_options(begin=BEGIN_FLEETING)
        else:
            event.listen(self.engine.sync_engine, "begin", _begin_postgresql)
            event.listen(self.engine.sync_engine, "handle_error", postgresql_driver.tell_who_is_away)
            self.writing = self.engine.execution_options(begin=())
            fleeting = self.engine.execution_options(begin=("SET LOCAL synchronous_commit TO OFF",))
            self.engine = self.engine.execution_options(isolation_level="REPEATABLE READ", postgresql_readonly=True)

        self._writers = Writers(self.writing, fleeting)

    @asynccontextmanager
    async def transaction(self, *, durable: bool = True) -> AsyncIterator[AsyncSession]:
        """One transaction: committed at the end, or rolled back by an exception; then what waits for it is said.

        Those who write at the same time share a commit (`group_commit`). Do not wait in here for anything slow.
        Not `durable`: a power cut may take it back (the end of the process does not); for what is then done again.
        """
        async with self._writers.transaction(durable=durable) as session:
            yield session

    @asynccontextmanager
    async def reading(self) -> AsyncIterator[AsyncSession]:
        """A consistent view for reading, which holds up no writer."""
        session = AsyncSession(self.engine, expire_on_commit=False)
        try:
            yield session
        finally:
            await self._close(session)

    @asynccontextmanager
    async def asking(self) -> AsyncIterator[AsyncConnection]:
        """The same past the session, for a question with each request: it costs half."""
        connection = await self.engine.connect()
        try:
            yield connection
        finally:
            await self._close(connection)

    async def _close(self, used: AsyncSession | AsyncConnection) -> None:
        """To its end: a caller that is cancelled while it waits would leave a connection behind."""
        if self.engine.dialect.name == "sqlite":  # does not wait
            await used.close()
        else:
            await shielded(asyncio.ensure_future(used.close()))

    @asynccontextmanager
    async def rebuilding(self) -> AsyncIterator[AsyncConnection]:
        """One transaction in which tables may be written anew, as SQLite has to for most changes of a schema.

        It would take the rows that refer to a table for orphans as soon as the old one is dropped: a caller that
        rebuilds looks for orphans at the end (`PRAGMA foreign_key_check`).
        """
        async with self.writing.connect() as connection:
            await connection.run_sync(_heed_foreign_keys, "OFF")
            try:
                async with connection.begin():
                    yield connection
            finally:
                await connection.run_sync(_heed_foreign_keys, "ON")

    async def try_to_write(self) -> None:
        """Commit a row that comes and goes. Raises what keeps everybody from writing: a lock, a full disk."""
        async with self.transaction(durable=False) as session:  # anybody may ask for it: it waits for no disk
            connection = await connection_of(session)
            for statement in WRITE_AND_TAKE_BACK:
                await connection.exec_driver_sql(statement)

    async def close(self) -> None:
        await self.engine.dispose()


def after_commit(session: AsyncSession, say: Callable[[], None]) -> None:
    """Run `say` once the transaction is committed, in order of asking; never if it is rolled back."""
    session.info.setdefault(AFTER_COMMIT, []).append(say)


@asynccontextmanager
async def savepoint(session: AsyncSession) -> AsyncIterator[None]:
    """Part of a transaction that may fail alone: what it did is undone, and what it wanted to say is not said."""
    waiting = len(session.info.setdefault(AFTER_COMMIT, []))
    try:
        async with session.begin_nested():
            await session.connection()  # which begins it, also for those who write past the session
            yield
    except BaseException:
        del session.info[AFTER_COMMIT][waiting:]
        raise


def columns_of(table: type[SQLModel]) -> list[ColumnElement[Any]]:
    """Return all columns, for a row that is only read: a session takes three times as long to make one that it
    knows."""
    return list(inspect(table).columns)


def row_of(table: type[Row], values: Mapping[str, Any]) -> Row:
    """A row that no session knows, from its columns: by its own way it takes ten times as long to make."""
    row: Row = _maker(table)()
    row.__dict__.update(values)
    return row


def new_row(table: type[Row], values: Mapping[str, Any]) -> Row:
    """The same of some of its columns; the others are as the table says. For what was checked before."""
    return row_of(table, {**_usual(table), **values})


@cache
def _maker(table: type[SQLModel]) -> Callable[[], Any]:
    configure_mappers()
    make: Callable[[], Any] = inspect(table).class_manager.new_instance
    return make


@cache
def _usual(table: type[SQLModel]) -> Mapping[str, Any]:
    fields = table.model_fields
    return {name: field.default for name, field in fields.items() if not field.is_required()}


async def connection_of(session: AsyncSession) -> AsyncConnection:
    """For statements past the session, in its transaction."""
    known: AsyncConnection | None = session.info.get(CONNECTION)
    return await session.connection() if known is None else known


async def write_all(session: AsyncSession, table: type[SQLModel], rows: Sequence[Mapping[str, Any]]) -> None:
    """Write rows that are new for certain, all with the same columns.

    A third of the time that the session's own way takes, for one; the session does not know them.
    """
    if rows:
        await (await connection_of(session)).execute(_insert(table), rows)


async def write_once(session: AsyncSession, table: type[SQLModel], values: Mapping[str, Any]) -> bool:
    """Write a row unless there is one of the same key; whether it is new."""
    connection = await connection_of(session)
    return (await connection.execute(_insert_once(connection.dialect.name, table), values)).rowcount > 0


async def write_all_once(session: AsyncSession, table: type[SQLModel], rows: Sequence[Mapping[str, Any]]) -> None:
    """Write those of which there is none of the same key."""
    if rows:
        connection = await connection_of(session)
        await connection.execute(_insert_once(connection.dialect.name, table), rows)


@cache
def _insert_once(dialect: str, table: type[SQLModel]) -> Insert:
    statement: Insert = INSERTS[dialect](table).on_conflict_do_nothing().inline()
    return statement


@cache
def _insert(table: type[SQLModel]) -> Insert:
    return insert(table).inline()


def _options(url: URL) -> dict[str, Any]:
    """Return the options of the engine: how many connections are kept, and what opens them."""
    if url.get_backend_name() != "sqlite":
        of_ours = {"connect_args": {"async_creator_fn": postgresql_driver.connect}}
        return {"pool_size": 10, "max_overflow": 10, "pool_timeout": WAIT_S, **of_ours}
    if url.database in {None, "", ":memory:"}:  # one connection is all there can be
        return {"poolclass": StaticPool}
    # The one that was used last comes first: its thread, its statements and its pages are at hand.
    kept = {"pool_size": 20, "max_overflow": 0, "pool_use_lifo": True, "pool_timeout": WAIT_S}
    return {**kept, "poolclass": AsyncAdaptedQueuePool}


def _json_text(value: Any) -> str:
    return to_json(value).decode()


def _prepare_sqlite(connection: Any, record: Any) -> None:
    cursor = connection.cursor()
    for pragma in PRAGMAS:
        cursor.execute(f"PRAGMA {pragma}")
    cursor.close()


def _heed_foreign_keys(connection: Connection, wanted: str) -> None:
    """Past SQLAlchemy: within a transaction, which it would begin, the word has no effect."""
    if connection.dialect.name == "sqlite":
        cursor = connection.connection.cursor()
        cursor.execute(f"PRAGMA foreign_keys={wanted}")
        cursor.close()


def _begin_sqlite(connection: Connection) -> None:
    # Past SQLAlchemy, which takes longer over these words than SQLite does.
    driver: Any = connection.connection.driver_connection
    for statement in connection.get_execution_options().get("begin", ("BEGIN",)):
        driver.defer(statement)


def _begin_postgresql(connection: Connection) -> None:
    statements = connection.get_execution_options().get("begin")
    if statements is None:  # reads only
        return
    postgresql_driver.take_turn(connection)
    for statement in statements:
        connection.exec_driver_sql(statement)


DatabaseDep = Annotated[Database, part(Database)]


# Not by way of DatabaseDep: each dependency is solved anew for every request.
async def _transaction(request: HTTPConnection) -> AsyncIterator[AsyncSession]:
    async with find_part(request, Database).transaction() as session:
        yield session


async def _reading(request: HTTPConnection) -> AsyncIterator[AsyncSession]:
    async with find_part(request, Database).reading() as session:
        yield session


# Scope "function": committed (or refused) before the answer goes out, and long before an event stream begins.
SessionDep = Annotated[AsyncSession, Depends(_transaction, scope="function")]
ReadingDep = Annotated[AsyncSession, Depends(_reading, scope="function")]
