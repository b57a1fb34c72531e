"""Alembic's entry: the service hands over its open connection; the `alembic` command opens the one of the settings."""

import asyncio
from typing import Any, Literal

from alembic import context
from sqlalchemy import Connection
from sqlmodel import AutoString

from app.core.database.database import Database
from app.core.settings import load_settings, make_data_folder
from app.models import metadata
from app.models.columns import EnumColumn, UtcTime


def plain_type(kind: str, item: Any, autogen_context: Any) -> str | Literal[False]:
    """Migrations name only SQLAlchemy's own types, so that old ones run whatever becomes of the service's code."""
    if kind != "type":
        return False
    if isinstance(item, UtcTime):
        return "sa.DateTime()"
    if isinstance(item, EnumColumn):
        return f"sa.String({item.impl.length})"
    return f"sa.String({item.length})" if isinstance(item, AutoString) else False


def run_on(connection: Connection) -> None:
    """SQLite can change few things of a table in place: batch mode writes the table anew."""
    context.configure(
        connection=connection,
        target_metadata=metadata,
        render_as_batch=True,
        compare_type=True,
        render_item=plain_type,
    )
    with context.begin_transaction():
        context.run_migrations()


async def run_on_the_database_of_the_settings() -> None:
    settings = load_settings()
    make_data_folder(settings)
    database = Database(settings.url_of_database)
    async with database.rebuilding() as connection:
        await connection.run_sync(run_on)
    await database.close()


handed_over = context.config.attributes.get("connection")
if handed_over is None:
    asyncio.run(run_on_the_database_of_the_settings())
else:
    run_on(handed_over)
