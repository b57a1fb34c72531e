"""Dispatch in the running service: woken by orders and robots, robust to restarts, one mission per robot."""

from collections.abc import AsyncIterator
from typing import Any

import pytest

from app.core.settings import Settings
from app.models import MessageToRobot, MissionRow, Order, Person, RobotRow, Role
from app.orders.views.schemas import NewOrder
from protocol.clock import SteppedClock
from protocol.parts import Activity, Battery
from protocol.to_server import Event, Snapshot, Step
from tests.app.placed import placed
from tests.app.robots.playing import PlayedRobot, Service, at_post, serving, until


@pytest.fixture
async def service(settings: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    async with serving(settings, clock) as service:
        yield service


async def why(service: Service, order_id: str) -> str | None:
    return str((await service.row(Order, id=order_id)).why or "") or None


async def waits_because(service: Service, order_id: str, sentence: str) -> None:
    async def says_so() -> bool:
        return await why(service, order_id) == sentence

    await until(says_so)


async def an_order(service: Service, clock: SteppedClock) -> str:
    """One after another: each a second later."""
    clock.advance(1.0)
    return await service.order("post1", "post4")


async def test_an_order_waits_with_a_reason_until_a_robot_connects(service: Service, clock: SteppedClock) -> None:
    robot = PlayedRobot(clock)
    token = await service.enrol("r1")
    order_id = await service.order()
    await waits_because(service, order_id, "No robot is connected at the moment.")
    async with robot.connected(service.url, token):
        await robot.greet()
        await robot.mission()
        await service.reaches(order_id, "assigned")
        assert await why(service, order_id) is None


async def test_verifiers_come_before_the_mission_that_needs_them(service: Service, clock: SteppedClock) -> None:
    robot = PlayedRobot(clock)
    token = await service.enrol("r1")
    async with robot.connected(service.url, token):
        await robot.greet()
        await service.order()
        await robot.mission()
        assert [(one.type, one.seq) for one in robot.heard if one.seq] == [("verifiers", 1), ("mission", 2)]


async def test_many_orders_of_one_moment_all_get_a_robot_and_no_sender_is_told_that_there_is_none(
    service: Service, clock: SteppedClock
) -> None:
    state, number = service.app.state.parts, 25
    dispatcher = Person(id="dan", email="dan@campus.example", name="Dan", roles=[Role.DISPATCHER])
    with state.feed.listening(dispatcher) as heard:
        async with state.database.transaction() as session:
            for name in range(number):
                row = RobotRow(name=f"r{name}", enrolled_at=clock.utc(), server_journal="j", post="post5")
                row.online, row.battery_ratio = True, 0.9
                session.add(row)
        await state.fleet.learning.poll()
        async with state.database.transaction() as session:
            sender = await state.sign_in_service.person(session, "sender@campus.example", clock.utc())
            for _ in range(number):
                wish = NewOrder(from_post="post1", to_post="post4", recipient="recipient@campus.example")
                await placed(state.orders, session, sender, wish)

        async def all_assigned() -> bool:
            return len(await service.rows(Order, state="assigned")) == number

        async def all_told() -> bool:
            told.extend(heard.get_nowait().happening for _ in range(heard.qsize()))
            return len([one for one in told if one.event == "order"]) >= 2 * number

        told: list[Any] = []
        await until(all_assigned)
        await until(all_told)  # a commit is seen by others a moment before it is told of
    assert [one.data().why for one in told if one.event == "order"] == [None] * 2 * number


async def test_what_waits_is_taken_along_where_it_is_on_the_way_and_only_as_much_as_a_robot_can_carry(
    service: Service, clock: SteppedClock
) -> None:
    robot = PlayedRobot(clock)
    token = await service.enrol("r1")
    first, second, third = [await an_order(service, clock) for _ in range(3)]
    async with robot.connected(service.url, token):
        await robot.greet("post1")
        mission = await robot.mission()
        assert [stop.action for stop in mission.stops] == ["load", "load", "receive", "receive"]
        assert [{stop.order_id for stop in both} for both in (mission.stops[:2], mission.stops[2:])] == [
            {first, second},
            {first, second},
        ]
        assert mission.update == 1
        await waits_because(service, third, "Every robot is busy.")
    assert await service.states(second) == ["queued", "assigned"]


async def test_a_robot_under_way_gets_one_more_order_by_the_next_update_of_its_mission(
    service: Service, clock: SteppedClock
) -> None:
    robot = PlayedRobot(clock)
    token = await service.enrol("r1")
    async with robot.connected(service.url, token):
        await robot.greet("post1")
        first = await an_order(service, clock)
        mission = await robot.mission()
        load, receive = mission.stops
        await robot.report(mission, Step.ARRIVED, load)
        await service.reaches(first, "at_sender")
        second = await service.order("post2", "post3")
        await waits_because(service, second, "Every robot is busy.")  # the sender is loading: nothing changes meanwhile
        await robot.say(robot.receipt(load))
        update = await robot.mission()
    assert (update.id, update.update) == (mission.id, 2)
    assert [stop.order_id for stop in update.stops] == [second, second, first], "post2 and post3 lie on the way"
    assert update.stops[-1] == receive
    sent = [one.body for one in robot.heard if one.type == "verifiers"]
    assert {verifier.order_id for verifier in sent[-1].verifiers} == {second}, "the codes of the new one alone"


async def test_a_robot_that_delivered_is_given_the_next_order(service: Service, clock: SteppedClock) -> None:
    robot = PlayedRobot(clock)
    token = await service.enrol("r1")
    first = await an_order(service, clock)
    async with robot.connected(service.url, token):
        await robot.greet()
        mission = await robot.mission()
        load, receive = mission.stops
        await robot.report(mission, Step.ARRIVED, load)
        await robot.say(robot.receipt(load))
        await robot.report(mission, Step.ARRIVED, receive)
        await service.reaches(first, "at_recipient")
        second = await service.order("post4", "post1")
        await waits_because(service, second, "Every robot is busy.")
        await robot.say(robot.receipt(receive))
        assert (await robot.mission()).stops[0].order_id == second
    assert await service.states(first) == [
        "queued", "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered",
    ]  # fmt: skip


async def test_a_robot_is_given_work_when_it_has_charged_enough(service: Service, clock: SteppedClock) -> None:
    robot = PlayedRobot(clock)
    token = await service.enrol("r1")
    order_id = await service.order()
    async with robot.connected(service.url, token):
        await robot.greet(battery=Battery(ratio=0.1, charging=True))
        await waits_because(service, order_id, "The free robots are charging first.")
        snapshot = Snapshot(position=at_post("post5"), activity=Activity.CHARGING, battery=Battery(ratio=0.8))
        await robot.say(snapshot)
        await robot.mission()


async def test_a_mission_decided_on_before_a_restart_reaches_the_robot_after_it_and_only_once(
    settings: Settings, clock: SteppedClock
) -> None:
    robot = PlayedRobot(clock)
    async with serving(settings, clock) as service:
        token = await service.enrol("r1")
        await service.order()
    async with serving(settings, clock) as service:
        async with robot.connected(service.url, token):
            await robot.greet()
            mission = await robot.mission()
            assert robot.socket is not None
            robot.socket.transport.abort()  # before it has stored or acknowledged anything
        robot.received = robot.received.model_copy(update={"journal": None, "seq": 0})
    async with serving(settings, clock) as service, robot.connected(service.url, token):
        await robot.greet()
        assert await robot.mission() == mission
        assert len(await service.rows(MessageToRobot, type="mission")) == 1
        assert len(await service.rows(MissionRow)) == 1


async def test_a_robot_with_mail_aboard_is_not_free_even_if_its_mission_is_over(
    service: Service, clock: SteppedClock
) -> None:
    robot = PlayedRobot(clock)
    token = await service.enrol("r1")
    await service.order()
    async with robot.connected(service.url, token):
        await robot.greet()
        mission = await robot.mission()
        load, receive = mission.stops
        await robot.say(robot.receipt(load))
        await robot.report(mission, Step.GAVE_UP, receive, reason="nobody came in 600 s")
        done: Event = robot.progress(mission, Step.DONE)
        await robot.ends(await robot.say(done))
        another = await service.order()
        await waits_because(service, another, "Every robot is busy.")
