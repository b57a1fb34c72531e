"""A dock is one robot's: two that say it is theirs are reported."""

from app.fleet.service import revoke_tokens
from app.tables import Alarm
from protocol.clock import SteppedClock
from tests.app.fleet.playing import PlayedRobot, Service


async def test_two_robots_that_would_meet_in_one_dock_are_reported(service: Service, clock: SteppedClock) -> None:
    tokens = {name: await service.enrol(name) for name in ("r1", "r2", "r3")}
    for name, home in (("r1", "post5"), ("r2", "post5"), ("r3", None)):
        robot = PlayedRobot(clock, name)
        async with robot.connected(service.url, tokens[name]):
            await robot.greet(home=home)
    (alarm,) = await service.rows(Alarm, name="same_home")
    assert alarm.robot == "r2"
    assert alarm.reason == "its home post5 is that of r1, too: give it another in its settings"
    async with service.app.state.database.transaction() as session:
        await revoke_tokens(session, clock, "r1")
    robot = PlayedRobot(clock, "r2")
    async with robot.connected(service.url, tokens["r2"]):
        await robot.greet(home="post5")  # whose home it was comes no more
    assert (await service.row(Alarm, name="same_home")).cleared_at is not None
