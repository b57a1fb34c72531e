"""When what runs in the background looks round: soon after it is woken, again after a while, and never all the time."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import suppress
from typing import Final

REST: Final = 19
"""A busy service has other things to do than to look again: a rest of so many times as long as a look has taken, so
that none of the four or five who look round takes more than a twentieth of the time."""
PIECE_S: Final = 0.005
"""Real seconds. A piece of a look that took less goes on to the next one."""
LONGEST_REST_S: Final = 1.0
"""Real seconds. A look that had to wait for others took long without having done much."""


class PollingLoop:
    """`async for _ in looks.until_stopped()`: each turn is one look. All times are real seconds, on the event loop.

    `again_s`: nothing should be missed between two wakes; if it is after all, it does not wait for ever.
    `rest_s`: after each look, so that what changes in one moment is looked at once; after a long look `rest` times as
    long as it took, up to `longest_rest_s`. `waits_first`: it was looked just before.
    """

    def __init__(
        self,
        again_s: float,
        rest_s: float,
        *,
        rest: float = REST,
        longest_rest_s: float = LONGEST_REST_S,
        waits_first: bool = False,
    ) -> None:
        self._waits_first = waits_first
        self.again_s, self.rest_s, self._rest, self._longest_rest_s = again_s, rest_s, rest, longest_rest_s
        self._woken, self._stopped = asyncio.Event(), asyncio.Event()
        self._begun_s = 0.0
        """When the present look began, or its last piece."""

    def wake(self, _changed: str = "") -> None:
        """Something has changed: look once more."""
        self._woken.set()

    @property
    def is_stopped(self) -> bool:
        return self._stopped.is_set()

    def stop(self) -> None:
        """No look begins any more, and no rest holds up the end."""
        self._stopped.set()
        self._woken.set()

    async def until_stopped(self) -> AsyncIterator[None]:
        """The first at once, or when woken. What wakes during a look is seen by the next one."""
        if self._waits_first:
            await _for(self._woken, self.again_s)
        while not self._stopped.is_set():
            self._woken.clear()
            self._begun_s = asyncio.get_running_loop().time()
            yield
            await _for(self._stopped, max(self.rest_s, self._earned_s(self._worked_s())))
            await _for(self._woken, self.again_s)

    async def breathe(self) -> None:
        """Between two pieces of one look: the rest that the first has earned, so that a long look is spread out."""
        worked_s = self._worked_s()
        if worked_s < PIECE_S:
            await asyncio.sleep(0)
            return
        await _for(self._stopped, self._earned_s(worked_s))
        self._begun_s = asyncio.get_running_loop().time()

    def _worked_s(self) -> float:
        return asyncio.get_running_loop().time() - self._begun_s

    def _earned_s(self, worked_s: float) -> float:
        return min(self._rest * worked_s, self._longest_rest_s)


async def _for(event: asyncio.Event, at_most_s: float) -> None:
    with suppress(TimeoutError):
        async with asyncio.timeout(at_most_s):
            await event.wait()
