"""A mail, and how it is written as RFC 5322 has it."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from email.message import EmailMessage
from email.utils import format_datetime

from app.core.mail.headers import MAIL


@dataclass(frozen=True)
class Mail:
    """One message to one person. `key` names the sending; `png` is a picture to attach, as (file name, bytes)."""

    key: str
    to: str
    subject: str
    body: str
    at: datetime
    png: tuple[str, bytes] | None = None
    headers: Mapping[str, str] = field(default_factory=dict)


def message_of(mail: Mail, sender: str) -> EmailMessage:
    """The same mail gives the same message: nothing in it is of the moment of sending."""
    message = EmailMessage(policy=MAIL)
    message["From"] = sender
    message["To"] = mail.to
    message["Subject"] = _words(mail.subject)
    message["Date"] = format_datetime(mail.at)
    message["Message-ID"] = f"<{name_of(mail.key)}@{sender.rpartition('@')[2].strip('<> ')}>"
    message["Auto-Submitted"] = "auto-generated"
    for name, value in mail.headers.items():
        message[name] = value
    message.set_content(mail.body)
    if mail.png:
        name, picture = mail.png
        message.add_attachment(picture, maintype="image", subtype="png", filename=name)
    return message


def _words(subject: str) -> str:
    """The subject without what would become a line of its own, another header: names of people stand in it.

    `=?` begins letters in disguise (RFC 2047): the library would read them, line breaks among them, and write them out.
    """
    return " ".join(subject.split()).replace("=?", "= ?")


def name_of(key: str) -> str:
    """A key as it may stand in a Message-ID and in a file's name."""
    return re.sub(r"[^A-Za-z0-9._-]", "_", key)
