"""Messages of many robots are taken in together, in each robot's order; a failure affects one robot alone."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from sqlalchemy import Engine, event

from app.models import Alarm, MessageToRobot, OrderEvent, RobotMessage, RobotRow
from protocol.both_ways import Ack, Error
from protocol.clock import SteppedClock
from protocol.parts import Activity, Battery, Leg, Position
from protocol.to_server import Clear, Snapshot, Step
from tests.app.robots.playing import PlayedRobot, Service, until

LEG = Leg(from_post="post1", to_post="post2")


async def test_what_waits_is_taken_in_order_and_acknowledged_together(service: Service, clock: SteppedClock) -> None:
    robots = [PlayedRobot(clock, name=name, journal=f"journal-{name}") for name in ("r1", "r2")]
    tokens = [await service.enrol(robot.name) for robot in robots]
    async with robots[0].connected(service.url, tokens[0]), robots[1].connected(service.url, tokens[1]):
        for robot in robots:
            await robot.greet()
        async with service.app.state.parts.database.transaction():  # meanwhile nothing can be committed
            for _ in range(20):
                for robot in robots:
                    await robot.say(Clear(leg=LEG))
            assert await service.rows(RobotMessage) == []
        for robot in robots:
            await robot.ends(20)
    for robot in robots:
        assert sum(one.type == "ack" for one in robot.heard) < 10, "one acknowledgement stands for many"
        kept = [row.seq for row in await service.rows(RobotMessage, robot=robot.name)]
        assert kept == list(range(1, 21))


async def test_a_robot_that_fails_holds_up_no_other(service: Service, clock: SteppedClock) -> None:
    """One speaks of a mission that is not its own, one leaves out a number, one delivers: all at the same moment."""
    good, stranger, gap = (PlayedRobot(clock, name=name, journal=f"journal-{name}") for name in ("r1", "r2", "r3"))
    tokens = [await service.enrol(name) for name in ("r1", "r2", "r3")]
    order_id = await service.order()
    async with good.connected(service.url, tokens[0]):
        await good.greet()
        mission = await good.mission()
        async with stranger.connected(service.url, tokens[1]), gap.connected(service.url, tokens[2]):
            await stranger.greet()
            await gap.greet()
            async with service.app.state.parts.database.transaction():
                await good.report(mission, Step.DEPARTED, mission.stops[0])
                await stranger.report(mission, Step.ARRIVED, mission.stops[0])
                await gap.say(Clear(leg=LEG), seq=7)
                await good.report(mission, Step.ARRIVED, mission.stops[0])
                last = await good.say(good.receipt(mission.stops[0]))
                await stranger.say(Clear(leg=LEG))
            await good.ends(last)
            refused = await stranger.hear("error")
            assert (refused.body.model_dump()["code"], refused.ack >= 1) == ("unknown_mission", True), "taken, in vain"
            assert (await gap.hear("error")).body.model_dump()["code"] == "message_gap"
            assert await gap.close_code() == 4400
    assert await service.states(order_id) == ["queued", "assigned", "to_sender", "at_sender", "carrying"]
    assert [event.robot for event in await service.rows(OrderEvent, order_id=order_id)].count("r2") == 0
    kept = [(row.robot, row.seq) for row in await service.rows(RobotMessage)]
    assert sorted(kept) == [("r1", 1), ("r1", 2), ("r1", 3), ("r2", 1), ("r2", 2)]
    assert {row.robot for row in await service.rows(Alarm, name="unknown_mission")} == {"r2"}


@contextmanager
def transactions_of(statement: str) -> Iterator[list[Any]]:
    """Collect how each transaction was begun that ran a statement beginning like this."""
    begun: list[Any] = []

    def note(connection: Any, _cursor: Any, said: str, *_: Any) -> None:
        if said.startswith(statement):
            begun.append(connection.get_execution_options()["begin"])

    event.listen(Engine, "before_cursor_execute", note)
    try:
        yield begun
    finally:
        event.remove(Engine, "before_cursor_execute", note)


async def test_what_a_robot_complains_of_rings_an_alarm_that_survives_a_power_cut(
    service: Service, robot: PlayedRobot
) -> None:
    """An error has no number and is not said again; a snapshot is, and waits for no disk."""
    durably = service.app.state.parts.database.writing.get_execution_options()["begin"]
    async with robot.connected(service.url, await service.enrol("r1")):
        await robot.greet()
        with transactions_of("INSERT INTO alarms") as begun:
            await robot.say(Error(code="map_unreadable", message="The map cannot be read."))
            await until(lambda: service.rows(Alarm, name="robot_reports_error"))
        assert begun == [durably]
        with transactions_of("UPDATE robots") as begun:
            await robot.say(
                Snapshot(position=Position(post="post2"), battery=Battery(ratio=0.5), activity=Activity.IDLE)
            )
            await until(lambda: service.rows(RobotRow, name="r1", battery_ratio=0.5))
        assert begun and durably not in begun


async def test_that_a_robot_has_what_it_was_told_wakes_nobody(service: Service, robot: PlayedRobot) -> None:
    """Each message would be followed by a look at everything; what the robot says of itself is."""
    woken: list[str] = []
    async with robot.connected(service.url, await service.enrol("r1")):
        await robot.greet()
        await service.order()
        await robot.mission()
        service.app.state.parts.fleet.on_change.append(woken.append)
        await robot.say(Ack())

        async def is_noted() -> bool:
            return all(row.acked_at is not None for row in await service.rows(MessageToRobot, robot="r1"))

        async def is_woken() -> bool:
            return bool(woken)

        await until(is_noted)
        await robot.say(Clear(leg=LEG))
        await until(is_woken)
        assert len(await service.rows(RobotMessage, robot="r1")) == 1, "by what it has said, not before"
        assert woken == ["r1"]
