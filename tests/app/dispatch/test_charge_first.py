"""Before each leg: who has not the charge for it goes to a dock first, once, and then about its work."""

from collections.abc import AsyncIterator
from itertools import pairwise

import pytest

from app.charging.charge_first import REASON
from app.core.settings import Settings
from app.models import ClaimRow, MissionRow, MissionState, StopRow
from maps import shortest_route
from protocol.clock import SteppedClock
from protocol.envelope import YOUNGER
from protocol.parts import Activity, Battery, Leg, Position, Stop, StopAction
from protocol.to_robot import Grant, Mission
from protocol.to_server import Claim, Clear, Snapshot, Step
from tests.app.robots.playing import PlayedRobot, Service, serving
from tests.plain_maps import plain_map

TRACK = plain_map("test_track")


@pytest.fixture
async def service(settings: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    async with serving(settings, clock) as service:
        yield service


@pytest.fixture
async def robot(service: Service, clock: SteppedClock) -> AsyncIterator[PlayedRobot]:
    """At post2, with a charge that was enough for anything; the one dock is at post5."""
    robot = PlayedRobot(clock)
    async with robot.connected(service.url, await service.enrol("r1")):
        await robot.greet("post2", battery=Battery(ratio=0.9, docked=False), understands=YOUNGER)
        yield robot


async def claims(robot: PlayedRobot, claim_id: str, from_post: str, goal: str) -> tuple[Leg, ...]:
    posts = shortest_route(TRACK, from_post, goal).posts
    legs = tuple(Leg(from_post=a, to_post=b) for a, b in pairwise(posts))
    await robot.say(Claim(claim_id=claim_id, legs=legs, goal=goal))
    return legs


async def has(robot: PlayedRobot, ratio: float, post: str, *, docked: bool = False) -> None:
    """So much charge, where it stands."""
    battery = Battery(ratio=ratio, docked=docked, charging=docked)
    await robot.say(Snapshot(position=Position(post=post), activity=Activity.IDLE, battery=battery))


async def sent_to_charge(robot: PlayedRobot) -> tuple[Mission, Stop]:
    mission = await robot.mission()
    first = mission.stops[0]
    assert first.action is StopAction.DOCK
    return mission, first


async def test_who_has_less_than_was_foreseen_goes_to_a_dock_before_its_next_leg(
    service: Service, robot: PlayedRobot
) -> None:
    await service.order()
    given = await robot.mission()
    await has(robot, 0.25, "post2")
    await claims(robot, "c1", "post2", "post1")
    mission, dock = await sent_to_charge(robot)
    assert (mission.id, mission.stops[1:]) == (given.id, given.stops)
    assert (dock.post, dock.until_ratio) == ("post5", 0.53)
    (claim,) = await service.rows(ClaimRow)
    assert (claim.granted, claim.reason) == (False, REASON)
    await service.app.state.parts.charging_service.poll()
    (row,) = await service.rows(StopRow, action=StopAction.DOCK)
    assert row.dropped_at is None, "work does not call it away: it has not the charge for it"


async def test_it_is_let_in_on_its_way_to_the_dock_and_after_it_has_charged(
    service: Service, robot: PlayedRobot
) -> None:
    await service.order()
    await robot.mission()
    await has(robot, 0.25, "post2")
    await claims(robot, "c1", "post2", "post1")
    mission, dock = await sent_to_charge(robot)
    legs = await claims(robot, "c2", "post2", "post5")
    assert (await robot.hear("grant")).body == Grant(claim_id="c2", legs=legs)
    for leg in legs:
        await robot.say(Clear(leg=leg, post=leg.to_post))
    await has(robot, 0.25, "post5", docked=True)
    await robot.report(mission, Step.DONE, dock)
    await has(robot, 0.25, "post5")  # a pack that takes no charge: it is not sent there for ever
    legs = await claims(robot, "c3", "post5", "post1")
    assert (await robot.hear("grant")).body == Grant(claim_id="c3", legs=legs)


async def test_who_has_charged_enough_is_called_away_before_it_is_full(service: Service, robot: PlayedRobot) -> None:
    await service.order()
    await robot.mission()
    await has(robot, 0.25, "post2")
    await claims(robot, "c1", "post2", "post1")
    await sent_to_charge(robot)
    await has(robot, 0.6, "post5", docked=True)
    told = await robot.mission()
    assert [stop.action for stop in told.stops] == [StopAction.LOAD, StopAction.RECEIVE]


async def test_where_no_dock_is_free_its_own_battery_plan_has_the_last_word(
    service: Service, robot: PlayedRobot, clock: SteppedClock
) -> None:
    other = PlayedRobot(clock, "r2")
    async with other.connected(service.url, await service.enrol("r2")):
        await service.order()
        await robot.mission()
        await other.greet("post5", battery=Battery(ratio=0.3, docked=True, charging=True), home="post5")
        await has(robot, 0.25, "post2")
        legs = await claims(robot, "c1", "post2", "post1")
        assert (await robot.hear("grant")).body == Grant(claim_id="c1", legs=legs)


async def test_a_robot_that_does_not_know_of_charging_at_a_stop_is_let_in(
    service: Service, clock: SteppedClock
) -> None:
    older = PlayedRobot(clock)
    async with older.connected(service.url, await service.enrol("r1")):
        await older.greet("post2", battery=Battery(ratio=0.9, docked=False))
        await service.order()
        await older.mission()
        await has(older, 0.25, "post2")
        legs = await claims(older, "c1", "post2", "post1")
        assert (await older.hear("grant")).body == Grant(claim_id="c1", legs=legs)


@pytest.fixture
async def guest(service: Service, clock: SteppedClock) -> AsyncIterator[PlayedRobot]:
    """At post2, with nothing to do. Its home is post1, where it cannot charge."""
    guest = PlayedRobot(clock)
    async with guest.connected(service.url, await service.enrol("r1")):
        await guest.greet("post2", battery=Battery(ratio=0.9, docked=False), understands=YOUNGER, home="post1")
        yield guest


async def test_who_would_come_home_with_too_little_charges_on_the_way(service: Service, guest: PlayedRobot) -> None:
    await has(guest, 0.25, "post2")
    await claims(guest, "c1", "post2", "post1")
    mission, dock = await sent_to_charge(guest)
    assert (mission.stops, dock.post, dock.until_ratio) == ((dock,), "post5", 0.8)
    (claim,) = await service.rows(ClaimRow)
    assert (claim.granted, claim.reason) == (False, REASON)
    legs = await claims(guest, "c2", "post2", "post5")
    assert (await guest.hear("grant")).body == Grant(claim_id="c2", legs=legs)


async def test_who_comes_home_with_enough_is_let_in(guest: PlayedRobot) -> None:
    await has(guest, 0.6, "post2")
    legs = await claims(guest, "c1", "post2", "post1")
    assert (await guest.hear("grant")).body == Grant(claim_id="c1", legs=legs)


async def test_a_dock_to_which_one_with_hardly_anything_drives_is_left_to_it(
    service: Service, guest: PlayedRobot, clock: SteppedClock
) -> None:
    low = PlayedRobot(clock, "r2")
    async with low.connected(service.url, await service.enrol("r2")):
        await low.greet("post3", battery=Battery(ratio=0.2, docked=False), home="post4")
        await has(guest, 0.25, "post2")
        legs = await claims(guest, "c1", "post2", "post1")
        assert (await guest.hear("grant")).body == Grant(claim_id="c1", legs=legs)


async def test_who_goes_elsewhere_for_reasons_of_its_own_is_let_in(guest: PlayedRobot) -> None:
    await has(guest, 0.25, "post2")
    legs = await claims(guest, "c1", "post2", "post4")
    assert (await guest.hear("grant")).body == Grant(claim_id="c1", legs=legs)


async def test_a_robot_that_does_not_know_of_charging_at_a_stop_goes_home(
    service: Service, clock: SteppedClock
) -> None:
    older = PlayedRobot(clock)
    async with older.connected(service.url, await service.enrol("r1")):
        await older.greet("post2", battery=Battery(ratio=0.25, docked=False), home="post1")
        legs = await claims(older, "c1", "post2", "post1")
        assert (await older.hear("grant")).body == Grant(claim_id="c1", legs=legs)


async def test_a_dock_that_did_not_help_is_not_tried_again_at_once(guest: PlayedRobot) -> None:
    await has(guest, 0.25, "post2")
    await claims(guest, "c1", "post2", "post1")
    mission, dock = await sent_to_charge(guest)
    for leg in await claims(guest, "c2", "post2", "post5"):
        await guest.say(Clear(leg=leg, post=leg.to_post))
    await has(guest, 0.25, "post5", docked=True)
    await guest.report(mission, Step.DONE, dock)
    await guest.report(mission, Step.DONE)
    await has(guest, 0.25, "post5")
    legs = await claims(guest, "c3", "post5", "post1")
    assert (await guest.hear("grant")).body == Grant(claim_id="c3", legs=legs)


async def test_docks_that_do_not_help_are_not_tried_for_ever(
    service: Service, guest: PlayedRobot, clock: SteppedClock
) -> None:
    """It was on three errands to docks, one after the other."""
    async with service.app.state.parts.database.transaction() as session:
        for number in range(3):
            session.add(MissionRow(id=f"m{number}", robot="r1", created_at=clock.utc(), state=MissionState.DONE))
            await session.flush()
            stop = StopRow(id=f"s{number}", mission_id=f"m{number}", position=0, post="post5", action=StopAction.DOCK)
            stop.done_at = clock.utc()
            session.add(stop)
    await has(guest, 0.25, "post2")
    legs = await claims(guest, "c1", "post2", "post1")
    assert (await guest.hear("grant")).body == Grant(claim_id="c1", legs=legs)
