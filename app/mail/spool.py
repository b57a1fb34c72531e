"""Mail as files in a folder, until a mail server is configured.

The file's name is the key of the sending: writing it a second time, after a crash say, changes nothing.
"""

import os
from dataclasses import dataclass
from email.policy import SMTP
from pathlib import Path

from app.mail.message import Mail, message_of, name_of


@dataclass(frozen=True)
class Spool:
    """A folder of .eml files, readable by the service's account alone."""

    folder: Path
    sender: str

    def send(self, mail: Mail) -> bool:
        """Write the file whole or not at all; False if this sending was written before."""
        self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        path = self.folder / f"{name_of(mail.key)}.eml"
        if path.exists():
            return False
        unfinished = path.with_suffix(".tmp")
        with os.fdopen(os.open(unfinished, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "wb") as file:
            file.write(message_of(mail, self.sender).as_bytes(policy=SMTP))
            file.flush()
            os.fsync(file.fileno())
        unfinished.replace(path)
        return True
