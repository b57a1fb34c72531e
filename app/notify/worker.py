"""Takes notices to their channels, after the commit that wrote them and again after a failure.

Channels work side by side, each with places for so many sendings at once: a slow mail server holds up no push. What is
done is noted down together; a crash before that sends it again under the same key, by which whoever gets it can tell.
"""

import asyncio
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Final

import structlog
from sqlmodel import col, or_, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.database import Database
from app.live.feed import Feed
from app.notify import routing
from app.notify.channels.interface import Channel, NotSent, Sending
from app.tables import Notice, OutgoingNotice, Person
from protocol.clock import Clock

log = structlog.get_logger(__name__)

LOOK_EVERY_S: Final = 1.0
GATHER_S: Final = 0.1
"""What comes within this time is routed and noted down together."""
FIRST_PAUSE_S: Final = 5.0
LONGEST_PAUSE_S: Final = 900.0


def pause_s(tries: int) -> float:
    """How long to wait after the `tries`-th failure: doubling, to a quarter of an hour."""
    return float(min(FIRST_PAUSE_S * 2 ** min(tries - 1, 20), LONGEST_PAUSE_S))


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
    _under_way: dict[asyncio.Task[NotSent | None], OutgoingNotice] = field(default_factory=dict)
    _stopping: bool = False

    def wake(self) -> None:
        self._bell.set()

    def stop(self) -> None:
        """End `run` after what it is doing."""
        self._stopping = True
        self.wake()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        try:
            while not self._stopping:
                self._bell.clear()
                if not await self.work_once():
                    # Not `wait_for`: before Python 3.12 it loses a cancellation that comes just as the bell rings.
                    with suppress(TimeoutError):
                        async with asyncio.timeout(LOOK_EVERY_S):
                            await self._bell.wait()
                await asyncio.sleep(GATHER_S)
            await self._finish()
        finally:
            # Cut off: they are not noted down, and so sent again under their keys.
            for task in self._under_way:
                task.cancel()
            self._under_way.clear()

    async def has_work(self) -> bool:
        """Whether anything is to be routed, sent or noted down now."""
        async with self.database.reading() as session:
            due = select(OutgoingNotice.id).where(col(OutgoingNotice.next_try_at) <= self.clock.utc()).limit(1)
            waiting = (await session.exec(due)).first() is not None
            return bool(self._under_way) or waiting or bool(await routing.not_routed(session, 1))

    async def work_once(self) -> bool:
        """Note down what has ended, route what is new, begin what is due; whether there was any of it."""
        ended = await self._note_ended()
        routed = await self._route()
        return await self._begin_due() or routed or ended

    async def _finish(self) -> None:
        if self._under_way:
            await asyncio.wait(self._under_way)
        await self._note_ended()

    async def _route(self) -> bool:
        async with self.database.reading() as session:
            if not await routing.not_routed(session, 1):
                return False
        async with self.database.transaction() as session:
            await routing.route(session, self.feed, self.clock.utc(), tell_service=self.tell_service)
        return True

    async def _begin_due(self) -> bool:
        begun = False
        async with self.database.reading() as session:
            owing = await self._owing(session)
            for channel in self.channels:
                for outgoing in await self._due(session, channel) if channel.name in owing else ():
                    self._begin(channel, outgoing)
                    begun = True
        return begun

    def _begin(self, channel: Channel, outgoing: OutgoingNotice) -> None:
        task = asyncio.create_task(self._send(channel, outgoing))
        self._under_way[task] = outgoing
        task.add_done_callback(lambda _: self.wake())

    async def _owing(self, session: AsyncSession) -> set[str]:
        """The channels that have anything to send: mostly one or none, and the others are not asked further."""
        due = select(OutgoingNotice.channel).where(col(OutgoingNotice.next_try_at) <= self.clock.utc()).distinct()
        return set((await session.exec(due)).all())

    async def _due(self, session: AsyncSession, channel: Channel) -> list[OutgoingNotice]:
        """As many as the channel has places for; of each target the one that waits longest."""
        busy = [one for one in self._under_way.values() if one.channel == channel.name]
        places = channel.at_once - len(busy)
        if places <= 0:
            return []
        due = select(OutgoingNotice).where(
            OutgoingNotice.channel == channel.name,
            col(OutgoingNotice.next_try_at) <= self.clock.utc(),
            col(OutgoingNotice.id).not_in([one.id for one in busy]),
            or_(
                col(OutgoingNotice.target).is_(None),
                col(OutgoingNotice.target).not_in([one.target for one in busy if one.target]),
            ),
        )
        found = (await session.exec(due.order_by(col(OutgoingNotice.id)).limit(places))).all()
        return _one_for_each_target(found)

    async def _send(self, channel: Channel, outgoing: OutgoingNotice) -> NotSent | None:
        try:
            async with self.database.reading() as session:
                notice = await session.get_one(Notice, outgoing.notice_id)
                person = await session.get_one(Person, notice.person_id)
            await channel.send(Sending(outgoing.key, outgoing.target, notice, person))
        except NotSent as problem:
            return problem
        except Exception as error:
            # Whatever is wrong with one sending, those behind it go out.
            return NotSent(f"{type(error).__name__}: {error}")
        return None

    async def _note_ended(self) -> bool:
        ended = [task for task in self._under_way if task.done()]
        if not ended:
            return False
        async with self.database.transaction() as session:
            for task in ended:
                await self._note(session, self._under_way[task], task.result())
        for task in ended:
            del self._under_way[task]
        return True

    async def _note(self, session: AsyncSession, sent: OutgoingNotice, problem: NotSent | None) -> None:
        outgoing = await session.get(OutgoingNotice, sent.id)
        if outgoing is None:  # erased while it was under way
            return
        gives_up_after = next(one.gives_up_after for one in self.channels if one.name == outgoing.channel)
        note(outgoing, problem, self.clock.utc(), gives_up_after)
        if problem:
            gave_up = outgoing.gave_up_at is not None
            log.warning("notice not sent", key=outgoing.key, problem=outgoing.problem, gave_up=gave_up)


def _one_for_each_target(found: Sequence[OutgoingNotice]) -> list[OutgoingNotice]:
    targets: set[str] = set()
    first = []
    for one in found:
        if one.target is None or one.target not in targets:
            first.append(one)
            targets |= {one.target} if one.target else set()
    return first


def note(outgoing: OutgoingNotice, problem: NotSent | None, now: datetime, gives_up_after: timedelta) -> None:
    """What becomes of a sending after a try: sent, to be tried again, or given up."""
    outgoing.tries += 1
    outgoing.problem = None if problem is None else str(problem)[:500]
    outgoing.next_try_at = None
    if problem is None:
        outgoing.sent_at = now
    elif problem.for_good or now - outgoing.created_at >= gives_up_after:
        outgoing.gave_up_at = now
    else:
        outgoing.next_try_at = now + timedelta(seconds=problem.again_after_s or pause_s(outgoing.tries))
