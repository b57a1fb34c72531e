"""When a request may be sent again, and how long to wait before: pure decisions."""

import random
from collections.abc import Mapping
from dataclasses import dataclass

import httpx

SAFE_TO_REPEAT = frozenset({"GET", "HEAD", "PUT", "DELETE"})
NOT_DONE = frozenset({429, 503})
"""The service says that it has done nothing."""
PERHAPS_DONE = frozenset({502, 504})
STILL_RUNNING = "still_running"
DATABASE_AWAY = "database_away"


@dataclass(frozen=True)
class Retrying:
    """`tries` in all; pauses double from `first_pause_s`, half of each by chance, unless Retry-After names one."""

    tries: int = 4
    first_pause_s: float = 0.25
    longest_pause_s: float = 30.0

    def pause_s(self, tries_made: int, retry_after: str = "") -> float | None:
        """Return the pause before the next try; None: no more tries, or the pause is longer than a program may wait
        unasked."""
        if tries_made >= self.tries:
            return None
        if retry_after.isdecimal():
            return float(retry_after) if float(retry_after) <= self.longest_pause_s else None
        full_s = min(self.first_pause_s * 2.0 ** (tries_made - 1), self.longest_pause_s)
        return full_s * random.uniform(0.5, 1.0)  # spreads the callers


def may_repeat_after_answer(method: str, headers: Mapping[str, str], status: int, code: str) -> bool:
    """Tell if an answer invites to the same request again."""
    if code == DATABASE_AWAY:  # its last word may have been lost on the way
        return is_repeatable(method, headers)
    if status in NOT_DONE or code == STILL_RUNNING:
        return True
    return status in PERHAPS_DONE and is_repeatable(method, headers)


def may_repeat_after_failure(method: str, headers: Mapping[str, str], failure: httpx.TransportError) -> bool:
    """Tell if a request that got no answer may be sent again: it never left, or it changes nothing twice."""
    never_left = isinstance(failure, httpx.ConnectError | httpx.ConnectTimeout | httpx.PoolTimeout)
    return never_left or is_repeatable(method, headers)


def is_repeatable(method: str, headers: Mapping[str, str]) -> bool:
    """Done twice it is done once: by its method, or by its Idempotency-Key."""
    return method in SAFE_TO_REPEAT or "Idempotency-Key" in headers
