"""Takes notices to their channels, after the commit that wrote them and again after a failure.

Channels work side by side, each with places for so many sendings at once: a slow mail server holds up no push. What is
done is noted down together; a crash before that sends it again under the same key, by which the receiver can tell.
"""

import asyncio
from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import timedelta
from typing import Final

from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import Database
from app.core.trusted_clock import holds_on
from app.notifications import routing
from app.notifications.channels.interface import Channel, NotSent
from app.notifications.delivery import due
from app.notifications.delivery.attempts import note_not_sent, note_sent
from app.notifications.delivery.due import NOT_ROUTED, Due
from app.realtime.feed import Feed
from protocol.clock import Clock

POLL_EVERY_S: Final = 1.0
GATHER_S: Final = 0.1
"""What comes within this time is routed and noted down together."""
LONGEST_REST_S: Final = 0.5
FINISH_WITHIN_S: Final = 3.0
"""After that the service ends, and what has not gone out does at its next start."""

Ended = Mapping["asyncio.Task[NotSent | None]", Due]


@dataclass
class OutboxWorker:
    """Sends in the order of writing; `wake` it after a commit, else it looks once a second.

    `tell_service`: the webhook of the whole service is set.
    """

    database: Database
    feed: Feed
    clock: Clock
    channels: Sequence[Channel]
    tell_service: bool = False
    _bell: asyncio.Event = field(default_factory=asyncio.Event)
    _under_way: dict["asyncio.Task[NotSent | None]", Due] = field(default_factory=dict)
    _stopping: bool = False

    def wake(self, _changed: str = "") -> None:
        self._bell.set()

    def stop(self) -> None:
        """End `run` when everything that is due has gone out, or after FINISH_WITHIN_S."""
        self._stopping = True
        self.wake()

    async def run(self) -> None:
        """Until stopped or cancelled. If it fails (the database is busy, say) it may be begun again: what is under way
        goes on meanwhile, and is noted down then."""
        try:
            while not self._stopping:
                self._bell.clear()
                begun_s = asyncio.get_running_loop().time()
                if await self.work_once():
                    await asyncio.sleep(rest_s(asyncio.get_running_loop().time() - begun_s))
                else:
                    await self._wait_for_bell()
                    await asyncio.sleep(0 if self._stopping else GATHER_S)
            await self._finish()
        except asyncio.CancelledError:
            self._cut_off()
            raise
        self._cut_off()

    def _cut_off(self) -> None:
        """They are not noted down, and so sent again under their keys."""
        for task in self._under_way:
            task.cancel()
        self._under_way.clear()

    async def has_work(self) -> bool:
        """Tell if anything is to be routed, sent or noted down now."""
        has_new, due_now = await self._look()
        return bool(self._under_way or has_new or due_now)

    async def work_once(self) -> bool:
        """Note down what has ended, route what is new, begin what is due; whether there was any of it."""
        ended = self._ended()
        has_new, due_now = (False, []) if ended else await self._look()
        if ended or has_new:
            due_now = await self._write_down(ended)
        for channel, what in due_now:
            self._begin(channel, what)
        return bool(ended or has_new or due_now)

    async def _wait_for_bell(self) -> None:
        # Not `wait_for`: before Python 3.12 it loses a cancellation that comes just as the bell rings.
        with suppress(TimeoutError):
            async with asyncio.timeout(POLL_EVERY_S):
                await self._bell.wait()

    async def _finish(self) -> None:
        """Send what is due now, as far as the time goes; what hangs by then is cut off."""
        clock = asyncio.get_running_loop().time
        ends_s = clock() + FINISH_WITHIN_S
        while (left_s := ends_s - clock()) > 0 and await self.has_work():
            if not await self.work_once():
                if not self._under_way:
                    break  # of a channel that there is no more
                await asyncio.wait(self._under_way, timeout=left_s, return_when=asyncio.FIRST_COMPLETED)
        if ended := self._ended():
            async with self.database.transaction(durable=False) as session:
                await self._note(session, ended)

    def _ended(self) -> Ended:
        return {task: what for task, what in self._under_way.items() if task.done()}

    async def _look(self) -> tuple[bool, list[tuple[Channel, Due]]]:
        """Find out if there is anything new, and what is due: one question while nothing happens."""
        async with self.database.reading() as session:
            waiting = await due.waiting(session, self.clock.utc())
            return NOT_ROUTED in waiting, await self._due(session, waiting, self._under_way.values())

    async def _write_down(self, ended: Ended) -> list[tuple[Channel, Due]]:
        """Write down the ends of deliveries, and those that follow from new notices; return what is due then.

        No disk is waited for: after a power cut it is routed again, or sent again under its key.
        """
        async with self.database.transaction(durable=False) as session:
            await self._note(session, ended)
            waiting = await due.waiting(session, self.clock.utc())
            if NOT_ROUTED in waiting:
                waiting |= await routing.route(session, self.feed, self.clock.utc(), tell_service=self.tell_service)
            running = [what for task, what in self._under_way.items() if task not in ended]
            due_now = await self._due(session, waiting, running)
        for task in ended:
            del self._under_way[task]
        return due_now

    async def _note(self, session: AsyncSession, ended: Ended) -> None:
        now, outcomes = self.clock.utc(), [(what, task.result()) for task, what in ended.items()]
        await note_sent(session, [what for what, problem in outcomes if problem is None], now)
        failed = [(what, problem) for what, problem in outcomes if problem is not None]
        holds = holds_on(self.clock)
        give_up = {one.name: timedelta.max if holds else one.gives_up_after for one in self.channels}
        await note_not_sent(session, failed, now, give_up)

    async def _due(
        self, session: AsyncSession, waiting: Collection[str], running: Collection[Due]
    ) -> list[tuple[Channel, Due]]:
        """As many for each channel as it has places for."""
        found: list[tuple[Channel, Due]] = []
        for channel in self.channels:
            busy = [one for one in running if one.channel == channel.name]
            places = channel.at_once - len(busy)
            if channel.name in waiting and places > 0:
                following = await due.next_of(session, channel.name, self.clock.utc(), places, busy)
                found += [(channel, one) for one in following]
        return found

    def _begin(self, channel: Channel, what: Due) -> None:
        task = asyncio.create_task(_send(channel, what))
        self._under_way[task] = what
        task.add_done_callback(lambda _: self.wake())


async def _send(channel: Channel, what: Due) -> NotSent | None:
    try:
        await channel.send(what.sending)
    except NotSent as problem:
        return problem
    except Exception as error:
        # Whatever is wrong with one sending, those behind it go out.
        return NotSent(f"{type(error).__name__}: {error}")
    return None


def rest_s(took_s: float) -> float:
    """As long as the last round took, so that under load half the time at least is everybody else's."""
    return min(max(GATHER_S, took_s), LONGEST_REST_S)
