"""A crash between sending and noting it down, as it happens: the process is killed while the other side has it.

The service is a real process. The receiver of its webhook kills it in the moment in which it has read a delivery and
not answered yet. After the restart everything is told, and what came twice came under the same id.
"""

import json
import os
import re
import socket
import sqlite3
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from email import message_from_bytes, policy
from pathlib import Path
from typing import Any

import httpx
import pytest

from app.core.settings import ROOT
from tests.app.conftest import RECIPIENT, SENDER
from tests.app.notifications.receivers import Received, Receiver, receiving

KILLS = 2
ORDERS = 3
LIMIT_S = 60.0


@contextmanager
def served(data: Path, port: int, webhook: str) -> Iterator["subprocess.Popen[bytes]"]:
    known = {"DATA": str(data), "PORT": str(port), "WEBHOOK_URL": webhook, "WEBHOOK_SECRET": "s" * 32}
    environment = {**os.environ, **{f"CAMPUS_MAIL_{name}": value for name, value in known.items()}}
    command = [sys.executable, "-m", "app", "serve"]
    with subprocess.Popen(command, cwd=ROOT, env=environment, stderr=subprocess.DEVNULL) as process:
        yield process
        process.kill()


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port: int = taken.getsockname()[1]
        return port


def ask(client: httpx.Client, method: str, path: str, **wish: Any) -> httpx.Response | None:
    """None if the service does not answer: not up yet, or killed meanwhile."""
    try:
        return client.request(method, path, **wish)
    except httpx.TransportError:
        return None


def sign_in(client: httpx.Client, spool: Path) -> None:
    until_s = time.monotonic() + LIMIT_S
    while not ask(client, "POST", "/sign-in/codes", json={"email": SENDER}):
        assert time.monotonic() < until_s
        time.sleep(0.1)
    mail = message_from_bytes(next(spool.glob("sign-in*.eml")).read_bytes(), policy=policy.default)
    code = re.search(r"\b\d{8}\b", mail.get_content())
    assert code
    assert client.post("/sign-in", json={"email": SENDER, "code": code[0]}).status_code == 200


def orders(client: httpx.Client) -> int:
    """Place what has not been placed, each under its own key; how many are."""
    wish = {"from_post": "post1", "to_post": "post4", "recipient": RECIPIENT}
    keys = [{"Idempotency-Key": f"order-{number}"} for number in range(ORDERS)]
    answers = [ask(client, "POST", "/orders", json=wish, headers=key) for key in keys]
    return sum(answer is not None and answer.status_code == 201 for answer in answers)


def unsent(data: Path) -> int:
    with sqlite3.connect(data / "campus-mail.sqlite") as database:
        waiting = "select count(*) from outbox where sent_at is null"
        new = "select count(*) from notices where routed_at is null"
        count = sum(int(database.execute(question).fetchone()[0]) for question in (waiting, new))
    database.close()
    return count


def killer(process: "subprocess.Popen[bytes]", receiver: Receiver) -> None:
    def kill(one: Received) -> None:
        process.kill()
        process.wait()

    receiver.then = kill


@pytest.mark.nightly
def test_what_was_sent_and_not_noted_down_comes_again_under_the_same_id_and_nothing_is_lost(tmp_path: Path) -> None:
    data, port = tmp_path / "data", free_port()
    with receiving() as receiver, httpx.Client(base_url=f"http://127.0.0.1:{port}/api/v1", timeout=20) as client:
        client.headers["Sec-Fetch-Site"] = "same-origin"
        for run in range(KILLS):
            with served(data, port, receiver.url) as process:
                if run == 0:
                    sign_in(client, data / "spool")
                killer(process, receiver)
                while process.poll() is None:
                    orders(client)
                    time.sleep(0.05)
        receiver.then = lambda one: None
        with served(data, port, receiver.url):
            until_s = time.monotonic() + LIMIT_S
            while orders(client) < ORDERS or unsent(data):
                assert time.monotonic() < until_s
                time.sleep(0.2)
        deliveries = Counter(one.headers["webhook-id"] for one in receiver.received)
        told = {json.loads(one.body)["data"]["key"] for one in receiver.received}
        mails = [file.name for file in (data / "spool").glob("mail.*.eml")]
    assert len(told) == len(deliveries) == ORDERS
    assert sum(deliveries.values()) <= ORDERS + KILLS * ORDERS
    assert max(deliveries.values()) >= 2, "one at least was killed while it was told"
    assert len(mails) == ORDERS
