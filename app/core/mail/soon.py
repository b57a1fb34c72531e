"""Mails of which their caller keeps nothing (sign-in codes): each is a file until it is out, and survives a stop.

The database has the hash of a code alone, so its mail cannot be written anew. The file lies in the data folder, beside
the key that makes hand-over codes, for as long as the mail server is away and the code is good.
"""

import asyncio
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from email.message import EmailMessage
from email.parser import BytesParser
from itertools import chain, repeat
from pathlib import Path
from typing import Final, cast

import structlog

from app.core.mail.headers import MAIL
from app.core.mail.message import Mail, message_of
from app.core.mail.smtp import NotMailed, SmtpServer
from app.core.mail.spool import Spool

FIRST_PAUSES_S: Final = (0.0, 5.0, 20.0)
PAUSE_S: Final = 60.0
"""Between all further tries, for as long as the mail is of use."""

_READ: Final = BytesParser(EmailMessage, policy=MAIL)
log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class SentSoon:
    """`waiting`: a folder of its own; `lifetime_s`: for how long a mail is of use."""

    server: SmtpServer
    waiting: Spool
    lifetime_s: float
    _tries: set[asyncio.Task[None]] = field(default_factory=set)
    _told_to_finish: asyncio.Event = field(default_factory=asyncio.Event)

    async def begin(self) -> None:
        """Go on with what the last process could not send."""
        try:
            for file, message, left_s in await asyncio.to_thread(self._still_of_use):
                self._start(file, message, left_s)
        except OSError as problem:
            log.warning("mails that wait cannot be read", problem=str(problem))

    async def send(self, mail: Mail) -> None:
        """Keep it and begin; how long the mail server takes is not the caller's concern."""
        try:
            await asyncio.to_thread(self.waiting.send, mail)
        except OSError as problem:  # it may go out all the same
            log.warning("a mail that waits cannot be kept", problem=str(problem))
        self._start(self.waiting.file_of(mail), message_of(mail, self.waiting.sender), self.lifetime_s)

    async def finish(self, within_s: float) -> int:
        """Try each once more, without a pause; how many are left for the next start."""
        self._told_to_finish.set()
        if self._tries:
            await asyncio.wait(self._tries, timeout=within_s)
        for task in self._tries:
            task.cancel()
        await asyncio.gather(*self._tries, return_exceptions=True)
        return len(list(self.waiting.files()))

    def _still_of_use(self) -> list[tuple[Path, EmailMessage, float]]:
        """Each with how long it still is."""
        self.waiting.tidy()
        since_s, found = time.time() - self.lifetime_s, []
        for file in self.waiting.files():
            left_s = file.stat().st_mtime - since_s
            if left_s < 0:
                file.unlink()
            else:
                found.append((file, cast(EmailMessage, _READ.parsebytes(file.read_bytes())), left_s))
        return found

    def _start(self, file: Path, message: EmailMessage, left_s: float) -> None:
        task = asyncio.create_task(self._try_while_of_use(file, message, left_s))
        self._tries.add(task)
        task.add_done_callback(self._tries.discard)

    async def _try_while_of_use(self, file: Path, message: EmailMessage, left_s: float) -> None:
        try:
            async with asyncio.timeout(left_s):
                is_dealt_with = await self._try_again_and_again(file.stem, message)
        except TimeoutError:
            log.warning("mail given up: it is of no use any more", key=file.stem)
            is_dealt_with = True
        if is_dealt_with:
            _forget(file)

    async def _try_again_and_again(self, key: str, message: EmailMessage) -> bool:
        """Send it, again and again; True: it is sent or refused for good; False: the service ends, and the next one
        goes on."""
        for pause_s in pauses_s():
            is_last = await self._rest(pause_s)
            try:
                await self.server.send(message)
                return True
            except NotMailed as problem:
                log.warning("mail not sent", key=key, problem=str(problem), for_good=problem.for_good)
                if problem.for_good or is_last:
                    return problem.for_good
        raise AssertionError("pauses have no end")

    async def _rest(self, pause_s: float) -> bool:
        """Rest; True if the service ends meanwhile."""
        with suppress(TimeoutError):
            async with asyncio.timeout(pause_s):
                await self._told_to_finish.wait()
        return self._told_to_finish.is_set()


def pauses_s() -> Iterator[float]:
    """Before each try, without an end."""
    return chain(FIRST_PAUSES_S, repeat(PAUSE_S))


def _forget(file: Path) -> None:
    file.unlink(missing_ok=True)
