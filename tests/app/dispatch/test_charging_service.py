"""Robots without a dock of their own are sent to charge when they have nothing to do; no two to one dock."""

from collections.abc import AsyncIterator
from contextlib import AsyncExitStack
from datetime import UTC, datetime, timedelta

import pytest

from app.core.settings import Settings
from app.models import MissionRow, StopRow
from protocol.clock import SteppedClock
from protocol.envelope import YOUNGER
from protocol.parts import Battery, StopAction
from tests.app.robots.playing import PlayedRobot, Service, serving


@pytest.fixture
async def service(settings: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    async with serving(settings, clock) as service:
        yield service


@pytest.fixture
async def resting(service: Service, clock: SteppedClock) -> AsyncIterator[tuple[PlayedRobot, PlayedRobot]]:
    """r1 at post1 and r2 at post4, neither of them full; the one dock is at post5."""
    robots = PlayedRobot(clock, "r1"), PlayedRobot(clock, "r2")
    async with AsyncExitStack() as stack:
        for robot, post, ratio in zip(robots, ("post1", "post4"), (0.6, 0.7), strict=True):
            token = await service.enrol(robot.name)
            await stack.enter_async_context(robot.connected(service.url, token))
            await robot.greet(post, battery=Battery(ratio=ratio, docked=False), understands=YOUNGER)
        yield robots


async def test_one_goes_to_the_only_dock_and_no_other_robot_is_sent_there(
    service: Service, resting: tuple[PlayedRobot, PlayedRobot]
) -> None:
    for _ in range(2):
        await service.app.state.parts.charging_service.poll()
    missions = await service.rows(MissionRow)
    assert len(missions) == 1
    robot = next(one for one in resting if one.name == missions[0].robot)
    (stop,) = (await robot.mission()).stops
    assert (stop.action, stop.post, stop.until_ratio) == (StopAction.DOCK, "post5", 0.8)


async def test_a_robot_that_charges_is_called_away_for_an_order(
    service: Service, resting: tuple[PlayedRobot, PlayedRobot]
) -> None:
    await service.app.state.parts.charging_service.poll()
    (charging,) = await service.rows(MissionRow)
    robot = next(one for one in resting if one.name == charging.robot)
    other = next(one for one in resting if one is not robot)
    assert other.socket is not None
    await other.socket.close()
    await robot.mission()
    await service.order()
    told = await robot.mission()
    while any(stop.action is StopAction.DOCK for stop in told.stops):
        told = await robot.mission()
    assert [stop.action for stop in told.stops] == [StopAction.LOAD, StopAction.RECEIVE]
    assert told.id == charging.id
    (dock,) = await service.rows(StopRow, action=StopAction.DOCK)
    assert dock.dropped_at is not None


async def test_who_does_not_know_of_charging_at_a_stop_is_left_to_its_own_battery_plan(
    service: Service, clock: SteppedClock
) -> None:
    older = PlayedRobot(clock)
    async with older.connected(service.url, await service.enrol("r1")):
        await older.greet("post1", battery=Battery(ratio=0.6, docked=False))
        await service.app.state.parts.charging_service.poll()
        assert await service.rows(MissionRow) == []


async def test_hours_that_are_quiet_stay_so_when_clocks_are_put_back(settings: Settings) -> None:
    """Mail is sent at nine; half past seven in November is quiet, though by UTC it is when they sent in October."""
    october = SteppedClock(started_at=datetime(2026, 10, 19, 13, 10, tzinfo=UTC))
    at_campus = settings.model_copy(update={"time_zone": "America/Toronto"})
    async with serving(at_campus, october) as service:
        for _ in range(4):
            await service.cancel(await service.order())
        october.advance(timedelta(days=13, hours=23, minutes=20).total_seconds())
        robot = PlayedRobot(october)
        async with robot.connected(service.url, await service.enrol("r1")):
            await robot.greet("post1", battery=Battery(ratio=0.6, docked=False), understands=YOUNGER)
            await service.app.state.parts.charging_service.poll()
            (stop,) = (await robot.mission()).stops
            assert stop.until_ratio == 0.95, "there is time to fill up"
