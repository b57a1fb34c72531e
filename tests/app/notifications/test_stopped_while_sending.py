"""A service that is told to stop sends what is due now before it ends, and does not wait for ever to do so.

The service is a real process that gets SIGTERM; a receiver of its webhook is slow, or does not answer at all.
"""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest

from app.cli.serving import GRACEFUL_S
from app.composition.background import STOP_WITHIN_S
from app.core.settings import ROOT
from app.notifications.delivery.worker import FINISH_WITHIN_S
from tests.app.notifications.receivers import receiving
from tests.app.notifications.test_killed_while_sending import ORDERS, ask, free_port, orders, sign_in, unsent

SLOW_S = 0.5


@contextmanager
def serving(data: Path, port: int, webhook: str, log: Path) -> Iterator["subprocess.Popen[bytes]"]:
    known = {"DATA": str(data), "PORT": str(port), "WEBHOOK_URL": webhook, "WEBHOOK_SECRET": "s" * 32}
    environment = {**os.environ, **{f"CAMPUS_MAIL_{name}": value for name, value in known.items()}}
    command = [sys.executable, "-m", "app", "serve"]
    with log.open("wb") as file, subprocess.Popen(command, cwd=ROOT, env=environment, stderr=file) as process:
        try:
            yield process
        finally:
            process.kill()


def stop(process: "subprocess.Popen[bytes]") -> float:
    """Stop the service and return the seconds it took."""
    begun_s = time.monotonic()
    process.send_signal(signal.SIGTERM)
    assert process.wait(60) in (0, -signal.SIGTERM)
    return time.monotonic() - begun_s


def left(log: Path) -> int:
    """Return the number of notices left, as the service's last log line says."""
    lines = [json.loads(line) for line in log.read_text().splitlines() if line.startswith("{")]
    (count,) = [line["notices_left"] for line in lines if line["event"] == "the service stops"]
    return int(count)


@pytest.mark.nightly
def test_what_is_due_goes_out_before_the_end_and_what_hangs_is_left_for_the_next_start(tmp_path: Path) -> None:
    data, port, log = tmp_path / "data", free_port(), tmp_path / "log"
    with receiving() as receiver, httpx.Client(base_url=f"http://127.0.0.1:{port}/api/v1", timeout=20) as client:
        client.headers["Sec-Fetch-Site"] = "same-origin"
        receiver.hangs = threading.Event()
        with serving(data, port, receiver.url, log) as process:
            sign_in(client, data / "spool")
            assert orders(client) == ORDERS
            took_s = stop(process)
        assert took_s < GRACEFUL_S + FINISH_WITHIN_S + 2 * STOP_WITHIN_S
        assert left(log) == unsent(data) == ORDERS, "its one receiver hangs, and holds up the others behind it"
        assert len(list((data / "spool").glob("mail.*.eml"))) == ORDERS, "what another channel carries is out"
        receiver.hangs.set()
        receiver.received.clear()
        receiver.hangs = threading.Event()
        with serving(data, port, receiver.url, log) as process:
            while not ask(client, "GET", "/me"):
                time.sleep(0.05)
            threading.Timer(SLOW_S, receiver.hangs.set).start()
            assert stop(process) >= SLOW_S, "it was told to stop in the middle of it"
        assert left(log) == unsent(data) == 0
    assert Counter(Counter(one.headers["webhook-id"] for one in receiver.received).values()) == {1: ORDERS}
