"""Robots that do nothing but drive on the track that they share, and where each of them is."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from itertools import pairwise

from maps import corridor_name, shortest_route
from protocol.clock import SteppedClock
from protocol.envelope import TO_ROBOT, parse
from protocol.parts import Leg, Received
from protocol.to_robot import Detour, Grant
from protocol.to_server import Claim, Clear
from tests.app.robots.playing import PlayedRobot, Service
from tests.plain_maps import plain_map

TRACK = plain_map("test_track")
UNDERSTANDS = ("confirm", "watch", "open_way", "detour")


@dataclass
class Track:
    """The robots' places, as a person beside the line would see them."""

    inside: dict[str, str] = field(default_factory=dict)
    at: dict[str, str] = field(default_factory=dict)
    asides: list[str] = field(default_factory=list)

    def enter(self, robot: str, leg: Leg) -> None:
        corridor = corridor_name(leg.from_post, leg.to_post)
        assert corridor not in self.inside.values(), f"{robot} meets another in {corridor}"
        self.inside[robot], self.at[robot] = corridor, leg.to_post

    def leave(self, robot: str) -> None:
        del self.inside[robot]
        there = [one for one, post in self.at.items() if post == self.at[robot] and one not in self.inside]
        assert self.at[robot] == "post5" or there == [robot], f"two robots in one bay: {there}"


@dataclass
class Traveller:
    """A robot that does nothing but go where it is told."""

    robot: PlayedRobot
    track: Track
    claims: int = 0
    ahead: list[Leg] = field(default_factory=list)

    @property
    def post(self) -> str:
        return self.track.at[self.robot.name]

    @asynccontextmanager
    async def greeted(self, service: Service, understands: tuple[str, ...] = UNDERSTANDS) -> AsyncIterator[None]:
        self.robot.token = self.robot.token or await service.enrol(self.robot.name)
        async with self.robot.connected(service.url, self.robot.token):
            # The track has one dock. A robot that tells no home is planned for as if it were at home there, too.
            home = "post5" if self.robot.name == "r1" else None
            await self.robot.greet(self.post, home=home, understands=understands)
            yield

    async def go_to(self, goal: str) -> None:
        while self.post != goal:
            if not self.ahead:
                await self.claim(goal)
            await self.drive(self.ahead.pop(0) if self.ahead else await self.answer())

    async def claim(self, goal: str) -> None:
        self.claims += 1
        posts = (*shortest_route(TRACK, self.post, goal).posts, *shortest_route(TRACK, goal, "post5").posts[1:])
        legs = tuple(Leg(from_post=a, to_post=b) for a, b in pairwise(posts))
        await self.robot.say(Claim(claim_id=f"c{self.claims}", legs=legs, goal=goal))

    async def answer(self) -> Leg:
        robot = self.robot
        assert robot.socket is not None
        async with asyncio.timeout(30):
            while True:
                envelope = parse(await robot.socket.recv(), TO_ROBOT)
                if envelope.seq is not None:
                    robot.received = Received(journal=envelope.journal, seq=envelope.seq)
                if isinstance(envelope.body, Detour):
                    self.track.asides.append(f"{robot.name} {envelope.body.legs[0].to_post}")
                if isinstance(envelope.body, Grant | Detour):
                    assert envelope.body.legs[0].from_post == self.post
                    first, *self.ahead = envelope.body.legs
                    return first

    async def drive(self, leg: Leg) -> None:
        self.track.enter(self.robot.name, leg)
        await asyncio.sleep(0.05)
        await self.leave(leg)

    async def leave(self, leg: Leg) -> None:
        self.track.leave(self.robot.name)
        await self.robot.say(Clear(leg=leg, post=leg.to_post))


def on_one_track(clock: SteppedClock, **at: str) -> list[Traveller]:
    """Each at a post; their docks are at post5."""
    track = Track(at=at)
    return [Traveller(PlayedRobot(clock, name), track) for name in at]
