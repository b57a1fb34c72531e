"""Notes down what became of sendings: sent, to be tried again, or given up."""

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from typing import Final

import structlog
from sqlalchemy import bindparam, update
from sqlmodel import col
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import connection_of
from app.models import OutgoingNotification
from app.notifications.channels.interface import NotSent
from app.notifications.delivery.due import Due

log = structlog.get_logger(__name__)

FIRST_PAUSE_S: Final = 5.0
LONGEST_PAUSE_S: Final = 900.0

# By the key as well: the number of a row that was erased meanwhile may have been given to another.
_SENT: Final = (
    update(OutgoingNotification)
    .where(col(OutgoingNotification.id) == bindparam("its_id"), col(OutgoingNotification.key) == bindparam("its_key"))
    .values(tries=col(OutgoingNotification.tries) + 1, problem=None, next_try_at=None, sent_at=bindparam("now"))
)


def pause_s(tries: int) -> float:
    """Return the pause after the `tries`-th failure: doubling, to a quarter of an hour."""
    return float(min(FIRST_PAUSE_S * 2 ** min(tries - 1, 20), LONGEST_PAUSE_S))


async def note_sent(session: AsyncSession, sent: Sequence[Due], now: datetime) -> None:
    """Note all that went out, in one statement. What was erased meanwhile is not there any more."""
    if sent:
        connection = await connection_of(session)
        await connection.execute(_SENT, [{"its_id": one.id, "its_key": one.sending.key, "now": now} for one in sent])


async def note_not_sent(
    session: AsyncSession, not_sent: Sequence[tuple[Due, NotSent]], now: datetime, give_up: Mapping[str, timedelta]
) -> None:
    """Note what did not go out, each with its pause; `give_up`: after how long, by channel."""
    for due, problem in not_sent:
        row = await session.get(OutgoingNotification, due.id)
        if row is None or row.key != due.sending.key:  # erased meanwhile
            continue
        note(row, problem, now, give_up[due.channel])
        gave_up = row.gave_up_at is not None
        log.warning("notice not sent", key=row.key, problem=row.problem, gave_up=gave_up)


def note(row: OutgoingNotification, problem: NotSent, now: datetime, gives_up_after: timedelta) -> None:
    """Note a failed delivery: to be tried again, or given up."""
    row.tries += 1
    row.problem = str(problem)[:500]
    if problem.for_good or now - row.created_at >= gives_up_after:
        row.next_try_at, row.gave_up_at = None, now
    else:
        row.next_try_at = now + timedelta(seconds=problem.again_after_s or pause_s(row.tries))
