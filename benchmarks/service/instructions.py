"""From the sender's tap to the mission at the robot, with idle robots there: 50 orders a second, at random moments."""

import asyncio
import time
from datetime import UTC, datetime
from random import Random
from typing import Any, Final

from benchmarks.body.report import Wanted, say
from benchmarks.service.figures import times
from benchmarks.service.filling import Account, Filling, KnownRobot, campus, fill
from benchmarks.service.played_robots import PlayedRobot, connect_all
from benchmarks.service.samples import Punctuality, Samples, until
from benchmarks.service.servers import MORE_THAN_A_MAP_CARRIES, Server, service
from benchmarks.service.web_client import Visitor
from protocol.to_server import Event, Progress, Step

ORDERS_PER_S: Final = 50
VISITORS: Final = 32
SPARE_ROBOTS: Final = 100
HEARD_WITHIN_S: Final = 10.0

WANTED = (
    Wanted("order_to_robot.p50_ms", at_most=20, unit="ms"),
    Wanted("order_to_robot.p99_ms", at_most=100, unit="ms"),
    Wanted("never_at_a_robot", at_most=0),
    Wanted("memory.rss_peak_mib", at_most=300, unit="MiB"),
)


class Mailroom:
    """Which order was placed when, and when a robot was told of it."""

    def __init__(self) -> None:
        self.placed_at_s: dict[str, float] = {}
        self.answered_after_s: list[float] = []
        self.told_at_s: dict[str, float] = {}
        self.given: list[tuple[PlayedRobot, str]] = []

    def heard(self, robot: PlayedRobot, at_s: float, envelope: dict[str, Any]) -> None:
        if envelope["type"] == "mission":
            for stop in envelope["body"]["stops"]:
                self.told_at_s.setdefault(stop["order_id"], at_s)
            self.given.append((robot, envelope["body"]["id"]))


def measure(samples: Samples) -> dict[str, Any]:
    orders = round(samples.seconds * ORDERS_PER_S)

    async def fleet(filling: Filling) -> tuple[list[Account], list[KnownRobot]]:
        return await filling.people(VISITORS + 1), await filling.robots(orders + SPARE_ROBOTS)

    with samples.folder() as folder:
        accounts, robots = fill(folder, fleet)
        with service(folder, **MORE_THAN_A_MAP_CARRIES) as server:
            return asyncio.run(_measure(samples, server, accounts, robots, orders))


async def _measure(
    samples: Samples, server: Server, accounts: list[Account], known: list[KnownRobot], orders: int
) -> dict[str, Any]:
    mailroom, random, punctuality = Mailroom(), Random(f"{samples.first_seed}/instructions"), Punctuality()
    posts = sorted(campus().posts)
    fleet = [PlayedRobot(one, random.choice(posts), campus().version, mailroom.heard) for one in known]
    connected_s = await connect_all(fleet, server.link_url)
    say(f"  {len(fleet)} robots connected in {connected_s:.1f} s; {orders} orders at {ORDERS_PER_S}/s")
    watching = asyncio.create_task(punctuality.watch())
    accepting = asyncio.create_task(_accept(mailroom))
    before_s, begun_s = server.processor_s(), time.perf_counter()
    await _order(server, accounts, mailroom, random, orders)
    used = (server.processor_s() - before_s) / (time.perf_counter() - begun_s)
    await until(lambda: len(mailroom.told_at_s) >= orders, HEARD_WITHIN_S)
    used_s = server.processor_s() - before_s
    watching.cancel()
    accepting.cancel()
    await asyncio.gather(*(robot.close() for robot in fleet))
    told_s = [mailroom.told_at_s[one] - at_s for one, at_s in mailroom.placed_at_s.items() if one in mailroom.told_at_s]
    return {
        "orders": orders,
        "robots": len(fleet),
        "fleet_connected_in_s": round(connected_s, 2),
        "order_to_robot": times(told_s),
        "order_to_answer": times(mailroom.answered_after_s),
        "never_at_a_robot": len(mailroom.placed_at_s) - len(told_s),
        "share_of_its_core": round(used, 2),
        "processor_ms_per_order": round(used_s / orders * 1e3, 2),
        "load_generator_late": punctuality.figures(),
        "memory": server.memory_mib(),
    }


async def _accept(mailroom: Mailroom) -> None:
    """Robots say that they have accepted, as real ones do."""
    while True:
        while mailroom.given:
            robot, mission_id = mailroom.given.pop()
            accepted = Progress(step=Step.ACCEPTED, happened_at=datetime.now(UTC), mission_id=mission_id)
            await robot.say(Event(happened=accepted))
        await asyncio.sleep(0.005)


async def _order(server: Server, accounts: list[Account], mailroom: Mailroom, random: Random, orders: int) -> None:
    """Orders come when they come, whether or not earlier ones have been answered."""
    visitors: asyncio.Queue[Visitor] = asyncio.Queue()
    for account in accounts[:-1]:
        visitors.put_nowait(Visitor(server.port, account.cookie))
    recipient, posts = accounts[-1].person.email, sorted(campus().posts)
    due_s = time.perf_counter()
    async with asyncio.TaskGroup() as group:
        for number in range(orders):
            due_s += random.expovariate(ORDERS_PER_S)
            await asyncio.sleep(max(0.0, due_s - time.perf_counter()))
            from_post, to_post = random.sample(posts, 2)
            wish = {"from_post": from_post, "to_post": to_post, "recipient": recipient}
            group.create_task(_place(visitors, mailroom, wish, f"Idempotency-Key: order-{number}\r\n", due_s))
    while not visitors.empty():
        visitors.get_nowait().close()


async def _place(
    visitors: "asyncio.Queue[Visitor]", mailroom: Mailroom, wish: dict[str, str], headers: str, due_s: float
) -> None:
    """Timed from the moment at which it was due: a queue in front of the service is the service's delay."""
    visitor = await visitors.get()
    answer = await visitor.post("/api/v1/orders", wish, headers)
    assert answer.status == 201, answer
    mailroom.answered_after_s.append(time.perf_counter() - due_s)
    mailroom.placed_at_s[answer.json()["id"]] = due_s
    visitors.put_nowait(visitor)
