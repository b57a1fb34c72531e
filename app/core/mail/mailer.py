"""The way out for mails: the configured server, or the spool folder until there is one."""

import asyncio
from dataclasses import dataclass, field
from typing import Protocol

import structlog

from app.core.mail.message import Mail, message_of
from app.core.mail.smtp import NotMailed, SmtpServer
from app.core.mail.soon import SentSoon
from app.core.mail.spool import Spool
from app.core.settings import Settings

log = structlog.get_logger(__name__)


class Mailer(Protocol):
    """The way out, as features see it."""

    @property
    def at_once(self) -> int: ...

    async def send(self, mail: Mail) -> None:
        """Hand it over now. Raises NotMailed."""
        ...

    async def send_soon(self, mail: Mail) -> None:
        """For what is kept nowhere (a sign-in code): the caller does not wait for a slow server, and asks no more."""
        ...

    async def begin(self) -> None:
        """Before the first mail; takes a moment."""
        ...

    async def finish(self, within_s: float) -> int:
        """End what `send_soon` still has to do; how many mails are left for the next start."""
        ...


@dataclass
class SpoolMailer:
    """Writes files, one batch after the other: what comes meanwhile is the next batch."""

    spool: Spool
    at_once: int = 32
    _waiting: list[tuple[Mail, asyncio.Future[None]]] = field(default_factory=list)
    _writing: asyncio.Task[None] | None = None

    async def send(self, mail: Mail) -> None:
        written: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._waiting.append((mail, written))
        if self._writing is None:
            self._writing = asyncio.create_task(self._write_what_waits())
        try:
            await written
        except OSError as error:
            raise NotMailed(f"{type(error).__name__}: {error}") from error

    async def send_soon(self, mail: Mail) -> None:
        await self.send(mail)

    async def _write_what_waits(self) -> None:
        batch: list[tuple[Mail, asyncio.Future[None]]] = []
        try:
            while self._waiting:
                batch, self._waiting = self._waiting, []
                problems = await asyncio.to_thread(self.spool.send_all, [mail for mail, _ in batch])
                for (_, written), problem in zip(batch, problems, strict=True):
                    _end(written, problem)
        finally:
            self._writing = None
            for _, written in batch:  # cut off: no caller shall wait for ever
                written.cancel()

    async def begin(self) -> None:
        try:
            count = await asyncio.to_thread(self.spool.tidy)
        except OSError as problem:  # a folder that cannot be tidied may still take mails
            log.warning("the spool cannot be tidied", problem=str(problem))
        else:
            if count:
                log.info("half-written mails removed", count=count)

    async def finish(self, within_s: float) -> int:
        return 0


def _end(written: asyncio.Future[None], problem: Exception | None) -> None:
    if written.done():  # its caller waits no longer
        return
    if problem is None:
        written.set_result(None)
    else:
        written.set_exception(problem)


@dataclass(frozen=True)
class SmtpMailer:
    """Speaks SMTP."""

    server: SmtpServer
    sender: str
    soon: SentSoon
    at_once: int = 8

    async def send(self, mail: Mail) -> None:
        await self.server.send(message_of(mail, self.sender))

    async def send_soon(self, mail: Mail) -> None:
        # How long it takes must not tell if an address is known here, and a slow server keeps no request waiting.
        await self.soon.send(mail)

    async def begin(self) -> None:
        await self.soon.begin()

    async def finish(self, within_s: float) -> int:
        return await self.soon.finish(within_s)


def open_mailer(settings: Settings) -> Mailer:
    """SMTP if a server is set, else the spool."""
    if not settings.smtp_host:
        return SpoolMailer(Spool(settings.spool_folder, settings.mail_from))
    server = SmtpServer.of(settings)
    waiting = Spool(settings.waiting_mails_folder, settings.mail_from)
    return SmtpMailer(server, settings.mail_from, SentSoon(server, waiting, settings.sign_in_code_lifetime_s))
