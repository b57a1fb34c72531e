"""Waiting to the end, even if the caller is cancelled meanwhile."""

import asyncio
from typing import TypeVar

T = TypeVar("T")


async def shielded(outcome: asyncio.Future[T]) -> T:
    """Wait for it in any case.

    What is cancelled half-way in a database costs the connection, and with it what others have written in the same
    transaction. The cancellation comes all the same: at the next wait that is for something else.
    """
    try:
        return await asyncio.shield(outcome)
    except asyncio.CancelledError:
        pass
    while not outcome.done():
        try:
            await asyncio.wait([outcome])
        except asyncio.CancelledError:
            continue
    if task := asyncio.current_task():
        task.uncancel()
        task.cancel()
    return outcome.result()
