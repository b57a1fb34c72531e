"""One mail to a mail server (RFC 5321), and what its answer means for a second try.

Each mail has a connection of its own, so that what goes wrong with one is no other's concern.
"""

import asyncio
import ssl
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from email.message import EmailMessage
from functools import cached_property
from pathlib import Path
from typing import Final

import aiosmtplib
from pydantic import SecretStr

from app.core.setting_kinds import SmtpTls
from app.core.settings import Settings

QUIT_WITHIN_S: Final = 2.0
REFUSED_FOR_GOOD: Final = range(500, 600)


class NotMailed(Exception):
    """The server has not taken the mail; `for_good` says that it would not the next time either (a 5xx answer)."""

    def __init__(self, sentence: str, *, for_good: bool = False) -> None:
        super().__init__(sentence)
        self.for_good = for_good


@dataclass(frozen=True)
class SmtpServer:
    """A mail server and the way to it. `tls` "none" is for one on this machine."""

    host: str
    port: int
    tls: SmtpTls
    user: str
    password: SecretStr
    ca_file: Path | None
    timeout_s: float

    @classmethod
    def of(cls, settings: Settings) -> "SmtpServer":
        return cls(
            host=settings.smtp_host,
            port=settings.smtp_port_or_usual,
            tls=settings.smtp_tls,
            user=settings.smtp_user,
            password=settings.smtp_password,
            ca_file=settings.smtp_ca_file,
            timeout_s=settings.smtp_timeout_s,
        )

    async def send(self, message: EmailMessage) -> None:
        """Raises NotMailed. Whatever happens after the server has taken the mail is no failure of it."""
        client = self._client()
        try:
            await client.connect()
            await client.send_message(message)
        except (aiosmtplib.SMTPException, OSError) as error:
            raise _not_mailed(error) from error
        finally:
            await _end(client)

    @cached_property
    def _trust(self) -> ssl.SSLContext | None:
        # Kept: reading all authorities takes longer than a mail.
        return None if self.tls == "none" else ssl.create_default_context(cafile=self.ca_file)

    def _client(self) -> aiosmtplib.SMTP:
        return aiosmtplib.SMTP(
            hostname=self.host,
            port=self.port,
            timeout=self.timeout_s,
            use_tls=self.tls == "tls",
            start_tls=self.tls == "starttls",
            tls_context=self._trust,
            username=self.user or None,
            password=self.password.get_secret_value() or None,
        )


async def _end(client: aiosmtplib.SMTP) -> None:
    """Politely, but soon: a server that hangs would hold up the end of the service."""
    with suppress(aiosmtplib.SMTPException, OSError):  # TimeoutError is an OSError
        async with asyncio.timeout(QUIT_WITHIN_S):
            await client.quit()
    client.close()


def _not_mailed(error: Exception) -> NotMailed:
    """Only what was said of sender, recipient or contents is about the mail; the rest is about the server."""
    said = list(_said_of_the_mail(error))
    sentence = "; ".join(f"{one.code} {one.message}" for one in said) or f"{type(error).__name__}: {error}"
    return NotMailed(sentence, for_good=bool(said) and all(one.code in REFUSED_FOR_GOOD for one in said))


def _said_of_the_mail(error: Exception) -> Iterator[aiosmtplib.SMTPResponseException]:
    if isinstance(error, aiosmtplib.SMTPRecipientsRefused):
        yield from error.recipients
    elif isinstance(error, aiosmtplib.SMTPSenderRefused | aiosmtplib.SMTPRecipientRefused | aiosmtplib.SMTPDataError):
        yield error
