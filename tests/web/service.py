"""The real service in a process of its own, with a data folder of its own that is dropped afterwards."""

import contextlib
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import AsyncIterator, Mapping
from datetime import datetime
from email import message_from_bytes, policy
from email.message import EmailMessage
from pathlib import Path
from typing import Any

import httpx

from app.core.database.database import Database
from app.core.settings import Settings
from app.robots.service import enrol
from maps import find_map
from protocol.clock import RealClock
from protocol.envelope import YOUNGER
from tests.app.robots.playing import PlayedRobot
from tests.plain_maps import PLAIN_TRACK

ROOT = Path(__file__).parents[2]
START_LIMIT_S = 90.0
"""It has taken 70 on a machine with ten times too much to do, and its tests fail with it. One that ends is not
waited for."""
MAIL_LIMIT_S = 10.0

ALL_BUT_PROOFS = tuple(one for one in YOUNGER if one != "proof")


class Service:
    """Serves on a free port of this machine; `door` makes it a demonstration. Played robots stand on posts."""

    def __init__(
        self,
        folder: Path,
        campus: str = str(PLAIN_TRACK),
        door: Path | None = None,
        more: Mapping[str, str] | None = None,
    ) -> None:
        self._folder, self._campus = folder, campus
        self._port = _free_port()
        self.url = f"http://127.0.0.1:{self._port}"
        self._environment = {
            **os.environ,
            "CAMPUS_MAIL_DATA": str(folder),
            "CAMPUS_MAIL_MAP": campus,
            "CAMPUS_MAIL_PUBLIC_URL": self.url,
            "CAMPUS_MAIL_ALLOWED_DOMAINS": '["campus.example"]',
            **({"CAMPUS_MAIL_DEMO_DOOR": str(door)} if door else {}),
            **(more or {}),
        }

    def __enter__(self) -> "Service":
        with (self._folder / "service.log").open("ab") as log:
            command = [sys.executable, "-m", "app", "serve", "--port", str(self._port)]
            self._process = subprocess.Popen(command, cwd=ROOT, env=self._environment, stdout=log, stderr=log)
        with contextlib.ExitStack() as unless_it_starts:
            unless_it_starts.callback(self._process.wait, 10)
            unless_it_starts.callback(self._process.kill)
            self._wait()
            unless_it_starts.pop_all()
        return self

    def _wait(self) -> None:
        until_s = time.monotonic() + START_LIMIT_S
        with httpx.Client(verify=False) as visitor:  # noqa: S501  # no https
            while not self._is_ready(visitor):
                assert self._process.poll() is None and time.monotonic() < until_s, self.log()
                time.sleep(0.05)

    def __exit__(self, *_: object) -> None:
        self._process.send_signal(signal.SIGTERM)
        self._process.wait(10)

    @property
    def folder(self) -> Path:
        """Its data."""
        return self._folder

    def _is_ready(self, visitor: httpx.Client) -> bool:
        with contextlib.suppress(httpx.HTTPError):
            return visitor.get(f"{self.url}/readyz").is_success
        return False

    def log(self) -> str:
        return (self._folder / "service.log").read_text(errors="replace")[-3000:]

    async def enrol_robot(self, name: str) -> str:
        """The token of a new robot."""
        database = Database(Settings(data=self._folder).url_of_database)
        async with database.transaction() as session:
            token = await enrol(session, RealClock(), name)
        await database.close()
        return token

    @contextlib.asynccontextmanager
    async def connected(self, name: str, **says: Any) -> AsyncIterator[PlayedRobot]:
        """A new robot, at its dock, that knows all but proofs: what it hands over for, few of these tests ask.

        `says`: what else its greeting tells."""
        robot = PlayedRobot(RealClock(), name, journal=f"journal-of-{name}")
        facts = {"map_version": find_map(self._campus).version, "understands": ALL_BUT_PROOFS, **says}
        async with robot.connected(self.link, await self.enrol_robot(name)):
            await robot.greet("post5", **facts)
            yield robot

    @property
    def link(self) -> str:
        """Where robots connect."""
        return self.url.replace("http", "ws") + "/api/v1/robots/link"

    def code_mailed_to(self, email: str) -> str:
        """The sign-in code in that person's newest mail."""
        until_s = time.monotonic() + MAIL_LIMIT_S
        while time.monotonic() < until_s:
            for text in self._mails_to(email):
                if found := re.search(r"\b(\d{8})\b", text):
                    return found.group(1)
            time.sleep(0.05)
        raise AssertionError(f"no code was mailed to {email}")

    def codes_mailed_to(self, email: str, at_least: int) -> list[str]:
        """The sign-in codes that this person was mailed, the newest first; of one second, in any order."""
        until_s, codes = time.monotonic() + MAIL_LIMIT_S, list[str]()
        while len(codes) < at_least and time.monotonic() < until_s:
            time.sleep(0.05)
            codes = [found[1] for text in self._mails_to(email) if (found := re.search(r"\b(\d{8})\b", text))]
        return codes

    def link_mailed_to(self, email: str) -> str:
        """The link to one order in the newest mail to a guest."""
        until_s = time.monotonic() + MAIL_LIMIT_S
        while time.monotonic() < until_s:
            for text in self._mails_to(email):
                if found := re.search(r"https?://\S+/one-order\.html#\S+", text):
                    return found.group(0)
            time.sleep(0.05)
        raise AssertionError(f"no link was mailed to {email}")

    def subjects_mailed_to(self, email: str, at_least: int) -> list[tuple[datetime, str]]:
        """Of all that they were told by mail, with the second that it says it is of; not of what let them in."""
        until_s, subjects = time.monotonic() + MAIL_LIMIT_S, list[tuple[datetime, str]]()
        while len(subjects) < at_least and time.monotonic() < until_s:
            time.sleep(0.05)
            subjects = [(mail["Date"].datetime, str(mail["Subject"])) for mail in self._newest_mails_to(email)]
            subjects = [(at, subject) for at, subject in subjects if "sign-in code" not in subject]
        return subjects

    def newest_mail_to(self, email: str) -> str:
        """Subject and text of it."""
        until_s = time.monotonic() + MAIL_LIMIT_S
        while time.monotonic() < until_s:
            for mail in self._newest_mails_to(email):
                if "sign-in code" not in mail["Subject"]:
                    return f"{mail['Subject']}\n{mail.get_body(('plain',)).get_content()}"
            time.sleep(0.05)
        raise AssertionError(f"nothing was mailed to {email}")

    def _mails_to(self, email: str) -> list[str]:
        return [mail.get_body(("plain",)).get_content() for mail in self._newest_mails_to(email)]

    def _newest_mails_to(self, email: str) -> list[EmailMessage]:
        """As a mail program shows them: by what they say of their time. Several go out at the same time."""
        files = sorted((self._folder / "spool").glob("*.eml"), key=lambda file: file.stat().st_mtime_ns, reverse=True)
        mails = [message_from_bytes(file.read_bytes(), policy=policy.default) for file in files]
        theirs = [mail for mail in mails if mail["To"] == email]
        return sorted(theirs, key=lambda mail: mail["Date"].datetime, reverse=True)


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
