"""Robots that share the track: nobody meets anybody, everybody arrives, and who waits knows for whom."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from itertools import pairwise

import pytest

from app.settings import Settings
from app.tables import Alarm, GrantRow, RobotRow
from maps import builtin_map, corridor_name, shortest_route
from protocol.clock import SteppedClock
from protocol.envelope import TO_ROBOT, parse
from protocol.parts import Leg, Received
from protocol.to_robot import Detour, Grant
from protocol.to_server import Claim, Clear
from tests.app.fleet.playing import PlayedRobot, Service, serving, until

TRACK = builtin_map("test_track")
UNDERSTANDS = ("confirm", "watch", "open_way", "detour")


@dataclass
class Track:
    """Who is where, as a person beside the line would see it."""

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
    async def greeted(self, service: Service, token: str) -> AsyncIterator[None]:
        async with self.robot.connected(service.url, token):
            await self.robot.greet(self.post, home="post5", understands=UNDERSTANDS)
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


async def until_nothing_is_held(service: Service) -> None:
    async def is_so() -> bool:
        return await service.rows(GrantRow, cleared_at=None) == []

    await until(is_so)


@pytest.fixture
def by_timetable(settings: Settings) -> Settings:
    return settings.model_copy(update={"traffic": "timetable"})


@pytest.fixture
async def service(by_timetable: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    async with serving(by_timetable, clock) as service:
        yield service


@pytest.fixture
async def travellers(service: Service, clock: SteppedClock) -> AsyncIterator[tuple[Traveller, Traveller]]:
    """r1 at post1 and r2 at post4, at the two ends of the track; their docks are at post5."""
    track = Track(at={"r1": "post1", "r2": "post4"})
    first, second = (Traveller(PlayedRobot(clock, name), track) for name in track.at)
    tokens = {name: await service.enrol(name) for name in track.at}
    async with first.greeted(service, tokens["r1"]), second.greeted(service, tokens["r2"]):
        yield first, second


async def test_two_robots_swap_places_on_a_line_where_they_cannot_pass(travellers: tuple[Traveller, Traveller]) -> None:
    first, second = travellers
    await asyncio.gather(first.go_to("post4"), second.go_to("post1"))
    assert first.track.at == {"r1": "post4", "r2": "post1"}
    assert first.track.asides, "one of them had to step aside"


async def test_who_waits_is_told_for_whom_and_people_see_it(
    service: Service, travellers: tuple[Traveller, Traveller]
) -> None:
    first, second = travellers
    await first.claim("post3")
    leg = await first.answer()
    await second.claim("post1")

    async def waits() -> RobotRow | None:
        row: RobotRow = await service.row(RobotRow, name="r2")
        return row if row.waits_for else None

    row = await until(waits)
    waits_for = row.waits_for
    assert (leg.to_post, waits_for["robots"]) == ("post2", ["r1"])
    async with service.app.state.database.reading() as session:
        views = {view.name: view for view in await service.app.state.fleet.views(session)}
    assert views["r2"].why == "Waiting at post4 for the corridor to post3, after r1"
    assert views["r2"].why_words.key == "why.others_first"
    assert (row.activity, views["r2"].activity) == ("idle", "waiting"), "who has somewhere to go is not free"


async def test_what_was_granted_is_granted_after_a_restart_of_the_service(
    by_timetable: Settings, clock: SteppedClock
) -> None:
    track = Track(at={"r1": "post1", "r2": "post2"})
    first, second = (Traveller(PlayedRobot(clock, name), track) for name in track.at)
    async with serving(by_timetable, clock) as service:
        tokens = {name: await service.enrol(name) for name in track.at}
        async with second.greeted(service, tokens["r2"]):
            await second.claim("post3")
            inside = await second.answer()
    async with serving(by_timetable, clock) as service:
        both = first.greeted(service, tokens["r1"]), second.greeted(service, tokens["r2"])
        async with both[0], both[1]:
            track.enter("r2", inside)
            going = asyncio.create_task(first.go_to("post3"))
            await asyncio.sleep(0.5)
            assert not going.done(), "r2 holds the bay at post3, and may be on its way there"
            await second.leave(inside)
            await second.go_to("post4")
            await going
            await until_nothing_is_held(service)


async def test_after_a_restart_of_the_service_a_robot_stands_where_it_left_its_last_corridor(
    by_timetable: Settings, clock: SteppedClock
) -> None:
    """It was seen at post4 last, and has not said hello to the new service yet."""
    track = Track(at={"r2": "post4"})
    second = Traveller(PlayedRobot(clock, "r2"), track)
    async with serving(by_timetable, clock) as service, second.greeted(service, await service.enrol("r2")):
        await second.go_to("post3")
        await until_nothing_is_held(service)
    async with serving(by_timetable, clock) as service:

        async def stands_at() -> str | None:
            timetable = service.app.state.traffic_desk.timetable
            return timetable.known["r2"].post if timetable else None

        assert await until(stands_at) == "post3"


async def test_a_robot_that_falls_silent_keeps_its_corridor_rings_once_and_is_one_of_them_again_when_it_is_back(
    service: Service, clock: SteppedClock
) -> None:
    track = Track(at={"r1": "post1", "r2": "post4"})
    first, second = (Traveller(PlayedRobot(clock, name), track) for name in track.at)
    tokens = {name: await service.enrol(name) for name in track.at}
    async with second.greeted(service, tokens["r2"]):
        async with first.greeted(service, tokens["r1"]):
            await first.claim("post3")
            inside = await first.answer()

        async def rings(is_over: bool) -> bool:
            alarms = await service.rows(Alarm, robot="r1", name="vanished")
            return len(alarms) == 1 and (alarms[0].cleared_at is not None) == is_over

        clock.advance(1000)
        await second.claim("post1")
        await until(lambda: rings(is_over=False))
        assert [row.to_post for row in await service.rows(GrantRow, cleared_at=None, robot="r1")] == ["post2", "post3"]
        async with first.greeted(service, tokens["r1"]):
            await until(lambda: rings(is_over=True))
            track.enter("r1", inside)
            await first.leave(inside)
            await asyncio.gather(first.go_to("post4"), second.go_to("post1"))
    assert track.at == {"r1": "post4", "r2": "post1"}
