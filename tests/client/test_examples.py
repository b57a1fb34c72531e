"""The examples run as a stranger would run them: as programs, against the real service."""

import asyncio
import csv
import os
import sys
from asyncio.subprocess import PIPE, Process, create_subprocess_exec
from pathlib import Path

from campus_mail_client import AsyncCampusMail
from tests.client.conftest import RECIPIENT, SENDER, Campus

CHECKOUT = Path(__file__).parents[2]
EXAMPLES = CHECKOUT / "examples" / "client"
TESTED = {"send_a_letter.py", "watch_robots.py", "export_orders.py"}


async def started(campus: Campus, name: str, *arguments: str) -> Process:
    known = {"CAMPUS_MAIL_URL": campus.url, "CAMPUS_MAIL_TOKEN": await campus.token()}
    environment = {**os.environ, **known, "PYTHONPATH": str(CHECKOUT / "client"), "PYTHONUNBUFFERED": "1"}
    program = str(EXAMPLES / name)
    return await create_subprocess_exec(
        sys.executable, program, *arguments, env=environment, stdout=PIPE, stderr=PIPE, cwd=EXAMPLES
    )


async def ended(program: Process) -> str:
    async with asyncio.timeout(30):
        out, complaint = await program.communicate()
    assert program.returncode == 0, complaint.decode()
    return out.decode()


def test_every_example_is_tested() -> None:
    assert {path.name for path in EXAMPLES.glob("*.py")} == TESTED


async def test_a_letter_is_sent_and_followed_to_its_end(campus: Campus, mail: AsyncCampusMail) -> None:
    await campus.enrol()
    program = await started(campus, "send_a_letter.py", "post1", "post4", RECIPIENT)
    assert program.stdout
    order_id = (await program.stdout.readline()).decode().partition(":")[0]
    await program.stdout.readline()  # queued: it follows now
    await campus.move(order_id, "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered")
    told = [line.split()[-1] for line in (await ended(program)).splitlines()]
    assert told[-1] == "delivered"
    assert told == list(dict.fromkeys(told)), "each state once"


async def test_a_letter_that_cannot_be_sent_is_said_so(campus: Campus) -> None:
    program = await started(campus, "send_a_letter.py", "post1", "nowhere", RECIPIENT)
    _, complaint = await program.communicate()
    assert program.returncode == 1
    assert "There is no post 'nowhere'" in complaint.decode()


async def test_robots_are_watched(campus: Campus) -> None:
    await campus.enrol("r1")
    program = await started(campus, "watch_robots.py", "1")
    assert program.stdout
    assert (await program.stdout.readline()).decode().split()[:2] == ["r1", "offline"]
    await campus.announce("r1", online=True)
    assert (await ended(program)).split()[:2] == ["r1", "online"]


async def test_orders_are_exported_as_a_table(campus: Campus, mail: AsyncCampusMail) -> None:
    placed = {(await mail.place("post1", "post4", RECIPIENT)).id for _ in range(3)}
    rows = list(csv.DictReader((await ended(await started(campus, "export_orders.py"))).splitlines()))
    assert {row["id"] for row in rows} == placed
    assert {(row["state"], row["sender"], row["recipient"]) for row in rows} == {("queued", SENDER, RECIPIENT)}
