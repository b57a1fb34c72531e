"""Retention: what may be kept for how long, removed in small portions, so that no writer is held up.

Orders stay for ever as records without a name; everything that is about people or merely technical goes.
"""

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any, Final

from sqlalchemy import ColumnElement, Table, delete, or_, tuple_
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import Database
from app.core.settings import Settings
from app.models import (
    Alarm,
    BatterySample,
    ClaimRow,
    DurationRow,
    EnrolmentCode,
    ForecastRow,
    ForecastUnderWayRow,
    GrantRow,
    IdempotencyKey,
    MessageToRobot,
    OrderLink,
    OutgoingNotification,
    PersonSession,
    PersonToken,
    RefusedReceipt,
    RobotCommand,
    RobotMessage,
    SignInCode,
    metadata,
)
from app.retention.anonymization import forget_alarm_notices, forget_orders, forget_people, forget_standing_orders

PORTION: Final = 200
"""Rows of one transaction: some milliseconds."""
PAUSE_S: Final = 0.02
"""Between portions, so that waiting writers come in between."""

Work = Callable[[AsyncSession, datetime, int], Awaitable[int]]
"""Deal with at most so many rows from before a time; how many it were."""


def rows(*times: Any, only: ColumnElement[bool] | None = None) -> Work:
    """Delete the rows of a table of which one of these columns lies before the time."""
    table: Table = metadata.tables[times[0].class_.__tablename__]

    async def work(session: AsyncSession, before: datetime, at_most: int) -> int:
        key = table.primary_key.columns
        old = select(*key).where(or_(*(col(time) < before for time in times))).limit(at_most)
        old = old if only is None else old.where(only)
        which = tuple_(*key).in_(old) if len(key) > 1 else next(iter(key)).in_(old)
        connection = await session.connection()
        return (await connection.execute(delete(table).where(which))).rowcount

    return work


@dataclass(frozen=True)
class Rule:
    """One kind of thing and the setting that says how many days it is kept."""

    name: str
    days: str
    work: Work


ORDERS, TELEMETRY, TRACES = "keep_orders_days", "keep_telemetry_days", "keep_traces_days"
ANSWERED: Final = col(ClaimRow.granted).is_not(None)
RULES: Final = (
    Rule("orders", ORDERS, forget_orders),
    Rule("standing orders", ORDERS, forget_standing_orders),
    Rule("alarms", ORDERS, rows(Alarm.cleared_at)),
    Rule("notices of alarms", ORDERS, forget_alarm_notices),
    Rule("refused receipts", ORDERS, rows(RefusedReceipt.at)),
    Rule("commands", ORDERS, rows(RobotCommand.asked_at)),
    Rule("battery samples", TELEMETRY, rows(BatterySample.at)),
    Rule("durations", TELEMETRY, rows(DurationRow.at)),
    Rule("forecasts", TELEMETRY, rows(ForecastRow.begins_at)),
    Rule("forecasts under way", TELEMETRY, rows(ForecastUnderWayRow.told_at)),
    Rule("robot messages", TELEMETRY, rows(RobotMessage.received_at)),
    # What a robot has not acknowledged is still to be told to it, however old.
    Rule("messages to robots", TELEMETRY, rows(MessageToRobot.acked_at)),
    # A corridor is freed by its robot alone, however long that takes.
    Rule("grants", TELEMETRY, rows(GrantRow.cleared_at)),
    Rule("claims", TELEMETRY, rows(ClaimRow.at, only=ANSWERED)),
    Rule("sendings", TELEMETRY, rows(OutgoingNotification.sent_at, OutgoingNotification.gave_up_at)),
    Rule("sign-in codes", TRACES, rows(SignInCode.expires_at)),
    Rule("enrolment codes", TRACES, rows(EnrolmentCode.expires_at)),
    Rule("sessions", TRACES, rows(PersonSession.revoked_at, PersonSession.expires_at)),
    Rule("tokens of scripts", TRACES, rows(PersonToken.revoked_at, PersonToken.expires_at)),
    Rule("links", TRACES, rows(OrderLink.revoked_at, OrderLink.expires_at)),
    Rule("idempotency keys", TRACES, rows(IdempotencyKey.created_at)),
    # Last: who still had a session this morning has none now.
    Rule("people", ORDERS, forget_people),
)


async def retain(database: Database, settings: Settings, now: datetime, machine_s: float) -> Mapping[str, int]:
    """Do everything that is due; how many rows of each kind were dealt with. `machine_s`: what files' ages go by."""
    done = {}
    for rule in RULES:
        before = now - timedelta(days=getattr(settings, rule.days))
        done[rule.name] = await _in_portions(database, rule.work, before)
    done["mails in the spool"] = await asyncio.to_thread(_old_mails, settings, machine_s)
    return {name: count for name, count in done.items() if count}


async def _in_portions(database: Database, work: Work, before: datetime) -> int:
    total = 0
    while True:
        async with database.transaction() as session:
            count = await work(session, before, PORTION)
        total += count
        if count < PORTION:
            return total
        await asyncio.sleep(PAUSE_S)


def _old_mails(settings: Settings, machine_s: float) -> int:
    before_s = machine_s - settings.keep_telemetry_days * 86400
    old = [file for file in Path(settings.spool_folder).glob("*.eml") if file.stat().st_mtime < before_s]
    for file in old:
        file.unlink()
    return len(old)
