"""A dispatcher has looked where a dead robot was: its corridors are given to others, and it hears so when it wakes."""

import asyncio
from collections.abc import AsyncIterator
from typing import Any

import pytest

from app.core.settings import Settings
from app.models import Alarm, GrantRow, RobotCommand, RobotRow
from app.robots.errors import RobotGoesOn
from app.robots.service import known_robot
from app.traffic.out_of_service import take_out
from protocol.clock import SteppedClock
from protocol.parts import Activity, Battery
from protocol.to_robot import Revoke
from protocol.to_server import CommandAnswer, Event, Snapshot
from tests.app.robots.playing import PlayedRobot, Service, at_post, serving, until
from tests.app.robots.travelling import on_one_track

UNDERSTANDS = ("detour", "revoke")


@pytest.fixture
async def service(settings: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    async with serving(settings, clock) as service:
        yield service


async def taken_out(service: Service, name: str = "r1") -> str:
    """Take a robot out of service as a dispatcher and return the command's id."""
    state = service.app.state.parts
    async with state.database.transaction() as session:
        by = await state.sign_in_service.person(session, "dan@campus.example", state.clock.utc())
        robot = await known_robot(session, name, to_change=True)
        return (await take_out(session, state.fleet, robot, "Carried into the workshop.", by)).command_id


async def is_heard(service: Service, robot: PlayedRobot, revoke: Revoke) -> None:
    answer = CommandAnswer(command_id=revoke.command_id, accepted=True, happened_at=robot.clock.utc())
    await robot.ends(await robot.say(Event(happened=answer)))


def says(activity: Activity, post: str | None = None, **battery: Any) -> Snapshot:
    return Snapshot(position=at_post(post), activity=activity, battery=Battery(ratio=0.9, **battery))


async def test_others_go_on_at_once_and_it_is_one_of_them_again_when_it_has_heard_and_stands_at_a_post(
    service: Service, clock: SteppedClock
) -> None:
    first, second = on_one_track(clock, r1="post1", r2="post4")
    async with second.greeted(service):
        async with first.greeted(service):
            await first.claim("post2")
            await first.answer()
        clock.advance(1000)
        await until(lambda: service.rows(Alarm, robot="r1", name="vanished", cleared_at=None))
        going = asyncio.create_task(second.go_to("post2"))
        await asyncio.sleep(0.5)
        assert not going.done(), "r1 may still come there"
        command_id = await taken_out(service)
        await going
        (grant,) = await service.rows(GrantRow, robot="r1")
        (told,) = await service.rows(RobotCommand, robot="r1")
        assert (grant.freed_by, told.command_id) == (command_id, command_id)
        assert (told.kind, told.asked_because, bool(told.asked_by_id)) == ("revoke", "Carried into the workshop.", True)
        assert await service.rows(Alarm, robot="r1", name="vanished", cleared_at=None) == []
        del first.track.at["r1"]  # it is in the workshop
        await second.go_to("post1")

        async with first.robot.connected(service.url, first.robot.token):
            await first.robot.greet("post1", home="post5", understands=UNDERSTANDS)
            revoke = (await first.robot.hear("revoke")).body
            assert isinstance(revoke, Revoke)
            assert (revoke.command_id, revoke.reason) == (command_id, "Carried into the workshop.")
            assert (await service.row(RobotRow, name="r1")).taken_out_at is not None
            await is_heard(service, first.robot, revoke)
            row = await service.row(RobotRow, name="r1")
            assert (row.taken_out_at, row.post) == (None, None)
            first.track.at["r1"] = "post3"
            await first.robot.say(says(Activity.IDLE, "post3"))
            await asyncio.gather(first.go_to("post4"), second.go_to("post2"))
    assert first.track.at == {"r1": "post4", "r2": "post2"}


async def test_who_stands_where_another_wants_to_go_is_named(service: Service, clock: SteppedClock) -> None:
    first, second = on_one_track(clock, r1="post1", r2="post2")
    async with first.greeted(service), second.greeted(service):
        await first.robot.say(says(Activity.STOPPED, "post1"))

        async def stands() -> bool:
            return bool((await service.row(RobotRow, name="r1")).activity == "stopped")

        await until(stands)
        going = asyncio.create_task(second.go_to("post1"))  # home, where it is in no robot's way

        async def waits() -> Any:
            return (await service.row(RobotRow, name="r2")).waits_for

        told = await until(waits)
        assert (told["from_post"], told["robots"], told["until"], told["closed"]) == ("post5", ["r1"], None, False)
        going.cancel()


async def test_a_robot_that_is_there_is_stopped_first_and_an_old_one_stays_out(
    service: Service, robot: PlayedRobot
) -> None:
    token = await service.enrol("r1")
    async with robot.connected(service.url, token):
        await robot.greet("post1", understands=UNDERSTANDS)
        with pytest.raises(RobotGoesOn, match="Stop it at once first"):
            await taken_out(service)
        await robot.say(says(Activity.STOPPED, "post1"))

        async def stands() -> bool:
            return bool((await service.row(RobotRow, name="r1")).activity == "stopped")

        await until(stands)
        await taken_out(service)
        await robot.hear("revoke")

    async def is_away() -> bool:
        return not (await service.row(RobotRow, name="r1")).online

    await until(is_away)
    async with robot.connected(service.url, token):
        await robot.greet("post1", understands=("detour",), received=robot.received)
        stop = (await robot.hear("emergency_stop")).body
        answer = CommandAnswer(command_id=stop.command_id, accepted=True, happened_at=robot.clock.utc())  # type: ignore[attr-defined]
        await robot.ends(await robot.say(Event(happened=answer)))
        assert (await service.row(RobotRow, name="r1")).taken_out_at is not None
    async with service.app.state.parts.database.reading() as session:
        (view,) = await service.app.state.parts.fleet.views(session)
    assert view.why_words.key == "why.taken_out"
