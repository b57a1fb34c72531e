"""`backup` and `restore`."""

import asyncio
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import Progress
from sqlalchemy import inspect

from app.cli.output import AsJson, errors_in_words, say_json
from app.core.database.database import Database
from app.core.settings import Settings, load_settings, make_data_folder, open_clock
from app.retention.backup import BackupRequest, Manifest, back_up
from app.retention.restoring import restore as put_back
from protocol.software import version


def backup(
    to: Annotated[Path, typer.Argument(metavar="FILE", help="New archive, such as mail-2026-11-22.tar.gz.")],
    with_keys: Annotated[bool, typer.Option("--keys/--no-keys", help="With the service's secret keys.")] = True,
    as_json: AsJson = False,
) -> None:
    """Write database and keys into one archive, beside the running service. It is checked before it is written.

    The archive holds names, addresses and the key of all hand-over codes: keep it as safe as the data folder. Without
    --keys the codes in people's mails are worthless after a restore. On PostgreSQL pg_dump writes the database.
    """
    with errors_in_words():
        settings = load_settings()
        request = BackupRequest(settings, version(), open_clock(settings).utc(), with_keys)
        with Progress(console=Console(stderr=True), transient=True, disable=as_json) as bar:
            task = bar.add_task("copying", total=1.0)
            manifest = back_up(request, to.resolve(), lambda part: bar.update(task, completed=part))
    _tell(to, manifest, as_json)


def restore(
    archive: Annotated[Path, typer.Argument(metavar="FILE", help="An archive that `backup` wrote.")],
    replace: Annotated[
        bool, typer.Option("--replace", help="Put what is there aside, into a folder of its own.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Put a backup in place, after every check that it is whole. Refused while a service runs in the data folder.

    Robots notice by themselves that the service has gone back in time, and say again what it has forgotten.
    """
    with errors_in_words():
        settings = load_settings()
        make_data_folder(settings)
        now = open_clock(settings).utc()
        manifest, aside = put_back(settings, archive, now, replace=replace, is_empty=lambda: _is_empty(settings))
    _tell(archive, manifest, as_json, aside)


def _is_empty(settings: Settings) -> bool:
    async def look() -> bool:
        database = Database(settings.url_of_database)
        try:
            async with database.engine.connect() as connection:
                return await connection.run_sync(lambda plain: not inspect(plain).get_table_names())
        finally:
            await database.close()

    # A SQLite file is a file: whether it is there is seen without opening it.
    return True if settings.url_of_database.startswith("sqlite") else asyncio.run(look())


def _tell(archive: Path, manifest: Manifest, as_json: bool, aside: Path | None = None) -> None:
    if as_json:
        kept = {"kept_aside": str(aside)} if aside else {}
        say_json({"archive": str(archive), **manifest.model_dump(mode="json"), **kept})
        return
    rows = ", ".join(f"{count} {name}" for name, count in manifest.rows.items()) or manifest.database
    typer.echo(f"{archive}: {rows}; schema {manifest.revision}; made {manifest.made_at:%Y-%m-%d %H:%M} UTC")
    typer.echo(f"with {', '.join(file.name for file in manifest.files)}; left out: {', '.join(manifest.left_out)}")
    if aside:
        typer.echo(f"What was there before is in {aside}.")
