"""Messages prove that a robot is there: only robots that say nothing are pinged."""

import asyncio
from typing import Any

from websockets.asyncio.client import ClientConnection, connect
from websockets.frames import Frame, Opcode

from app.core.settings import Settings
from protocol.clock import SteppedClock
from protocol.parts import Leg
from protocol.to_server import Clear
from tests.app.robots.playing import PlayedRobot, serving, until

INTERVAL_S = 1.0


class Counting(ClientConnection):
    """Counts the pings that come."""

    pings = 0

    def process_event(self, event: Any) -> None:
        self.pings += isinstance(event, Frame) and event.opcode is Opcode.PING
        super().process_event(event)


async def test_only_a_robot_that_says_nothing_is_pinged(settings: Settings, clock: SteppedClock) -> None:
    async with serving(settings, clock, ping_s=INTERVAL_S) as service:
        robot = PlayedRobot(clock)
        headers = {"Authorization": f"Bearer {await service.enrol('r1')}"}
        async with connect(service.url, additional_headers=headers, proxy=None, create_connection=Counting) as socket:
            assert isinstance(socket, Counting)
            robot.socket = socket
            await robot.greet()
            for _ in range(12):
                await asyncio.sleep(INTERVAL_S / 5)
                await robot.say(Clear(leg=Leg(from_post="post1", to_post="post2")))
            assert socket.pings == 0

            async def is_pinged() -> bool:
                return socket.pings > 0

            await until(is_pinged, 10 * INTERVAL_S)
