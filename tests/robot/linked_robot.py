"""The daemon's parts at the robot's end of the link. The other end: benchmarks/body/played_server.py."""

import asyncio
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field

from protocol.clock import RealClock
from protocol.parts import Activity, Battery, Leg, Position, Stop, StopAction
from protocol.to_robot import Mission
from protocol.to_server import Clear, Hello, Snapshot
from robot.link.connection import Rhythm
from robot.link.link import Link
from robot.mission.memory import Memory
from robot.mission.outbox import Outbox
from robot.mission.store import Store

QUICK = Rhythm(ping_limit_s=20.0, retry_longest_s=0.2, snapshot_every_s=0.3)
IMPATIENT = Rhythm(ping_every_s=0.3, ping_limit_s=0.5, retry_longest_s=0.2)
MISSION = Mission(id="m1", update=1, stops=(Stop(id="s1", post="post1", action=StopAction.LOAD, order_id="o1"),))


@dataclass
class Robot:
    """The daemon's parts at the robot's end of the link."""

    store: Store
    outbox: Outbox
    memory: Memory
    stops: list[float] = field(default_factory=list)
    """When the link stopped the robot at once."""

    @asynccontextmanager
    async def linked(self, url: str, rhythm: Rhythm = QUICK) -> AsyncIterator[Link]:
        link = Link(
            url=url,
            token="cmr_a_b",
            robot="r1",
            clock=RealClock(),
            outbox=self.outbox,
            memory=self.memory,
            hello_source=lambda: Hello(
                position=self.memory.position(),
                cargo=self.memory.cargo(),
                mission=self.memory.mission_held(),
                battery=Battery(ratio=0.8),
                software="0.1.0",
                map_version="m1",
            ),
            rhythm=rhythm,
            stop_at_once=lambda: self.stops.append(time.monotonic()),
        )
        link.start()
        try:
            yield link
        finally:
            await asyncio.to_thread(link.stop)


async def until(what: Callable[[], object], limit_s: float = 5.0) -> None:
    end_s = time.monotonic() + limit_s
    while not what():
        assert time.monotonic() < end_s, "waited in vain"
        await asyncio.sleep(0.01)


def cleared(post: str = "post2") -> Clear:
    return Clear(leg=Leg(from_post="post1", to_post=post))


def a_snapshot(post: str) -> Snapshot:
    return Snapshot(position=Position(post=post), activity=Activity.DRIVING, battery=Battery(ratio=0.7))
