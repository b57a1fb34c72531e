"""Who goes by the schedule looks again when it has changed, and not whenever it was looked at."""

from typing import Any

from app.composition import create_app
from app.composition.parts import Parts
from app.core.database.schema_version import bring_to_head
from app.core.settings import Settings
from app.models import ClaimRow, RobotRow
from protocol.clock import SteppedClock


async def looked_again(parts: Parts, **told: Any) -> int:
    """After the robot has told this: how often a listener was notified."""
    news: list[bool] = []
    traffic = parts.traffic_service
    assert traffic is not None
    async with parts.database.transaction() as session:
        robot = await session.get(RobotRow, "r1")
        if robot is None:
            robot = RobotRow(name="r1", enrolled_at=parts.clock.utc(), server_journal="j", online=True, home="post5")
            session.add(robot)
        for name, value in told.items():
            setattr(robot, name, value)
    traffic.on_poll[:] = [lambda: news.append(True)]
    await traffic.poll()
    return len(news)


async def test_that_time_has_passed_and_a_robot_was_heard_is_no_news(settings: Settings, clock: SteppedClock) -> None:
    parts: Parts = create_app(settings, clock).state.parts
    await bring_to_head(parts.database)
    assert await looked_again(parts, post="post5", docked=True, heard_at=clock.utc()) == 1, "it is new"
    clock.advance(5.0)
    assert await looked_again(parts, heard_at=clock.utc()) == 0
    assert await looked_again(parts, docked=False) == 1
    assert await looked_again(parts, post="post4", seen_at=clock.utc()) == 1
    async with parts.database.transaction() as session:
        legs = [{"from_post": "post4", "to_post": "post3"}]
        session.add(ClaimRow(robot="r1", claim_id="c1", legs=legs, at=clock.utc(), goal="post3"))
    assert await looked_again(parts) == 1, "it was let in"
    clock.advance(5.0)
    assert await looked_again(parts) == 1, "it holds a corridor now"
    assert await looked_again(parts) == 0
    clock.advance(settings.vanished_after_s + 1)
    assert await looked_again(parts, online=False) == 1, "it has fallen silent"
    assert await looked_again(parts) == 0
    await parts.database.close()
