"""From the sender's tap to the mission at the robot, with idle robots there: an order a second, at random moments.

The robots stand in their homes and never drive: there are more of them than orders.
"""

import asyncio
import time
from dataclasses import dataclass
from datetime import UTC, datetime
from random import Random
from typing import Any, Final

from benchmarks.body.report import Wanted, say
from benchmarks.fleet_simulation.honeycomb import Honeycomb
from benchmarks.service.figures import times
from benchmarks.service.filling import Account, Filling, KnownRobot, fill
from benchmarks.service.played_robots import PlayedRobot, at_home, come_home
from benchmarks.service.samples import Punctuality, Samples, until
from benchmarks.service.servers import Server, service
from benchmarks.service.web_client import Visitor
from maps import CampusMap
from protocol.to_server import Event, Progress, Step

ORDERS_PER_S: Final = 1
POSTS: Final = 36
ROBOTS: Final = 20
MOST_ORDERS: Final = 16
"""Fewer than robots: where these are few, orders wait by design."""
VISITORS: Final = 32
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
    """Each round begins with a fresh fleet, since its robots keep what they are given."""
    orders = min(round(samples.seconds * ORDERS_PER_S), MOST_ORDERS)
    rounds = [_round(samples, number, orders) for number in range(samples.rounds)]
    told_s = [told_s for one in rounds for told_s in one.told_s]
    placed = sum(one.placed for one in rounds)
    return {
        "orders": placed,
        "robots": ROBOTS,
        "fleet_planned_for_after_s": round(max(one.known_s for one in rounds), 2),
        "order_to_robot": times(told_s),
        "order_to_answer": times([answered_s for one in rounds for answered_s in one.answered_s]),
        "never_at_a_robot": placed - len(told_s),
        "processor_ms_per_order": round(sum(one.used_s for one in rounds) / placed * 1e3, 2),
        "load_generator_late": times([late_s for one in rounds for late_s in one.late_s]),
        "memory": {name: max(one.memory_mib[name] for one in rounds) for name in rounds[0].memory_mib},
    }


@dataclass(frozen=True)
class Round:
    """One fleet and its orders; times in seconds."""

    known_s: float
    placed: int
    told_s: list[float]
    answered_s: list[float]
    used_s: float
    late_s: list[float]
    memory_mib: dict[str, float]


def _round(samples: Samples, number: int, orders: int) -> Round:
    async def fleet(filling: Filling) -> tuple[list[Account], list[KnownRobot]]:
        return await filling.people(VISITORS + 1), await filling.robots(ROBOTS)

    with samples.folder() as folder:
        ground = Honeycomb(POSTS, POSTS)
        campus = ground.read(folder)
        accounts, robots = fill(folder, fleet)
        with service(folder, MAP=str(ground.write(folder))) as server:
            random = Random(f"{samples.first_seed + number}/instructions")
            return asyncio.run(_measure(server, campus, accounts, robots, random, orders))


async def _measure(
    server: Server, campus: CampusMap, accounts: list[Account], known: list[KnownRobot], random: Random, orders: int
) -> Round:
    mailroom, punctuality = Mailroom(), Punctuality()
    fleet = at_home(known, campus, random, mailroom.heard)
    known_s = await come_home(fleet, server)
    say(f"  all of them planned for after {known_s:.1f} s; {orders} orders at {ORDERS_PER_S}/s")
    watching = asyncio.create_task(punctuality.watch())
    accepting = asyncio.create_task(_accept(mailroom))
    before_s = server.processor_s()
    await _order(server, campus, accounts, mailroom, random, orders)
    await until(lambda: len(mailroom.told_at_s) >= orders, HEARD_WITHIN_S)
    used_s = server.processor_s() - before_s
    watching.cancel()
    accepting.cancel()
    await asyncio.gather(*(robot.close() for robot in fleet))
    told_s = [mailroom.told_at_s[one] - at_s for one, at_s in mailroom.placed_at_s.items() if one in mailroom.told_at_s]
    answered_s, memory_mib = mailroom.answered_after_s, server.memory_mib()
    return Round(known_s, len(mailroom.placed_at_s), told_s, answered_s, used_s, punctuality.late_s, memory_mib)


async def _accept(mailroom: Mailroom) -> None:
    """Robots say that they have accepted, as real ones do."""
    while True:
        while mailroom.given:
            robot, mission_id = mailroom.given.pop()
            accepted = Progress(step=Step.ACCEPTED, happened_at=datetime.now(UTC), mission_id=mission_id)
            await robot.say(Event(happened=accepted))
        await asyncio.sleep(0.005)


async def _order(
    server: Server, campus: CampusMap, accounts: list[Account], mailroom: Mailroom, random: Random, orders: int
) -> None:
    """Orders come when they come, whether or not earlier ones have been answered."""
    visitors: asyncio.Queue[Visitor] = asyncio.Queue()
    for account in accounts[:-1]:
        visitors.put_nowait(Visitor(server.port, account.cookie))
    recipient, posts = accounts[-1].person.email, sorted(campus.posts)
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
