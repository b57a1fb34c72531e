"""Reads the spool for dispatchers: who was written to and when, and the text without what opens something."""

import re
from datetime import datetime
from email import message_from_bytes, policy
from email.message import EmailMessage
from heapq import nlargest
from pathlib import Path
from typing import Final

from pydantic import BaseModel

from app.core.logs import REDACTED, SECRET_TEXTS

SHOWN: Final = 100
FRAGMENT: Final = re.compile(r"#\S+")
"""Of a link: where the token of a person without an account stands."""


class SpooledMail(BaseModel):
    """The head of a mail."""

    name: str
    to: str
    subject: str
    at: datetime


def newest(folder: Path) -> list[SpooledMail]:
    """The mails written last, but for those that retention takes away meanwhile."""
    files = nlargest(SHOWN, folder.glob("*.eml"), key=_written_ns)
    return [_about(file.name, message) for file in files if (message := _message(file))]


def read(folder: Path, name: str) -> tuple[SpooledMail, str, list[str]] | None:
    """Head, text and names of attachments; None if there is no such mail."""
    message = _message(folder / name)
    if message is None:
        return None
    body = message.get_body(("plain",))
    attached = [part.get_filename() or "attachment" for part in message.iter_attachments()]
    text = body.get_content().replace("\r\n", "\n") if body else ""
    return _about(name, message), redacted(text), attached


def redacted(text: str) -> str:
    """Without codes, and without the part of a link that opens something."""
    return FRAGMENT.sub(f"#{REDACTED}", SECRET_TEXTS.sub(REDACTED, text))


def _message(file: Path) -> EmailMessage | None:
    try:
        return message_from_bytes(file.read_bytes(), policy=policy.default)
    except FileNotFoundError:
        return None


def _written_ns(file: Path) -> int:
    try:
        return file.stat().st_mtime_ns
    except FileNotFoundError:
        return 0


def _about(name: str, message: EmailMessage) -> SpooledMail:
    at: datetime = message["Date"].datetime
    return SpooledMail(name=name, to=str(message["To"]), subject=redacted(str(message["Subject"])), at=at)
