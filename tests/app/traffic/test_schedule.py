"""Robots that share the track: no two meet, all arrive, and a robot that waits knows for which one."""

import asyncio
from collections.abc import AsyncIterator

import pytest

from app.core.settings import Settings
from app.models import Alarm, ClaimRow, GrantRow, RobotRow
from app.robots.corridors.reservations import WITHDRAWN
from protocol.clock import SteppedClock
from protocol.to_server import Withdraw
from tests.app.robots.playing import Service, serving, until
from tests.app.robots.travelling import Traveller, on_one_track


async def until_nothing_is_held(service: Service) -> None:
    async def is_so() -> bool:
        return await service.rows(GrantRow, cleared_at=None) == []

    await until(is_so)


@pytest.fixture
async def service(settings: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    async with serving(settings, clock) as service:
        yield service


@pytest.fixture
async def travellers(service: Service, clock: SteppedClock) -> AsyncIterator[tuple[Traveller, Traveller]]:
    """r1 at post1 and r2 at post4, at the two ends of the track; their docks are at post5."""
    first, second = on_one_track(clock, r1="post1", r2="post4")
    async with first.greeted(service), second.greeted(service):
        yield first, second


async def test_two_robots_swap_places_on_a_line_where_they_cannot_pass(travellers: tuple[Traveller, Traveller]) -> None:
    first, second = travellers
    await asyncio.gather(first.go_to("post4"), second.go_to("post1"))
    assert first.track.at == {"r1": "post4", "r2": "post1"}
    assert first.track.asides, "one of them had to step aside"


async def test_an_older_robot_that_should_step_aside_is_denied_its_way_instead_and_the_denial_is_kept(
    service: Service, clock: SteppedClock
) -> None:
    async def denied() -> list[ClaimRow]:
        return [one for one in await service.rows(ClaimRow) if one.granted is False]

    first, second = on_one_track(clock, r1="post1", r2="post4")
    async with first.greeted(service, understands=()), second.greeted(service, understands=()):
        swapping = asyncio.gather(first.go_to("post4"), second.go_to("post1"))
        (claim,) = await until(denied)
        swapping.cancel()
        assert claim.reason == "others have to pass"


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
    async with service.app.state.parts.database.reading() as session:
        views = {view.name: view for view in await service.app.state.parts.fleet.views(session)}
    assert views["r2"].why == "Waiting at post4 for the corridor to post3, after r1"
    assert views["r2"].why_words.key == "why.others_first"
    assert (row.activity, views["r2"].activity) == ("idle", "waiting"), "who has somewhere to go is not free"


async def test_what_a_robot_has_asked_for_twice_is_not_granted_again_once_it_has_been_through(
    service: Service, travellers: tuple[Traveller, Traveller]
) -> None:
    """It had asked again before it heard the answer, and is where the way that it asked for ends."""
    first, second = travellers
    await first.claim("post2")
    leg = await first.answer()
    await first.claim("post2")
    await first.drive(leg)
    await second.go_to("post3")
    claims = await service.rows(ClaimRow, robot="r1")
    assert [(claim.claim_id, claim.granted) for claim in claims] == [("c1", True), ("c2", False)]
    await until_nothing_is_held(service)


async def test_who_takes_back_what_it_waits_for_is_in_no_robots_way(
    service: Service, travellers: tuple[Traveller, Traveller]
) -> None:
    first, second = travellers
    await first.claim("post3")
    await first.answer()
    await second.claim("post1")

    async def waits() -> bool:
        row: RobotRow = await service.row(RobotRow, name="r2")
        return row.waits_for is not None

    async def goes_somewhere() -> bool | None:
        """None for a moment, where what was taken back had just been decided: all is planned anew then."""
        schedule = service.app.state.parts.traffic_service.schedule
        return None if schedule is None else bool(schedule.controller.goals("r2"))

    async def goes_nowhere() -> bool:
        return not await waits() and await goes_somewhere() is False

    await until(waits)
    assert await goes_somewhere()
    await second.robot.say(Withdraw(claim_id="c1"))
    await until(goes_nowhere)
    (claim,) = await service.rows(ClaimRow, robot="r2")
    assert (claim.granted, claim.reason) == (False, WITHDRAWN)


async def test_what_was_granted_is_granted_after_a_restart_of_the_service(
    settings: Settings, clock: SteppedClock
) -> None:
    first, second = on_one_track(clock, r1="post1", r2="post2")
    async with serving(settings, clock) as service, second.greeted(service):
        await second.claim("post3")
        inside = await second.answer()
    async with serving(settings, clock) as service:
        both = first.greeted(service), second.greeted(service)
        async with both[0], both[1]:
            first.track.enter("r2", inside)
            going = asyncio.create_task(first.go_to("post3"))
            await asyncio.sleep(0.5)
            assert not going.done(), "r2 holds the bay at post3, and may be on its way there"
            await second.leave(inside)
            await second.go_to("post4")
            await going
            await until_nothing_is_held(service)


async def test_after_a_restart_of_the_service_a_robot_stands_where_it_left_its_last_corridor(
    settings: Settings, clock: SteppedClock
) -> None:
    """It was seen at post4 last, and has not said hello to the new service yet."""
    (second,) = on_one_track(clock, r2="post4")
    async with serving(settings, clock) as service, second.greeted(service):
        await second.go_to("post3")
        await until_nothing_is_held(service)
    async with serving(settings, clock) as service:

        async def stands_at() -> str | None:
            schedule = service.app.state.parts.traffic_service.schedule
            return schedule.known["r2"].post if schedule else None

        assert await until(stands_at) == "post3"


async def test_a_robot_that_falls_silent_keeps_its_corridor_rings_once_and_is_one_of_them_again_when_it_is_back(
    service: Service, clock: SteppedClock
) -> None:
    first, second = on_one_track(clock, r1="post1", r2="post4")
    async with second.greeted(service):
        async with first.greeted(service):
            await first.claim("post3")
            inside = await first.answer()

        async def rings(is_over: bool) -> bool:
            alarms = await service.rows(Alarm, robot="r1", name="vanished")
            return len(alarms) == 1 and (alarms[0].cleared_at is not None) == is_over

        clock.advance(1000)
        await second.claim("post1")
        await until(lambda: rings(is_over=False))
        assert [row.to_post for row in await service.rows(GrantRow, cleared_at=None, robot="r1")] == ["post2", "post3"]
        async with first.greeted(service):
            await until(lambda: rings(is_over=True))
            first.track.enter("r1", inside)
            await first.leave(inside)
            await asyncio.gather(first.go_to("post4"), second.go_to("post1"))
    assert first.track.at == {"r1": "post4", "r2": "post1"}
