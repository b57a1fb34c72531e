"""Brings the database to the schema of this code, and refuses one that is newer."""

import sqlite3
from functools import cache

from alembic import command
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from alembic.util import CommandError
from sqlalchemy import Connection
from sqlalchemy.exc import DBAPIError

from app.core.database.database import Database
from app.core.errors import StartError
from app.core.settings import ROOT

INI = ROOT / "alembic.ini"


class NewerDatabase(StartError):
    """The database was written by a later version of Campus Mail, whose migrations this code does not have."""

    def __init__(self, revision: str) -> None:
        super().__init__(
            f"The database is at schema {revision}, which this version of Campus Mail does not know: it was written by "
            "a newer one. Start that version, or give this one a data folder of its own (CAMPUS_MAIL_DATA)."
        )


class DatabaseUnusable(StartError):
    """No database, or one that cannot be read or written."""


async def bring_to_head(database: Database) -> None:
    """Run the migrations that are missing, in one transaction.

    Raises NewerDatabase or DatabaseUnusable, having changed nothing.
    """
    try:
        async with database.rebuilding() as connection:
            await connection.run_sync(_bring_to_head)
    except (DBAPIError, OSError, sqlite3.Error) as error:
        raise DatabaseUnusable(f"The database {database.name} cannot be used: {_first_of(error)}.") from error


def _first_of(error: BaseException) -> BaseException:
    """Return the first error: a full disk, say, and not what was refused because of it."""
    first = error.orig if isinstance(error, DBAPIError) and error.orig is not None else error
    while error.__context__ is not None:
        error = error.__context__
        if isinstance(error, sqlite3.Error):
            first = error
    return first


async def is_at_head(database: Database) -> bool:
    """Tell if the schema is the one of this code."""
    async with database.engine.connect() as connection:
        return await connection.run_sync(revision_of) == _scripts().get_current_head()


def _bring_to_head(connection: Connection) -> None:
    revision = revision_of(connection)
    if revision is not None:
        refuse_unknown(revision)
    if revision != _scripts().get_current_head():  # at most starts there is nothing to run
        config = Config(INI)
        config.attributes["connection"] = connection
        command.upgrade(config, "head")
    if connection.dialect.name == "sqlite" and (
        orphans := connection.exec_driver_sql("PRAGMA foreign_key_check").all()
    ):
        tables = ", ".join(sorted({str(row[0]) for row in orphans}))
        raise DatabaseUnusable(
            f"The schema was not changed: rows of {tables} refer to rows that are not there. Restore a backup."
        )


def refuse_unknown(revision: str) -> None:
    """Raises NewerDatabase for a revision that this code has no migration of."""
    try:
        _scripts().get_revision(revision)
    except CommandError:
        raise NewerDatabase(revision) from None


def revision_of(connection: Connection) -> str | None:
    """The schema that a database is at; None if it has none of ours."""
    return MigrationContext.configure(connection).get_current_revision()


@cache
def _scripts() -> ScriptDirectory:
    return ScriptDirectory.from_config(Config(INI))
