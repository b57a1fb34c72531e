"""Fewer docks than robots: who has charge enough and nothing to do leaves its dock to one that needs it more."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import pytest

from app.core.settings import Settings
from app.models import MissionRow, RobotRow, StopRow
from protocol.clock import SteppedClock
from protocol.envelope import YOUNGER
from protocol.parts import Activity, Battery, Stop, StopAction
from protocol.to_server import Snapshot, Step
from tests.app.robots.playing import PlayedRobot, Service, at_post, serving, until

DOCK = "post5"


@pytest.fixture
async def service(settings: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    """On the track, where the one dock is at post5."""
    async with serving(settings, clock) as service:
        yield service


@asynccontextmanager
async def robot(
    service: Service, clock: SteppedClock, name: str, post: str, ratio: float
) -> AsyncIterator[PlayedRobot]:
    played = PlayedRobot(clock, name)
    async with played.connected(service.url, await service.enrol(name)):
        await played.greet(post, battery=Battery(ratio=ratio, docked=post == DOCK), understands=YOUNGER)
        yield played


async def look(service: Service) -> None:
    await service.app.state.parts.charging_service.poll()


async def test_it_is_sent_to_park_and_the_other_to_the_dock_once_it_is_free(
    service: Service, clock: SteppedClock
) -> None:
    async with robot(service, clock, "r1", DOCK, 0.85) as rests, robot(service, clock, "r2", "post1", 0.45) as comes:
        await look(service)
        leaves = await rests.mission()
        (park,) = leaves.stops
        assert (park.action, park.order_id) == (StopAction.PARK, None)
        assert park.post == "post4", "at post1 stands the other, and at post2 and post3 no robot could pass"
        await look(service)
        assert len(await service.rows(MissionRow)) == 1, "the dock is not free yet"

        await rests.say(
            Snapshot(position=at_post(park.post), activity=Activity.IDLE, battery=Battery(ratio=0.84, docked=False))
        )
        await rests.ends(await rests.report(leaves, Step.DONE, park))
        await until(lambda: service.row(StopRow, id=park.id, gave_up_at=None))
        await look(service)
        (dock,) = (await comes.mission()).stops
        assert (dock.action, dock.post) == (StopAction.DOCK, DOCK)
        await look(service)
        assert len(await service.rows(MissionRow)) == 2, "and the first stays where it is"


async def test_no_robot_leaves_for_one_that_has_hardly_less(service: Service, clock: SteppedClock) -> None:
    async with robot(service, clock, "r1", DOCK, 0.85), robot(service, clock, "r2", "post1", 0.7):
        await look(service)
        assert await service.rows(MissionRow) == []


async def test_no_robot_leaves_that_has_not_enough_itself(service: Service, clock: SteppedClock) -> None:
    async with robot(service, clock, "r1", DOCK, 0.6), robot(service, clock, "r2", "post1", 0.3):
        await look(service)
        assert await service.rows(MissionRow) == []


async def test_for_a_robot_whose_own_battery_plan_has_taken_over_half_a_charge_is_enough(
    service: Service, clock: SteppedClock
) -> None:
    """It comes in any case. It is not sent, and no other robot is sent to where it goes."""
    async with robot(service, clock, "r1", DOCK, 0.6) as rests, robot(service, clock, "r2", "post1", 0.2) as comes:
        await comes.say(
            Snapshot(position=at_post("post1"), activity=Activity.STOPPED, battery=Battery(ratio=0.2, docked=False))
        )
        await look(service)
        (park,) = (await rests.mission()).stops
        assert park.action is StopAction.PARK
        assert {mission.robot for mission in await service.rows(MissionRow)} == {"r1"}


async def test_who_is_to_park_and_gets_work_does_the_work(service: Service, clock: SteppedClock) -> None:
    async with robot(service, clock, "r1", DOCK, 0.85) as rests, robot(service, clock, "r2", "post1", 0.3):
        await look(service)
        await rests.mission()
        await service.order("post2", "post3")
        told = await rests.mission()
        while any(stop.action is StopAction.PARK for stop in told.stops):
            told = await rests.mission()
        assert [stop.action for stop in told.stops] == [StopAction.LOAD, StopAction.RECEIVE]


async def sent_to_charge(service: Service, one: PlayedRobot) -> Stop:
    """To the dock where it stands with hardly anything."""
    await look(service)
    (dock,) = (await one.mission()).stops
    assert (dock.action, dock.until_ratio) == (StopAction.DOCK, 0.8)
    return dock


async def comes_into_dock(service: Service, one: PlayedRobot) -> None:
    battery = Battery(ratio=0.45, docked=True, charging=True)
    await one.say(Snapshot(position=at_post(DOCK), activity=Activity.CHARGING, battery=battery))
    await until(lambda: service.rows(RobotRow, name=one.name, docked=True))


async def test_who_charges_leaves_with_half_a_charge_for_one_with_hardly_anything(
    service: Service, clock: SteppedClock
) -> None:
    """Also to one that has a dock of its own, which is farther."""
    async with robot(service, clock, "r1", "post4", 0.4) as charges:
        dock = await sent_to_charge(service, charges)
        await comes_into_dock(service, charges)
        low = PlayedRobot(clock, "r2")
        async with low.connected(service.url, await service.enrol("r2")):
            await low.greet("post3", battery=Battery(ratio=0.2), understands=YOUNGER, home="post1")
            await look(service)
            (told,) = (await charges.mission()).stops
            assert (told.id, told.until_ratio) == (dock.id, 0.53)
            await look(service)
            assert len(await service.rows(MissionRow)) == 1


async def test_who_charges_stays_where_no_other_needs_its_dock(service: Service, clock: SteppedClock) -> None:
    async with robot(service, clock, "r1", "post4", 0.4) as charges, robot(service, clock, "r2", "post3", 0.5):
        dock = await sent_to_charge(service, charges)
        await comes_into_dock(service, charges)
        await look(service)
        (row,) = await service.rows(StopRow, id=dock.id)
        assert row.until_ratio == 0.8
