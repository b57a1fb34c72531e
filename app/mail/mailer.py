"""The way out for mails: the configured server, or the spool folder until there is one."""

import asyncio
from dataclasses import dataclass, field
from typing import Final, Protocol

import structlog

from app.mail.message import Mail, message_of
from app.mail.smtp import NotMailed, SmtpServer
from app.mail.spool import Spool
from app.settings import Settings

log = structlog.get_logger(__name__)

PAUSES_S: Final = (0.0, 5.0, 20.0, 60.0, 180.0)
"""Before each try of a mail that nobody keeps: within the ten minutes for which a sign-in code is good."""


class Mailer(Protocol):
    """What features see of the way out."""

    @property
    def at_once(self) -> int: ...

    async def send(self, mail: Mail) -> None:
        """Hand it over now. Raises NotMailed."""
        ...

    async def send_soon(self, mail: Mail) -> None:
        """For what is kept nowhere (a sign-in code): the caller does not wait for a slow server, and asks no more."""
        ...

    def begin(self) -> None:
        """Before the first mail; takes a moment."""
        ...

    def stop(self) -> None:
        """End what `send_soon` still has to do."""
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
            for _, written in batch:  # cut off: nobody shall wait for ever
                written.cancel()

    def begin(self) -> None:
        try:
            count = self.spool.tidy()
        except OSError as problem:  # a folder that cannot be tidied may still take mails
            log.warning("the spool cannot be tidied", problem=str(problem))
        else:
            if count:
                log.info("half-written mails removed", count=count)

    def stop(self) -> None:
        pass


def _end(written: asyncio.Future[None], problem: Exception | None) -> None:
    if written.done():  # whoever wanted it waits no longer
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
    at_once: int = 8
    _soon: set[asyncio.Task[None]] = field(default_factory=set)

    async def send(self, mail: Mail) -> None:
        await self.server.send(message_of(mail, self.sender))

    async def send_soon(self, mail: Mail) -> None:
        # How long it takes must not tell whether somebody is known here, and a slow server keeps nobody waiting.
        task = asyncio.create_task(self._try_again_and_again(mail))
        self._soon.add(task)
        task.add_done_callback(self._soon.discard)

    async def _try_again_and_again(self, mail: Mail) -> None:
        for pause_s in PAUSES_S:
            await asyncio.sleep(pause_s)
            try:
                return await self.send(mail)
            except NotMailed as problem:
                log.warning("mail not sent", key=mail.key, problem=str(problem), for_good=problem.for_good)
                if problem.for_good:
                    return None
        return None

    def begin(self) -> None:
        pass

    def stop(self) -> None:
        for task in self._soon:
            task.cancel()


def open_mailer(settings: Settings) -> Mailer:
    """SMTP if a server is set, else the spool."""
    if settings.smtp_host:
        return SmtpMailer(SmtpServer.of(settings), settings.mail_from)
    return SpoolMailer(Spool(settings.spool_folder, settings.mail_from))
