"""Orders as CSV for a spreadsheet: streamed portion by portion, each read in a moment of its own."""

from collections.abc import AsyncIterator
from datetime import UTC, datetime
from typing import Annotated, Any, Final

from fastapi import APIRouter, Query
from pydantic import AwareDatetime
from starlette.responses import StreamingResponse

from app.accounts.current_user import Dispatcher
from app.accounts.errors import RoleNeeded
from app.core.database.database import Database, DatabaseDep
from app.core.errors import BadRequest, problems
from app.core.settings import ClockDep
from app.retention.order_records import AT_ONCE, Place, csv_head, csv_lines, portion

router = APIRouter(tags=["dispatch"])

BYTE_ORDER_MARK: Final = "\ufeff"
"""Without it Excel takes UTF-8 for the letters of the machine's own country."""
LONG_AGO: Final = datetime(2020, 1, 1, tzinfo=UTC)
TABLE: Final[dict[int | str, dict[str, Any]]] = {200: {"content": {"text/csv": {"schema": {"type": "string"}}}}}
From = Annotated[
    AwareDatetime | None, Query(alias="from", description="Orders made from then on; else from the first.")
]
Until = Annotated[AwareDatetime | None, Query(alias="to", description="Orders made before then; else until now.")]


class CsvAnswer(StreamingResponse):
    """Pieces of one table."""

    media_type = "text/csv"


class BadRange(BadRequest):
    """The export would end before it begins."""

    code = "bad_range"


@router.get("/orders.csv", response_class=CsvAnswer, responses={**TABLE, **problems(BadRange, RoleNeeded)})
async def export_orders(
    user: Dispatcher, database: DatabaseDep, clock: ClockDep, begin: From = None, end: Until = None
) -> CsvAnswer:
    """Everybody's orders of a time as a table (CSV, RFC 4180, UTF-8 with a byte order mark), the oldest first.

    The columns keep their names and order; new ones come behind them. What would be run as a formula by a spreadsheet
    begins with an apostrophe.
    """
    begin, end = begin or LONG_AGO, end or clock.utc()
    if end < begin:
        raise BadRange("`to` is before `from`.")
    name = f"orders-{begin.date().isoformat()}-{end.date().isoformat()}.csv"
    headers = {"Content-Disposition": f'attachment; filename="{name}"', "Cache-Control": "no-store"}
    return CsvAnswer(pieces(database, begin.astimezone(UTC), end.astimezone(UTC)), headers=headers)


async def pieces(database: Database, begin: datetime, end: datetime, *, at_once: int = AT_ONCE) -> AsyncIterator[str]:
    """The table, piece by piece. No session is open while the reader takes its time over one."""
    emails: dict[str, str] = {}
    after: Place | None = None
    yield BYTE_ORDER_MARK + csv_head()
    while True:
        async with database.reading() as session:
            records, after = await portion(session, begin, end, after, emails, at_once)
        yield csv_lines(records)
        if after is None:
            return
