"""Takes notices from the outbox to their channel, after the commit that wrote them and again after a failure."""

import asyncio
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import datetime, timedelta

import structlog
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.database import Database
from app.mail import Mail, Spool
from app.settings import Settings
from app.tables import Notice, NoticeKind, OutgoingNotice, Person
from app.texts import text
from protocol.clock import Clock

log = structlog.get_logger(__name__)

AT_ONCE = 50
LOOK_EVERY_S = 1.0
FIRST_PAUSE_S = 5.0
LONGEST_PAUSE_S = 900.0

CodePicture = Callable[[str, NoticeKind], tuple[str, bytes] | None]
"""The picture of the hand-over code that goes with a notice: (order id, kind) -> (file name, PNG), or None."""


def pause_s(tries: int) -> float:
    """How long to wait after the `tries`-th failure: doubling, to a quarter of an hour."""
    return float(min(FIRST_PAUSE_S * 2 ** (tries - 1), LONGEST_PAUSE_S))


@dataclass
class OutboxWorker:
    """Sends in the order of writing; `wake` it after a commit, else it looks once a second."""

    database: Database
    spool: Spool
    settings: Settings
    clock: Clock
    code_picture: CodePicture
    _bell: asyncio.Event = field(default_factory=asyncio.Event)
    _stopping: bool = False

    def wake(self) -> None:
        self._bell.set()

    def stop(self) -> None:
        """End `run` after what it is doing."""
        self._stopping = True
        self.wake()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        while not self._stopping:
            self._bell.clear()
            if await self.work_once() < AT_ONCE:
                # Not `wait_for`: before Python 3.12 it loses a cancellation that comes just as the bell rings.
                with suppress(TimeoutError):
                    async with asyncio.timeout(LOOK_EVERY_S):
                        await self._bell.wait()

    async def work_once(self) -> int:
        """Send what is due; how many sendings were tried."""
        async with self.database.reading() as session:
            due = await self._due(session)
        for outgoing in due:
            await self._send(outgoing)
        return len(due)

    async def _due(self, session: AsyncSession) -> list[OutgoingNotice]:
        waiting = select(OutgoingNotice).where(
            col(OutgoingNotice.sent_at).is_(None), OutgoingNotice.next_try_at <= self.clock.utc()
        )
        return list((await session.exec(waiting.order_by(col(OutgoingNotice.id)).limit(AT_ONCE))).all())

    async def _send(self, outgoing: OutgoingNotice) -> None:
        """Send, then note it down: a crash in between sends again under the same key, which the channel knows."""
        problem = None
        try:
            async with self.database.reading() as session:
                mail = await self._mail(session, outgoing)
            await asyncio.to_thread(self.spool.send, mail)
        except Exception as error:
            # Whatever is wrong with one mail, those behind it go out.
            problem = f"{type(error).__name__}: {error}"[:500]
            log.warning("mail not spooled", key=outgoing.key, problem=problem)
        async with self.database.transaction() as session:
            session.add(outgoing)
            _note(outgoing, problem, self.clock.utc())

    async def _mail(self, session: AsyncSession, outgoing: OutgoingNotice) -> Mail:
        notice = await session.get_one(Notice, outgoing.notice_id)
        person = await session.get_one(Person, notice.person_id)
        picture = self.code_picture(notice.order_id, notice.kind)
        title = text(person.language, f"notice.{notice.kind}.title", notice.facts)
        return Mail(
            outgoing.key, person.email, title, self._body(notice, person, picture is not None), notice.at, picture
        )

    def _body(self, notice: Notice, person: Person, has_code: bool) -> str:
        url = f"{self.settings.public_url.rstrip('/')}/follow.html?order={notice.order_id}"
        parts = [text(person.language, f"notice.{notice.kind}.body", notice.facts)]
        parts += [text(person.language, "mail.code")] if has_code else []
        parts += [text(person.language, "mail.link", {"url": url})] if self.settings.public_url else []
        return "\n\n".join(parts) + "\n"


def _note(outgoing: OutgoingNotice, problem: str | None, now: datetime) -> None:
    outgoing.tries += 1
    outgoing.problem = problem
    if problem is None:
        outgoing.sent_at = now
    else:
        outgoing.next_try_at = now + timedelta(seconds=pause_s(outgoing.tries))
