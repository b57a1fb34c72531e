"""Mail as RFC 5322 files in a spool folder, until a mail server is configured (thin: SMTP is a later issue).

The file's name is the key of the sending: writing it a second time, after a crash say, changes nothing.
"""

import os
import re
from dataclasses import dataclass
from datetime import datetime
from email.message import EmailMessage
from email.policy import SMTP
from email.utils import format_datetime
from pathlib import Path


@dataclass(frozen=True)
class Mail:
    """One message to one person. `key` names the sending; `png` is a picture to attach, as (file name, bytes)."""

    key: str
    to: str
    subject: str
    body: str
    at: datetime
    png: tuple[str, bytes] | None = None


@dataclass(frozen=True)
class Spool:
    """A folder of .eml files, readable by the service's account alone."""

    folder: Path
    sender: str

    def send(self, mail: Mail) -> bool:
        """Write the file whole or not at all; False if this sending was written before."""
        self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        path = self.folder / f"{_file_name(mail.key)}.eml"
        if path.exists():
            return False
        unfinished = path.with_suffix(".tmp")
        with os.fdopen(os.open(unfinished, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "wb") as file:
            file.write(self._message(mail).as_bytes(policy=SMTP))
            file.flush()
            os.fsync(file.fileno())
        unfinished.replace(path)
        return True

    def _message(self, mail: Mail) -> EmailMessage:
        message = EmailMessage()
        message["From"] = self.sender
        message["To"] = mail.to
        message["Subject"] = mail.subject
        message["Date"] = format_datetime(mail.at)
        message["Message-ID"] = f"<{_file_name(mail.key)}@{self.sender.rpartition('@')[2]}>"
        message["Auto-Submitted"] = "auto-generated"
        message.set_content(mail.body)
        if mail.png:
            name, picture = mail.png
            message.add_attachment(picture, maintype="image", subtype="png", filename=name)
        return message


def _file_name(key: str) -> str:
    return re.sub(r"[^A-Za-z0-9._-]", "_", key)
