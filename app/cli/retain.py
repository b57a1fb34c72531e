"""`retain`: let go of what may not be kept any longer, now instead of tonight."""

import asyncio
import time
from collections.abc import Mapping
from typing import Annotated

import typer

from app.cli.administration import migrate
from app.cli.output import AsJson, errors_in_words, say_json, say_table
from app.core.database.database import Database
from app.core.errors import Refused
from app.core.settings import Settings, load_settings, open_clock
from app.core.trusted_clock import TrustedClock, holds_on
from app.retention.last_record import last_record
from app.retention.retention import retain as let_go
from protocol.clock import Clock


def retain(
    clock_is_right: Annotated[
        bool, typer.Option("--clock-is-right", help="Go by the clock, though nothing was written down for long.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Take names out of old orders, delete old telemetry, codes and sessions. The service does so once a day itself.

    Refused if the newest record and the clock are more than an hour apart: a clock that is wrong would take too much.
    How long what is kept: CAMPUS_MAIL_KEEP_ORDERS_DAYS, CAMPUS_MAIL_KEEP_TELEMETRY_DAYS, CAMPUS_MAIL_KEEP_TRACES_DAYS.
    """
    with errors_in_words():
        done = asyncio.run(_retain(load_settings(), clock_is_right))
    if as_json:
        say_json(done)
    else:
        say_table(("what", "rows"), done.items(), "Nothing was due.")


async def _retain(settings: Settings, clock_is_right: bool) -> Mapping[str, int]:
    await migrate(settings)
    database = Database(settings.url_of_database)
    try:
        clock = open_clock(settings)
        if not clock_is_right:
            await _compare_with_records(database, clock)
        return await let_go(database, settings, clock.utc(), time.time())
    finally:
        await database.close()


async def _compare_with_records(database: Database, clock: Clock) -> None:
    """Raises Refused."""
    if not isinstance(clock, TrustedClock):
        return
    async with database.reading() as session:
        last = await last_record(session)
    clock.compare_with_records(last)
    if holds_on(clock):
        raise Refused(
            f"The newest record is of {last:%Y-%m-%d %H:%M} UTC, the clock says {clock.utc():%Y-%m-%d %H:%M}. "
            "If the clock is right, say --clock-is-right; what is let go of does not come back."
        )
