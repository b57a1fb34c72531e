"""A robot that was without network for half an hour comes back: when is the page right, when is the backlog in?

The robot's side is the real one: its outbox on disk and its link, in the load generator's process.
"""

import asyncio
import sqlite3
import time
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, Final

from benchmarks.body.report import Wanted, say
from benchmarks.service.figures import middle
from benchmarks.service.filling import Account, Filling, KnownRobot, campus, fill
from benchmarks.service.samples import Samples
from benchmarks.service.servers import Server, service
from benchmarks.service.web_client import follow
from protocol.clock import RealClock
from protocol.parts import Activity, Battery, Leg, Part, Position
from protocol.to_server import Charge, Claim, Clear, Event, Hello, Progress, Snapshot, Step
from robot.link.link import Link
from robot.mission.memory import Memory
from robot.mission.outbox import Outbox
from robot.mission.store import Store

OFFLINE_S: Final = 1800.0
LIMIT_S: Final = 60.0
TIMES: Final = 3
SEEN: Final = b'"ratio":0.4242'

WANTED = (
    Wanted("page_right_after_s", at_most=0.5, unit="s"),
    Wanted("backlog_in_after_s", at_most=5, unit="s"),
    Wanted("not_in_the_database", at_most=0),
)


def measure(samples: Samples) -> dict[str, Any]:
    runs = []
    for number in range(TIMES):
        with samples.folder() as folder:

            async def one_robot(filling: Filling) -> tuple[Account, KnownRobot]:
                (account,) = await filling.people(1)
                (robot,) = await filling.give_missions(await filling.robots(1), account)
                return account, robot

            data = folder / "service"
            account, known = fill(data, one_robot, samples.first_seed + number)
            with service(data) as server, Store(folder / "robot.sqlite") as store:
                runs.append(asyncio.run(_come_back(samples, server, account, known, store, data)))
        say(f"  page right after {runs[-1]['page_s']:.2f} s, backlog in after {runs[-1]['backlog_s']:.2f} s")
    return {
        "waiting": samples.backlog,
        "page_right_after_s": max(run["page_s"] for run in runs),
        "backlog_in_after_s": max(run["backlog_s"] for run in runs),
        "backlog_in_after_median_s": middle([run["backlog_s"] for run in runs]),
        "not_in_the_database": sum(run["missing"] for run in runs),
    }


async def _come_back(
    samples: Samples, server: Server, account: Account, known: KnownRobot, store: Store, data: Path
) -> dict[str, Any]:
    outbox, memory = Outbox(store), Memory(store)
    with store.transaction():
        for message in backlog(known, samples.backlog):
            outbox.put(message)
    seen_at_s: list[float] = []

    def heard(at_s: float, piece: bytes) -> None:
        if SEEN in piece.replace(b" ", b""):
            seen_at_s.append(at_s)

    follower = await follow(server.port, account.cookie, heard)
    link = _link(server, known, outbox, memory)
    begun_s = time.perf_counter()
    link.start()
    while (outbox.waiting() or not seen_at_s) and time.perf_counter() - begun_s < LIMIT_S:
        link.incoming()
        await asyncio.sleep(0.01)
    backlog_s = time.perf_counter() - begun_s
    await asyncio.to_thread(link.stop)
    follower.close()
    page_s = seen_at_s[0] - begun_s if seen_at_s else LIMIT_S
    return {"page_s": round(page_s, 3), "backlog_s": round(backlog_s, 3), "missing": _missing(data, samples.backlog)}


def _link(server: Server, known: KnownRobot, outbox: Outbox, memory: Memory) -> Link:
    position, charge = Position(post="library", seen_at=datetime.now(UTC)), Battery(ratio=0.4242)
    before = Position(post="loeb")

    def hello() -> Hello:
        facts = {"software": "benchmark", "map_version": campus().version}
        return Hello(position=before, battery=Battery(ratio=0.5), **facts)

    link = Link(
        url=server.link_url,
        token=known.token,
        robot=known.name,
        clock=RealClock(),
        outbox=outbox,
        memory=memory,
        hello_source=hello,
    )
    link.snapshot(Snapshot(position=position, activity=Activity.DRIVING, battery=charge))
    return link


def backlog(known: KnownRobot, number: int) -> Iterator[Part]:
    """Yield what a robot that goes to and fro has to tell: it claims and clears corridors, passes posts, charges."""
    assert known.mission_id is not None
    leg = Leg(from_post="junction", to_post="library")
    begun_at = datetime.now(UTC) - timedelta(seconds=OFFLINE_S)
    for count in range(number):
        at = begun_at + timedelta(seconds=OFFLINE_S * count / number)
        passed = Progress(step=Step.PASSED, happened_at=at, mission_id=known.mission_id, post="library")
        messages: tuple[Part, ...] = (
            Claim(claim_id=f"c{count}", legs=(leg,)),
            Event(happened=passed),
            Clear(leg=leg),
            Event(happened=Charge(step="low", happened_at=at, ratio=0.4)),
        )
        yield messages[count % len(messages)]


def _missing(data: Path, number: int) -> int:
    with sqlite3.connect(data / "campus-mail.sqlite") as connection:
        (kept,) = connection.execute("SELECT count(*) FROM robot_messages").fetchone()
    connection.close()
    return number - int(kept)
