"""A fleet of which every robot reports once a second: how long until the service has it on its disk and says so.

Each stands in a home of its own, and says so, as the schedule has it.
"""

import asyncio
import sqlite3
import time
from datetime import UTC, datetime
from pathlib import Path
from random import Random
from typing import Any, Final

from benchmarks.body.report import Wanted, say
from benchmarks.fleet_simulation.honeycomb import Honeycomb
from benchmarks.service.figures import times
from benchmarks.service.filling import Filling, KnownRobot, fill
from benchmarks.service.played_robots import PlayedRobot, at_home, come_home
from benchmarks.service.samples import Punctuality, Samples, until
from benchmarks.service.servers import Server, service
from maps import CampusMap
from protocol.parts import Activity, Position
from protocol.to_server import Snapshot

SNAPSHOT_EVERY: Final = 5
"""Every fifth report comes with a snapshot."""
LAST_ACKNOWLEDGED_WITHIN_S: Final = 10.0

WANTED = (
    Wanted("report_to_durable_acknowledgement.p99_ms", at_most=100, unit="ms"),
    Wanted("not_acknowledged", at_most=0),
    Wanted("acknowledged_and_not_in_the_database", at_most=0),
    Wanted("refused", at_most=0),
    Wanted("disconnected", at_most=0),
    Wanted("memory.rss_peak_mib", at_most=300, unit="MiB"),
)


def measure(samples: Samples) -> dict[str, Any]:
    async def fleet(filling: Filling) -> list[KnownRobot]:
        return await filling.robots(samples.robots)

    with samples.folder() as folder:
        ground = Honeycomb(samples.robots, samples.robots)
        campus = ground.read(folder)
        known = fill(folder, fleet)
        with service(folder, MAP=str(ground.write(folder))) as server:
            return asyncio.run(_measure(samples, server, campus, known, folder / "campus-mail.sqlite"))


async def _measure(
    samples: Samples, server: Server, campus: CampusMap, known: list[KnownRobot], database: Path
) -> dict[str, Any]:
    random, punctuality = Random(f"{samples.first_seed}/robots"), Punctuality()
    fleet = at_home(known, campus, random)
    known_s = await come_home(fleet, server)
    say(f"  all of them planned for after {known_s:.1f} s; each reports once a second")
    said = sum(robot.seq for robot in fleet)
    watching = asyncio.create_task(punctuality.watch())
    before_s, begun_s = server.processor_s(), time.perf_counter()
    await asyncio.gather(*(_report(robot, random, begun_s + samples.seconds) for robot in fleet))
    used = (server.processor_s() - before_s) / (time.perf_counter() - begun_s)
    await until(lambda: all(robot.acknowledged >= robot.seq for robot in fleet), LAST_ACKNOWLEDGED_WITHIN_S)
    watching.cancel()
    used_s = server.processor_s() - before_s
    connected = sum(robot.is_connected for robot in fleet)
    reports = sum(robot.seq for robot in fleet) - said
    figures = {
        "robots": len(fleet),
        "fleet_planned_for_after_s": round(known_s, 2),
        "reports": reports,
        "report_to_durable_acknowledgement": times([s for robot in fleet for s in robot.acknowledged_after_s]),
        "not_acknowledged": sum(robot.seq - robot.acknowledged for robot in fleet),
        "acknowledged_and_not_in_the_database": _missing(database, fleet),
        "refused": sum(len(robot.errors) for robot in fleet),
        "disconnected": len(fleet) - connected,
        "share_of_its_core": round(used, 2),
        "processor_ms_per_report": round(used_s / reports * 1e3, 3),
        "load_generator_late": punctuality.figures(),
        "memory": server.memory_mib(),
    }
    await asyncio.gather(*(robot.close() for robot in fleet))
    return figures


async def _report(robot: PlayedRobot, random: Random, end_s: float) -> None:
    due_s = time.perf_counter() + random.random()
    while due_s < end_s:
        await asyncio.sleep(max(0.0, due_s - time.perf_counter()))
        await robot.say(robot.in_its_bay())
        if robot.seq % SNAPSHOT_EVERY == 0:
            position = Position(post=robot.home, seen_at=datetime.now(UTC))
            await robot.say(Snapshot(position=position, activity=Activity.IDLE, battery=robot.battery))
        due_s += 1.0


def _missing(database: Path, fleet: list[PlayedRobot]) -> int:
    """Every number up to the acknowledged one has to be there, once."""
    with sqlite3.connect(database) as connection:
        counted = "SELECT robot, count(*), max(seq) FROM robot_messages GROUP BY robot"
        kept = {robot: (number, last) for robot, number, last in connection.execute(counted)}
    connection.close()
    return sum(
        max(0, robot.acknowledged - min(kept.get(robot.known.name, (0, 0)))) for robot in fleet if robot.acknowledged
    )
