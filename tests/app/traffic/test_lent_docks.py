"""A dock that is no robot's home: lent to one that charges there, on the line to no other, and given back."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack

import pytest

from app.core.settings import Settings
from app.models import Alarm, MissionRow, MissionState, RobotRow
from app.robots.alarms import VANISHED
from protocol.clock import SteppedClock
from protocol.parts import Activity, Battery, StopAction
from protocol.to_robot import Mission
from protocol.to_server import Snapshot, Step
from tests.app.robots.playing import Service, at_post, serving, until
from tests.app.traffic.bay_travelling import MAP, BayTraveller, Floor
from tests.app.traffic.test_bays import travellers

DOCK = "post2_bay2"
HOMES_WITHOUT_A_DOCK = "post1_bay2", "post4_bay2"


@pytest.fixture
async def service(settings: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    async with serving(settings.model_copy(update={"map": str(MAP)}), clock) as service:
        yield service


async def tells(service: Service, one: BayTraveller, ratio: float, *, docked: bool) -> None:
    """Until the service knows it."""
    activity = Activity.CHARGING if docked else Activity.IDLE
    battery = Battery(ratio=ratio, docked=docked, charging=docked)
    await one.robot.say(Snapshot(position=at_post(one.place), activity=activity, battery=battery))
    await until(lambda: service.rows(RobotRow, name=one.robot.name, battery_ratio=ratio, docked=docked))


async def ends(service: Service, one: BayTraveller, told: Mission) -> None:
    (stop,) = told.stops
    await one.robot.ends(await one.robot.report(told, Step.DONE, stop))
    await until(lambda: service.rows(MissionRow, id=told.id, state=MissionState.DONE))


async def test_one_robot_at_a_time_charges_and_makes_room_by_going_home(service: Service, clock: SteppedClock) -> None:
    charging = service.app.state.parts.charging_service
    first, second = travellers(clock, Floor(), HOMES_WITHOUT_A_DOCK)
    async with AsyncExitStack() as stack:
        for one, ratio in ((first, 0.45), (second, 0.6)):
            await stack.enter_async_context(one.greeted(service))
            await tells(service, one, ratio, docked=False)
        await charging.poll()
        assert [row.robot for row in await service.rows(MissionRow)] == [first.robot.name], "it has less"
        told = await first.robot.mission()
        assert [(stop.action, stop.post) for stop in told.stops] == [(StopAction.DOCK, "post2")]
        await first.go_to(DOCK)
        await tells(service, first, 0.9, docked=True)
        await ends(service, first, told)

        # The other passes the post with the dock, and stands in the bay that is for passing.
        await second.go_to("post2")
        assert second.place == "post2_bay1"
        await tells(service, second, 0.4, docked=False)

        await charging.poll()
        told = await first.robot.mission()
        assert [(stop.action, stop.post) for stop in told.stops] == [(StopAction.PARK, "post1")], "home, without a dock"
        await first.go_to(first.home)
        await tells(service, first, 0.89, docked=False)
        await ends(service, first, told)

        await charging.poll()
        told = await second.robot.mission()
        assert [(stop.action, stop.post) for stop in told.stops] == [(StopAction.DOCK, "post2")]
        await second.go_to(DOCK)
        assert (first.place, second.place) == (HOMES_WITHOUT_A_DOCK[0], DOCK)


async def test_a_robot_whose_own_battery_plan_asks_for_the_dock_is_let_in_where_it_is_free(
    service: Service, clock: SteppedClock
) -> None:
    first, second = travellers(clock, Floor(), HOMES_WITHOUT_A_DOCK)
    async with AsyncExitStack() as stack:
        for one in (first, second):
            await stack.enter_async_context(one.greeted(service))
        await first.go_to(DOCK)
        await second.go_to("post2")
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(2.0):
                await second.go_to(DOCK)
        await first.go_to(first.home)
        assert first.place == HOMES_WITHOUT_A_DOCK[0]


async def test_a_robot_that_waits_for_the_dock_with_work_after_that_lets_the_other_out(
    service: Service, clock: SteppedClock
) -> None:
    """Its work leads the same way. It charges before that, which takes hours."""
    first, second = travellers(clock, Floor(), HOMES_WITHOUT_A_DOCK)
    async with AsyncExitStack() as stack:
        await stack.enter_async_context(second.greeted(service))
        await tells(service, second, 0.9, docked=False)
        await service.order("post1", "post3")
        await second.robot.mission()
        await stack.enter_async_context(first.greeted(service))
        await first.go_to(DOCK)
        await second.go_to("post2")
        await tells(service, second, 0.2, docked=False)
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(2.0):
                await second.go_to(DOCK)
        async with asyncio.timeout(20.0):
            await first.go_to(first.home)
        assert (first.place, second.place) == (HOMES_WITHOUT_A_DOCK[0], "post2_bay1")


async def test_a_robot_in_a_lent_dock_that_is_switched_off_is_not_missed(service: Service, clock: SteppedClock) -> None:
    (one,) = travellers(clock, Floor(), HOMES_WITHOUT_A_DOCK[:1])
    async with one.greeted(service):
        await one.go_to(DOCK)
    clock.advance(service.app.state.parts.settings.vanished_after_s + 60)
    await service.app.state.parts.traffic_service.poll()
    assert await service.rows(Alarm, name=VANISHED) == []


async def test_a_robot_that_goes_elsewhere_than_it_was_told_is_let_in_there(
    service: Service, clock: SteppedClock
) -> None:
    """It knows best when it has to charge: before its bay the service has not forgotten that it wants to go there."""
    floor = Floor()
    (one,) = travellers(clock, floor, HOMES_WITHOUT_A_DOCK[:1])
    async with one.greeted(service):
        await one.go_to("post3")
        await tells(service, one, 0.45, docked=False)
        await service.app.state.parts.charging_service.poll()
        (stop,) = (await one.robot.mission()).stops
        assert stop.post == "post2"
        async with asyncio.timeout(30.0):
            await one.go_to(one.home)
        assert (one.place, floor.asides) == (one.home, 0)
