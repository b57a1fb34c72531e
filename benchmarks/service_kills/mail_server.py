"""A mail server on a real port that remembers what it accepted: before it says so, as a mail server must."""

import asyncio
import re
from collections.abc import Iterator
from contextlib import contextmanager
from email import message_from_bytes, policy
from email.message import EmailMessage
from pathlib import Path
from typing import Any, Final, Protocol

from aiosmtpd.controller import Controller

from benchmarks.service_kills.victim import free_port

THINKS_FOR_S: Final = 0.03
"""As mail servers do, before they take anything: long enough that kills strike while a mail is on its way."""


class Mailbox(Protocol):
    """Where mails end up."""

    def mails(self) -> list[EmailMessage]:
        """Everything that was accepted, as often as it was, in order."""
        ...


class MailServer:
    """aiosmtpd's handler."""

    def __init__(self) -> None:
        self.accepted: list[EmailMessage] = []
        self.port = 0

    def mails(self) -> list[EmailMessage]:
        return list(self.accepted)

    async def handle_RCPT(  # noqa: N802  # aiosmtpd's name
        self, server: Any, session: Any, envelope: Any, address: str, options: list[str]
    ) -> str:
        await asyncio.sleep(THINKS_FOR_S)
        envelope.rcpt_tos.append(address)
        return "250 go on"

    async def handle_DATA(self, server: Any, session: Any, envelope: Any) -> str:  # noqa: N802  # aiosmtpd's name
        self.accepted.append(message_from_bytes(envelope.content, policy=policy.default))
        return "250 taken"


@contextmanager
def mail_server() -> Iterator[MailServer]:
    handler = MailServer()
    handler.port = free_port()
    controller = Controller(handler, hostname="127.0.0.1", port=handler.port)
    controller.start()
    try:
        yield handler
    finally:
        controller.stop()


class SpoolFolder:
    """Without a mail server: files, in which a second sending of the same mail is the same file."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def mails(self) -> list[EmailMessage]:
        files = sorted(self._folder.glob("*.eml"), key=lambda file: file.stat().st_mtime_ns)
        return [message_from_bytes(file.read_bytes(), policy=policy.default) for file in files]


def newest_code(mailbox: Mailbox, email: str) -> str | None:
    """The sign-in code that was mailed last to this address."""
    theirs = [mail for mail in mailbox.mails() if mail["To"] == email and is_sign_in(mail)]
    found = re.search(r"\b\d{8}\b", theirs[-1].get_content()) if theirs else None
    return found[0] if found else None


def is_sign_in(mail: EmailMessage) -> bool:
    return str(mail["Message-ID"]).startswith("<sign-in")
