"""`retain`: let go of what may not be kept any longer, now instead of tonight."""

import asyncio
from collections.abc import Mapping

from app.administration import migrate
from app.commands.speaking import AsJson, errors_in_words, say_json, say_table
from app.database import Database
from app.keeping.retention import retain as let_go
from app.settings import Settings, load_settings, open_clock


def retain(as_json: AsJson = False) -> None:
    """Take names out of old orders, delete old telemetry, codes and sessions. The service does so once a day itself.

    How long what is kept: CAMPUS_MAIL_KEEP_ORDERS_DAYS, CAMPUS_MAIL_KEEP_TELEMETRY_DAYS, CAMPUS_MAIL_KEEP_TRACES_DAYS.
    """
    with errors_in_words():
        done = asyncio.run(_retain(load_settings()))
    if as_json:
        say_json(done)
    else:
        say_table(("what", "rows"), done.items(), "Nothing was due.")


async def _retain(settings: Settings) -> Mapping[str, int]:
    await migrate(settings)
    database = Database(settings.url_of_database)
    try:
        return await let_go(database, settings, open_clock(settings).utc())
    finally:
        await database.close()
