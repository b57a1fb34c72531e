"""Rate limits: counted in memory, per person or per network address.

The library counts in the machine's own time, also under a scaled clock: knocking is real. It keeps two numbers for
each knocker, of this window and of the one before, which counts less the longer ago it was.

    @router.post("/orders", dependencies=[per_person(Door.ORDERS)])
"""

import time
from collections import Counter
from collections.abc import AsyncIterator
from enum import StrEnum
from ipaddress import IPv6Address, IPv6Network, ip_address
from typing import Annotated, Any, Final

from fastapi import Depends, Request
from limits import parse
from limits.aio.storage import MemoryStorage
from limits.aio.strategies import SlidingWindowCounterRateLimiter

from app.accounts.current_user import AtBrowser, CurrentUser
from app.core.errors import TooManyRequests
from app.core.parts import find_part, part
from app.core.settings import Settings
from app.models import Person

HOME_BITS: Final = 64
"""The holder of one IPv6 address has a whole network of them."""
STREAM_PAUSE_S: Final = 10


class Door(StrEnum):
    """The things that are counted by themselves; `rate_limits` in the settings says how much is too much."""

    CODES = "sign_in_codes_per_address"
    CODES_OF_HOST = "sign_in_codes_per_host"
    CODES_OF_NEW_BROWSERS = "new_browser_codes_per_address"
    SIGN_IN = "sign_in_tries_per_host"
    ORDERS = "orders_per_person"
    CHANGES = "changes_per_person"
    DIGITS = "digits_tries_per_host"
    ENROLMENT = "enrolment_tries_per_host"
    LINKS = "link_tries_per_host"


class RateLimits:
    """One door-keeper per service process."""

    def __init__(self, settings: Settings) -> None:
        self._limiter = SlidingWindowCounterRateLimiter(MemoryStorage())
        self._limits = {door: parse(settings.rate_limits[door]) for door in Door}
        self._streams = settings.streams_per_person
        self._open_streams = Counter[str]()

    async def count(self, door: Door, who: str) -> None:
        """Raises TooManyRequests."""
        limit = self._limits[door]
        if await self._limiter.hit(limit, door, who):
            return
        reset_at_s, _ = await self._limiter.get_window_stats(limit, door, who)
        raise _too_often("Too often.", max(1, round(reset_at_s - time.time())))

    def open_stream(self, person_id: str) -> None:
        """Raises TooManyRequests. A stream that was let in leaves by `close_stream`."""
        if self._open_streams[person_id] >= self._streams:
            raise _too_often(f"You have {self._streams} event streams open already.", STREAM_PAUSE_S)
        self._open_streams[person_id] += 1

    def close_stream(self, person_id: str) -> None:
        self._open_streams[person_id] -= 1
        if self._open_streams[person_id] <= 0:
            del self._open_streams[person_id]


def _too_often(sentence: str, wait_s: int) -> TooManyRequests:
    return TooManyRequests(f"{sentence} Try again in {wait_s} s.", {"Retry-After": str(wait_s)})


def host_of(request: Request) -> str:
    """Where a request comes from: an IPv4 address, or the network that an IPv6 address is of."""
    host = request.client.host if request.client else ""
    try:
        ip = ip_address(host.partition("%")[0])
    except ValueError:
        return "unknown"
    return str(IPv6Network((ip, HOME_BITS), strict=False)) if isinstance(ip, IPv6Address) else host


LimitsDep = Annotated[RateLimits, part(RateLimits)]


def per_person(door: Door) -> Any:
    """Counts the signed-in person at this door: for `dependencies=`, or as the argument that the person is.

    FastAPI goes through all that a dependency depends on as often as it is named: a busy route names it once.
    """

    async def counted(request: Request, user: CurrentUser) -> Person:
        await find_part(request, RateLimits).count(door, user.id)
        return user

    return Depends(counted)


def per_person_at_browser(door: Door) -> Any:
    """The same for what no script may do: a script is refused as such, and not counted."""

    async def counted(request: Request, user: AtBrowser) -> Person:
        await find_part(request, RateLimits).count(door, user.id)
        return user

    return Depends(counted)


def per_host(door: Door) -> Any:
    """For `dependencies=`: counts the address at this door, for any caller."""

    async def counted(request: Request) -> None:
        await find_part(request, RateLimits).count(door, host_of(request))

    return Depends(counted)


async def _one_stream(user: CurrentUser, limits: LimitsDep) -> AsyncIterator[None]:
    limits.open_stream(user.id)
    try:
        yield
    finally:
        limits.close_stream(user.id)


one_stream: Final = Depends(_one_stream, scope="request")
"""For `dependencies=` of an event stream: until it ends it counts as open."""
