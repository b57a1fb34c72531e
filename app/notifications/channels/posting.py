"""One POST to an address from outside, and what its answer means for a second try."""

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import httpx

from app.core.http_client import TIMEOUT_S, TargetRefused
from app.notifications.channels.interface import NotSent

LONGEST_WAIT_S: Final = 3600.0
LATER: Final = frozenset({408, 425, 429})
GONE: Final = frozenset({404, 410})


@dataclass(frozen=True)
class Answer:
    """The answer of the other side; its body is of no use and is not read."""

    status: int
    again_after_s: float | None

    @property
    def is_good(self) -> bool:
        return 200 <= self.status < 300

    @property
    def is_for_later(self) -> bool:
        return self.status in LATER or self.status >= 500


async def post(
    client: httpx.AsyncClient, url: str, content: bytes, headers: Mapping[str, str], within_s: float = TIMEOUT_S
) -> Answer:
    """Raises NotSent if there was no answer in time: all of it, since the client's own limit is between two bytes."""
    try:
        async with (
            asyncio.timeout(within_s),
            client.stream("POST", url, content=content, headers=dict(headers)) as answer,
        ):
            return Answer(answer.status_code, _wait_s(answer.headers.get("Retry-After", "")))
    except (TimeoutError, httpx.HTTPError, httpx.InvalidURL) as error:
        raise NotSent(f"no answer: {type(error).__name__}") from error
    except TargetRefused as error:
        # Not for good: a name server that is away says the same.
        raise NotSent(error.sentence) from error


def _wait_s(retry_after: str) -> float | None:
    return min(float(retry_after), LONGEST_WAIT_S) if retry_after.isdecimal() else None
