"""asyncpg, but a server that is away is always told by the same error, whichever way it is met.

A restart is met as a socket that is not there, a refusal while it starts, a connection that is cut in the middle of a
statement, or one that is in no state to go on. SQLAlchemy has another error for each, or none.
"""

from typing import Any, Final

from sqlalchemy import Connection
from sqlalchemy.engine import ExceptionContext
from sqlalchemy.exc import OperationalError

from app.core.database.deadline import left_s

CUT_OFF: Final = ("08", "57P")
AWAY: Final = (*CUT_OFF, "53", "55P03", "57", "58")
"""How SQLSTATEs begin: connection, resources (a full disk), a lock that was waited for, the operator, the system."""
ONE_WRITER: Final = f"SELECT set_config('lock_timeout', $1, true), pg_advisory_xact_lock({0x434D_0001})"
"""PostgreSQL's writers take turns as SQLite's do, with a lock that is held to the end of the transaction: a writer that
decides by what it has read decides by what is true, so that no transaction has to be repeated because of another one,
and no code has to think of which rows to lock."""
SHORTEST_WAIT_S: Final = 0.1
"""A connection that can be had is had, however late it is; and no time at all would mean for ever."""


async def connect(*arguments: Any, **options: Any) -> Any:
    """Open a connection for SQLAlchemy (its `async_creator_fn`). Raises OperationalError."""
    import asyncpg

    try:
        return await asyncpg.connect(*arguments, **{"timeout": _wait_s(), **options})
    except (OSError, TimeoutError, asyncpg.PostgresError, asyncpg.InterfaceError) as error:
        raise OperationalError(None, None, error) from error


def take_turn(connection: Connection) -> None:
    """Wait for the lock of the writers until the deadline. Raises OperationalError."""
    connection.exec_driver_sql(ONE_WRITER, (f"{_wait_s() * 1e3:.0f}ms",))


def tell_who_is_away(context: ExceptionContext) -> None:
    """Listen to `handle_error`. Raises OperationalError instead; a connection that was cut is not used again."""
    error: Any = context.original_exception
    state = getattr(error, "sqlstate", None) or ""
    # A connection that is being cut may not be closed yet, and is of no use any more.
    broken = isinstance(error, (OSError, context.dialect.loaded_dbapi.InternalClientError))
    context.is_disconnect = context.is_disconnect or broken or state.startswith(CUT_OFF)
    if context.is_disconnect or state.startswith(AWAY):
        raise OperationalError(context.statement, None, error) from error


def _wait_s() -> float:
    return max(SHORTEST_WAIT_S, left_s())
