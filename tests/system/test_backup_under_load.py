"""A backup of the real service while people order and robots carry: it restores to a database that is sound."""

import asyncio
import json
import os
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path
from random import Random
from typing import Any

import httpx
import pytest

from app.cli.administration import enrol
from app.core.settings import Settings
from benchmarks.service_kills.mail_server import SpoolFolder
from benchmarks.service_kills.people import Everybody, Person
from benchmarks.service_kills.senders import Sender
from benchmarks.service_kills.stand_in import StandIn
from benchmarks.service_kills.victim import CHECKOUT, Victim
from maps import read_map
from maps.ways import Ways

pytestmark = pytest.mark.system
SENDERS = 4
BOB = "bob@campus.example"


async def command(*words: str, data: Path) -> Any:
    """The JSON of a command, typed in a process of its own beside the service."""
    environment = {**os.environ, "CAMPUS_MAIL_DATA": str(data)}
    ran = await asyncio.to_thread(
        subprocess.run,
        [sys.executable, "-m", "app", *words, "--json"],
        cwd=CHECKOUT, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stderr
    return json.loads(ran.stdout)


@pytest.mark.nightly
async def test_a_backup_under_load_restores_to_a_sound_database_that_a_service_starts_on(tmp_path: Path) -> None:
    victim = Victim(tmp_path)
    data, over, before = tmp_path / "data", asyncio.Event(), set[str]()
    token = await enrol(Settings(data=data), "r1", again=False)
    spool, browsers = SpoolFolder(data / "spool"), [httpx.AsyncClient() for _ in range(SENDERS + 1)]
    senders = [
        Sender(victim.url, f"sender{n}@campus.example", Random(n), browsers[n], recipients=(BOB,), pause_s=0.01)
        for n in range(SENDERS)
    ]
    bob = Person(victim.url, BOB, Random(SENDERS), browsers[-1])
    ways, show = Ways(read_map(victim.map_file)), Everybody(senders, [bob]).show
    robot = StandIn("r1", token, victim.link_url, "post5", ways, Random(1), show)

    async def send(sender: Sender) -> None:
        await sender.sign_in(spool)
        await sender.order_until(over.is_set)

    try:
        victim.start()
        await victim.is_up()
        await bob.sign_in(spool)
        driving = asyncio.create_task(robot.run())
        async with asyncio.TaskGroup() as group:
            for sender in senders:
                group.create_task(send(sender))
            while not all(sender.acknowledged for sender in senders):  # noqa: ASYNC110  # people ring no bell
                await asyncio.sleep(0.05)
            before = {order for sender in senders for order in sender.acknowledged.values()}
            manifest = await command("backup", str(tmp_path / "mail.tar.gz"), data=data)
            over.set()
        driving.cancel()
        assert await victim.stop() in (0, -15)
    finally:
        victim.end()
        await asyncio.gather(*(browser.aclose() for browser in browsers))
    everything = {order for sender in senders for order in sender.acknowledged.values()}
    assert len(everything) > len(before), "no order was placed while the backup was taken"

    again = Victim(tmp_path / "again")
    restored = again.folder / "data"
    assert (await command("restore", str(tmp_path / "mail.tar.gz"), data=restored))["rows"] == manifest["rows"]
    with closing(sqlite3.connect(restored / "campus-mail.sqlite")) as plain:
        kept = {order for (order,) in plain.execute("SELECT id FROM orders")}
        assert plain.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
        assert plain.execute("PRAGMA foreign_key_check").fetchall() == []
    assert before <= kept, "what was acknowledged before the backup is in it"
    assert len(kept) == manifest["rows"]["orders"]
    try:
        again.start()
        await again.is_up()
        async with httpx.AsyncClient() as http:
            assert (await http.get(f"{again.url}/readyz")).json() == {"status": "ready"}
    finally:
        again.end()
