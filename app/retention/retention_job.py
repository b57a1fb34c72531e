"""Keeps the house while the service runs: once a day it lets go of what may not be kept any longer."""

import asyncio
import time
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Final

import structlog

from app.core.database.database import Database
from app.core.settings import Settings
from app.core.trusted_clock import holds_on
from app.retention.retention import retain
from protocol.clock import Clock

AFTER_START_S: Final = 300.0
"""Real seconds; a service that starts has better things to do first."""
EVERY_S: Final = 86400.0
AGAIN_S: Final = 60.0

log = structlog.get_logger(__name__)


@dataclass
class RetentionJob:
    """Runs in the background of the service."""

    database: Database
    settings: Settings
    clock: Clock
    _stopped: asyncio.Event = field(default_factory=asyncio.Event)

    def stop(self) -> None:
        """End `run`, between two portions at the latest."""
        self._stopped.set()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        pause_s = AFTER_START_S
        while not self._stopped.is_set():
            with suppress(TimeoutError):
                async with asyncio.timeout(pause_s):
                    await self._stopped.wait()
                return
            pause_s = EVERY_S if await self.keep_house() else AGAIN_S

    async def keep_house(self) -> bool:
        """Let go of what is due; False, and nothing is done, while the clock cannot be trusted."""
        if holds_on(self.clock):
            return False
        done = await retain(self.database, self.settings, self.clock.utc(), time.time())
        log.info("retained", **{name.replace(" ", "_"): count for name, count in done.items()})
        return True
