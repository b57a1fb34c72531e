"""Background work of the service: started with it, restarted after a failure, stopped in order."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from typing import Final, Protocol

import structlog
from fastapi import FastAPI

from app.composition.parts import Parts, parts_of
from app.core.database.schema_version import bring_to_head
from app.core.errors import DATABASE_AWAY
from app.core.trusted_clock import TrustedClock
from app.notifications.delivery.worker import FINISH_WITHIN_S
from app.notifications.lag import outbox_lag
from app.retention.last_record import last_record

RESTART_PAUSE_S: Final = 1.0
STOP_WITHIN_S: Final = 2.0

log = structlog.get_logger(__name__)


class Worker(Protocol):
    """Runs until it is stopped."""

    async def run(self) -> None: ...
    def stop(self) -> None: ...


@asynccontextmanager
async def lifespan(app: FastAPI) -> AsyncIterator[None]:
    """Start the background work, and stop it when the service ends."""
    parts = parts_of(app)
    await _begin(parts)
    workers = _workers(parts)
    background = [asyncio.create_task(_keep_running(name, worker.run)) for name, worker in workers.items()]
    outbox = asyncio.create_task(_keep_running("outbox", parts.outbox_worker.run))
    try:
        yield
    finally:
        parts.feed.close()
        for worker in workers.values():
            worker.stop()
        await _ended(background, STOP_WITHIN_S)
        # The last, so that what the others have just written goes out too.
        parts.outbox_worker.stop()
        finishing = asyncio.create_task(parts.mailer.finish(FINISH_WITHIN_S))
        await _ended([outbox], FINISH_WITHIN_S + STOP_WITHIN_S)
        await _say_what_is_left(parts, await finishing)
        await parts.public_http.aclose()
        await parts.operator_http.aclose()
        await parts.database.close()


def _workers(parts: Parts) -> dict[str, Worker]:
    return {
        "dispatch": parts.dispatcher,
        "timer": parts.timer,
        "retention": parts.retention_job,
        "last_seen": parts.last_seen,
        "estimates": parts.fleet.learning,
        "eta_updates": parts.eta_updates,
        "energy_use": parts.fleet.spending,
        "charging": parts.charging_service,
        "traffic": parts.traffic_service,
        "planning": parts.planner,
    }


async def _begin(parts: Parts) -> None:
    await bring_to_head(parts.database)
    if isinstance(parts.clock, TrustedClock):
        async with parts.database.reading() as session:
            parts.clock.compare_with_records(await last_record(session))
    await parts.fleet.begin()
    await parts.fleet.learning.begin()
    await parts.fleet.spending.learn()
    await parts.mailer.begin()


async def _say_what_is_left(parts: Parts, sign_in_mails: int) -> None:
    """Log what is undelivered: an operator who moves or restores the service has to know."""
    try:
        async with parts.database.reading() as session:
            lag = await outbox_lag(session, parts.clock.utc())
    except Exception:
        log.exception("the service stops; what is left could not be counted", sign_in_mails_left=sign_in_mails)
    else:
        left = {"notices_left": sum(lag.waiting.values()) + lag.not_routed, "sign_in_mails_left": sign_in_mails}
        log.info("the service stops", **left)


async def _ended(background: list[asyncio.Task[None]], within_s: float) -> None:
    """Let background work finish its transaction, and cut it off only if that takes long.

    A transaction that is cut off keeps SQLite's write lock until its cursor is collected, and so holds up the others.
    """
    await asyncio.wait(background, timeout=within_s)
    for task in background:
        task.cancel()
    await asyncio.gather(*background, return_exceptions=True)


async def _keep_running(name: str, run: Callable[[], Awaitable[None]]) -> None:
    """Run background work again after a failure, which is logged."""
    while True:
        try:
            return await run()
        except DATABASE_AWAY as error:
            log.warning("background_work_waits_for_the_database", name=name, why=str(error))
            await asyncio.sleep(RESTART_PAUSE_S)
        except Exception:
            log.exception("background work failed and starts again", name=name)
            await asyncio.sleep(RESTART_PAUSE_S)
