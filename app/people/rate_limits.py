"""How often somebody may knock: per mail address and per network address, counted in memory.

The library counts in the machine's own time, also under a scaled clock: knocking is real.
"""

import time

from limits import parse
from limits.aio.storage import MemoryStorage
from limits.aio.strategies import MovingWindowRateLimiter

from app.errors import TooManyRequests
from app.settings import Settings


class RateLimits:
    """One door-keeper per service process."""

    def __init__(self, settings: Settings) -> None:
        self._limiter = MovingWindowRateLimiter(MemoryStorage())
        self._codes = parse(settings.sign_in_codes_per_address)
        self._tries = parse(settings.sign_in_tries_per_host)

    async def count_code(self, email: str) -> None:
        """Raises TooManyRequests."""
        await self._count(self._codes, "code", email)

    async def count_try(self, host: str) -> None:
        """Raises TooManyRequests."""
        await self._count(self._tries, "try", host)

    async def _count(self, limit: object, *key: str) -> None:
        if await self._limiter.hit(limit, *key):  # type: ignore[arg-type]
            return
        reset_at_s, _ = await self._limiter.get_window_stats(limit, *key)  # type: ignore[arg-type]
        wait_s = max(1, round(reset_at_s - time.time()))
        raise TooManyRequests(f"Too often. Try again in {wait_s} s.", {"Retry-After": str(wait_s)})
