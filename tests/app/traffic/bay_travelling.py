"""Robots that do nothing but drive on a map with bays, and the floor on which they must not meet."""

import asyncio
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Final

from maps import CampusMap, corridor_name, find_map, shortest_route
from protocol.envelope import TO_ROBOT, parse
from protocol.parts import Leg, Received
from protocol.to_robot import Deny, Detour, Grant
from protocol.to_server import Claim, Clear, Evidence, Occupancy, Where
from tests.app.robots.playing import PlayedRobot, Service

MAP: Final = Path(__file__).parents[2] / "bays.toml"
TRACK: Final[CampusMap] = find_map(MAP).track
UNDERSTANDS: Final = ("confirm", "watch", "open_way", "detour", "revoke", "home", "until_ratio")
ANSWER_WITHIN_S: Final = 60.0


class Collision(AssertionError):
    """Two bodies in one place."""


@dataclass
class Floor:
    """What each body is in, as a person beside the line would see it: a bay, a crossing, a corridor; on the way from
    one to the next both."""

    taken: dict[str, str] = field(default_factory=dict)
    """Place or corridor → robot."""
    asides: int = 0

    def enter(self, robot: str, place: str) -> None:
        other = self.taken.setdefault(place, robot)
        if other != robot:
            raise Collision(f"{robot} meets {other} in {place}")

    def leave(self, robot: str, place: str) -> None:
        if self.taken.get(place) == robot:
            del self.taken[place]


@dataclass
class BayTraveller:
    """It knows the map, where it stands and what it was granted."""

    robot: PlayedRobot
    floor: Floor
    place: str
    """Its bay; the post before which it waits, while it is in a corridor."""
    came_from: str | None = None
    """The other end of the corridor that it is in."""
    home: str = ""
    granted: list[Leg] = field(default_factory=list)
    claims: int = 0
    silent: bool = False
    """It drives, and its reports wait."""
    unsaid: list[Occupancy | Clear] = field(default_factory=list)

    @asynccontextmanager
    async def greeted(self, service: Service) -> AsyncIterator[None]:
        self.robot.token = self.robot.token or await service.enrol(self.robot.name)
        async with self.robot.connected(service.url, self.robot.token):
            self.home = (await self.robot.greet(self.place, understands=UNDERSTANDS, home=self.place)).home or ""
            self.floor.enter(self.robot.name, self.place)
            await self.report("bay", self.place)
            yield

    async def report(self, where: Where, post: str, towards: str | None = None) -> None:
        evidence: Evidence = "distance" if where == "corridor" else "marker"
        now = self.robot.clock.utc()
        await self.say(Occupancy(where=where, post=post, towards=towards, evidence=evidence, happened_at=now))

    async def say(self, message: Occupancy | Clear) -> None:
        if self.silent:
            self.unsaid.append(message)
        else:
            await self.robot.say(message)

    async def speak_up(self) -> None:
        self.silent = False
        for message in self.unsaid:
            await self.robot.say(message)
        self.unsaid.clear()

    async def go_to(self, goal: str) -> None:
        """Until it stands in a bay of that post, or in that bay."""
        while self.came_from is not None or goal not in (self.place, TRACK.post(self.place).bay_of):
            if not self._way_on():
                await self._ask(goal)
            await self._drive()

    def _way_on(self) -> list[Leg]:
        """The legs to its next stop that it holds: out of a bay at least two."""
        legs: list[Leg] = []
        at = self.place
        while leg := next((one for one in self.granted if one.from_post == at and one not in legs), None):
            legs.append(leg)
            at = leg.to_post
            if TRACK.post(at).bay_of or len(legs) == (2 if self.came_from is None else 1):
                return legs
        return []

    async def _ask(self, goal: str) -> None:
        self.claims += 1
        bays = [bay.name for bay in TRACK.bays_of(goal)] or [goal]
        to = self.home if self.home in bays else bays[0]
        posts = shortest_route(TRACK, self.place, to).posts
        legs = tuple(Leg(from_post=a, to_post=b) for a, b in pairwise(posts))
        await self.robot.say(Claim(claim_id=f"{self.robot.name}-{self.claims}", legs=legs, goal=goal))
        while not self._way_on():
            await self._hear()

    async def _hear(self) -> None:
        robot = self.robot
        assert robot.socket is not None
        async with asyncio.timeout(ANSWER_WITHIN_S):
            envelope = parse(await robot.socket.recv(), TO_ROBOT)
        if envelope.seq is not None:
            robot.received = Received(journal=envelope.journal, seq=envelope.seq)
        assert not isinstance(envelope.body, Deny), envelope.body
        if isinstance(envelope.body, Grant | Detour):
            self.floor.asides += isinstance(envelope.body, Detour)
            self.granted += envelope.body.legs

    async def _drive(self) -> None:
        """Over the crossing, and into the bay or the corridor behind it, up to its end."""
        name, legs = self.robot.name, self._way_on()
        last = legs[-1]
        post = last.from_post
        self.floor.enter(name, f"crossing {post}")
        await asyncio.sleep(0)
        if self.came_from is not None:
            behind = Leg(from_post=self.came_from, to_post=post)
            await self._leave(corridor_name(self.came_from, post), behind)
        await self.report("crossing", post)
        self.floor.enter(name, last.to_post if TRACK.post(last.to_post).bay_of else corridor_name(post, last.to_post))
        await asyncio.sleep(0.001)
        if self.came_from is None:
            await self._leave(self.place, legs[0])
        self.floor.leave(name, f"crossing {post}")
        if TRACK.post(last.to_post).bay_of:
            await self.report("bay", last.to_post)
            await self._clear(last)
            self.came_from = None
        else:
            await self.report("corridor", post, last.to_post)
            self.came_from = post
        self.place = last.to_post

    async def _leave(self, place: str, leg: Leg) -> None:
        self.floor.leave(self.robot.name, place)
        await self._clear(leg)

    async def _clear(self, leg: Leg) -> None:
        if leg in self.granted:
            self.granted.remove(leg)
            await self.say(Clear(leg=leg, post=leg.to_post))


async def all_of(travellers: Sequence[BayTraveller], ways: Sequence[Sequence[str]]) -> None:
    """Each goes to its posts, one after the other, and home; all at the same time."""

    async def goes(traveller: BayTraveller, posts: Sequence[str]) -> None:
        for post in posts:
            await traveller.go_to(post)
        await traveller.go_to(traveller.home)

    async with asyncio.TaskGroup() as group:
        for traveller, posts in zip(travellers, ways, strict=True):
            group.create_task(goes(traveller, posts))
