"""Open pages: how long after a robot has said something new everybody sees it."""

import asyncio
import re
import time
from datetime import UTC, datetime
from functools import partial
from typing import Any, Final

from benchmarks.body.report import Wanted, say
from benchmarks.service.figures import times
from benchmarks.service.filling import Account, Filling, KnownRobot, campus, fill
from benchmarks.service.played_robots import PlayedRobot
from benchmarks.service.samples import Punctuality, Samples, until
from benchmarks.service.servers import Server, service
from benchmarks.service.web_client import Follower, follow
from protocol.parts import Activity, Battery, Position
from protocol.to_server import Snapshot

CHANGES_PER_S: Final = 2
OPENED_AT_ONCE: Final = 20
SEEN_WITHIN_S: Final = 5.0
CHANGE = re.compile(rb'"ratio": ?0\.(\d{6})')
"""Each change is known by its charge, of which no two are the same."""

WANTED = (
    Wanted("change_to_page.p99_ms", at_most=250, unit="ms"),
    Wanted("not_seen", at_most=0),
    Wanted("streams_ended", at_most=0),
    Wanted("memory.rss_peak_mib", at_most=300, unit="MiB"),
)


class Changes:
    """When each change was made, and by how many it was seen after how long."""

    def __init__(self) -> None:
        self.made_at_s: dict[int, float] = {}
        self.seen_after_s: list[float] = []
        self.seen: set[tuple[int, int]] = set()

    def heard(self, follower: int, at_s: float, data: bytes) -> None:
        for found in CHANGE.finditer(data):
            change = int(found[1])
            if change in self.made_at_s and (follower, change) not in self.seen:
                self.seen.add((follower, change))
                self.seen_after_s.append(at_s - self.made_at_s[change])


def measure(samples: Samples) -> dict[str, Any]:
    async def people_and_robot(filling: Filling) -> tuple[list[Account], list[KnownRobot]]:
        return await filling.people(samples.followers), await filling.robots(1)

    with samples.folder() as folder:
        accounts, (robot,) = fill(folder, people_and_robot)
        with service(folder) as server:
            return asyncio.run(_measure(samples, server, accounts, robot))


async def _measure(samples: Samples, server: Server, accounts: list[Account], known: KnownRobot) -> dict[str, Any]:
    changes, punctuality = Changes(), Punctuality()
    robot = PlayedRobot(known, "library", campus().version)
    await robot.connect(server.link_url)
    followers = await _open(server, accounts, changes)
    say(f"  {len(followers)} pages are open")
    watching = asyncio.create_task(punctuality.watch())
    before_s, begun_s = server.processor_s(), time.perf_counter()
    number = round(samples.seconds * CHANGES_PER_S)
    for change in range(1, number + 1):
        await asyncio.sleep(max(0.0, begun_s + change / CHANGES_PER_S - time.perf_counter()))
        await _change(robot, changes, 100_001 + 10 * change)  # six digits, of which the last is no 0
    await until(lambda: len(changes.seen) >= number * len(followers), SEEN_WITHIN_S)
    used = (server.processor_s() - before_s) / (time.perf_counter() - begun_s)
    watching.cancel()
    figures = {
        "followers": len(followers),
        "changes": number,
        "change_to_page": times(changes.seen_after_s),
        "not_seen": number * len(followers) - len(changes.seen),
        "streams_ended": sum(one.ended for one in followers),
        "share_of_its_core": round(used, 2),
        "load_generator_late": punctuality.figures(),
        "memory": server.memory_mib(),
    }
    for one in followers:
        one.close()
    await robot.close()
    return figures


async def _open(server: Server, accounts: list[Account], changes: Changes) -> list[Follower]:
    room = asyncio.Semaphore(OPENED_AT_ONCE)

    async def one(number: int, account: Account) -> Follower:
        async with room:
            return await follow(server.port, account.cookie, partial(changes.heard, number))

    return list(await asyncio.gather(*(one(*numbered) for numbered in enumerate(accounts))))


async def _change(robot: PlayedRobot, changes: Changes, number: int) -> None:
    position = Position(post="library", seen_at=datetime.now(UTC))
    changes.made_at_s[number] = time.perf_counter()
    charge = Battery(ratio=number / 1_000_000)
    await robot.say(Snapshot(position=position, activity=Activity.DRIVING, battery=charge))
