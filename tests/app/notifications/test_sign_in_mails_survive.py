"""A sign-in mail that its server did not take yet is not lost when the service stops, or is killed.

The service is a real process, and so is its stop; the mail server is another, to which it speaks over the wire.
"""

import asyncio
import os
import re
import signal
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.app.conftest import SENDER
from tests.app.notifications.receivers import PASSWORD, USER, MailServer, certificate
from tests.app.notifications.test_killed_while_sending import free_port
from tests.app.service_process import said, serving

FULL = "452 the mailbox is full"
MANY = 20
"""More often than a service tries while a test lasts."""


@dataclass
class Service:
    """Its folder stays from one process to the next."""

    folder: Path
    mail_server: MailServer

    @asynccontextmanager
    async def running(self) -> AsyncIterator[httpx.AsyncClient]:
        """Until the end of the block; then it is told to stop, if it has not been killed."""
        port = free_port()
        mail = {"smtp_host": "127.0.0.1", "smtp_port": self.mail_server.port, "smtp_user": USER}
        mail |= {"smtp_password": PASSWORD, "smtp_ca_file": self.folder / "server.pem"}
        with serving(self.folder / "data", self.log, port=port, **mail) as self.process:
            headers = {"Sec-Fetch-Site": "same-origin"}
            async with httpx.AsyncClient(base_url=f"http://127.0.0.1:{port}", headers=headers) as client:
                await until_up(client)
                yield client
            self.process.send_signal(signal.SIGTERM)
            await asyncio.to_thread(self.process.wait, 60)

    @property
    def log(self) -> Path:
        return self.folder / "log"

    @property
    def left(self) -> int:
        """The number of mails left, as the service's last log line says."""
        return int(said(self.log, "the service stops")[0]["sign_in_mails_left"])

    @property
    def kept(self) -> int:
        """The number of mails in its folder."""
        return len(list((self.folder / "data" / "waiting-mails").glob("*")))


async def until_up(client: httpx.AsyncClient) -> None:
    async with asyncio.timeout(60):
        while True:
            try:
                if (await client.get("/healthz")).status_code == 200:
                    return
            except httpx.TransportError:
                await asyncio.sleep(0.1)


@pytest.fixture
async def service(tmp_path: Path) -> AsyncIterator[Service]:
    _, tls = certificate(tmp_path)
    async with MailServer(tls).listening() as mail_server:
        yield Service(tmp_path, mail_server)


async def ask_for_code(client: httpx.AsyncClient, mail_server: MailServer) -> None:
    """And wait until the mail server has been asked to take it."""
    tries = mail_server.tries
    assert (await client.post("/api/v1/sign-in/codes", json={"email": SENDER})).status_code == 202
    async with asyncio.timeout(20):
        while mail_server.tries == tries:  # noqa: ASYNC110  # it rings no bell
            await asyncio.sleep(0.02)


async def code_in(mail_server: MailServer) -> str:
    async with asyncio.timeout(20):
        while not mail_server.taken:  # noqa: ASYNC110  # it rings no bell
            await asyncio.sleep(0.02)
    found = re.search(r"\b\d{8}\b", mail_server.taken[0].get_content())
    assert found
    return found[0]


async def sign_in(client: httpx.AsyncClient, cookies: Any, code: str) -> int:
    answer = await client.post("/api/v1/sign-in", json={"email": SENDER, "code": code}, headers={"Cookie": cookies})
    return answer.status_code


def cookies_of(client: httpx.AsyncClient) -> str:
    return "; ".join(f"{name}={value}" for name, value in client.cookies.items())


@pytest.mark.parametrize("how", ["stopped", "killed"])
@pytest.mark.nightly
async def test_what_a_full_mailbox_did_not_take_goes_out_after_the_next_start(service: Service, how: str) -> None:
    service.mail_server.says = [FULL] * MANY
    async with service.running() as client:
        await ask_for_code(client, service.mail_server)
        asked_by = cookies_of(client)
        if how == "killed":
            service.process.kill()
    if how == "stopped":
        assert service.left == 1
    assert (service.kept, service.mail_server.taken) == (1, [])
    service.mail_server.says = []
    async with service.running() as client:
        code = await code_in(service.mail_server)
        assert await sign_in(client, asked_by, code) == 200
    assert (service.left, service.kept, len(service.mail_server.taken)) == (0, 0, 1)


@pytest.mark.nightly
async def test_what_waits_for_its_next_try_is_tried_once_more_before_the_end(service: Service) -> None:
    service.mail_server.says = [FULL]
    async with service.running() as client:
        await ask_for_code(client, service.mail_server)
    assert (service.left, service.kept, len(service.mail_server.taken)) == (0, 0, 1)


@pytest.mark.nightly
async def test_a_mail_server_that_hangs_holds_up_no_end_and_loses_nothing(service: Service) -> None:
    service.mail_server.hangs = True
    async with service.running() as client:
        await ask_for_code(client, service.mail_server)
        began_s = asyncio.get_running_loop().time()
    assert asyncio.get_running_loop().time() - began_s < 15
    assert (service.left, service.kept) == (1, 1)


@pytest.mark.nightly
async def test_a_code_that_is_no_good_any_more_is_not_mailed(service: Service) -> None:
    service.mail_server.says = [FULL] * MANY
    async with service.running() as client:
        await ask_for_code(client, service.mail_server)
    (kept,) = (service.folder / "data" / "waiting-mails").iterdir()
    assert kept.stat().st_mode & 0o777 == 0o600
    ago_s = kept.stat().st_mtime - 601
    os.utime(kept, (ago_s, ago_s))
    service.mail_server.says = []
    async with service.running() as client:
        assert (await client.get("/healthz")).status_code == 200
    assert (service.left, service.kept, service.mail_server.taken) == (0, 0, [])
