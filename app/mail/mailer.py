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

    def stop(self) -> None:
        """End what `send_soon` still has to do."""
        ...


@dataclass(frozen=True)
class SpoolMailer:
    """Writes files."""

    spool: Spool
    at_once: int = 32

    async def send(self, mail: Mail) -> None:
        try:
            await asyncio.to_thread(self.spool.send, mail)
        except OSError as error:
            raise NotMailed(f"{type(error).__name__}: {error}") from error

    async def send_soon(self, mail: Mail) -> None:
        await self.send(mail)

    def stop(self) -> None:
        pass


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

    def stop(self) -> None:
        for task in self._soon:
            task.cancel()


def open_mailer(settings: Settings) -> Mailer:
    """SMTP if a server is set, else the spool."""
    if settings.smtp_host:
        return SmtpMailer(SmtpServer.of(settings), settings.mail_from)
    return SpoolMailer(Spool(settings.spool_folder, settings.mail_from))
