"""Where a robot stands that has left a corridor since it was last seen, for a schedule that is made anew."""

from dataclasses import replace
from datetime import timedelta

from app.core.settings import Settings
from app.models import GrantRow, RobotRow
from app.traffic.robot_locations import read_traffic, where_they_left
from maps import corridor_name
from protocol.clock import SteppedClock
from tests.app.robots.playing import serving

WAY, BESIDES = ("post2", "post3"), ("post2", "post1")


async def test_a_robot_stands_where_it_cleared_last_and_not_what_it_was_granted_last(
    settings: Settings, clock: SteppedClock
) -> None:
    """It did not know which way it looked: what it might have entered besides was cleared as soon as it set out."""
    granted_at = clock.utc()
    cleared = {WAY: (timedelta(seconds=20), "post3"), BESIDES: (timedelta(seconds=8), "post2")}
    async with serving(settings, clock) as service:
        await service.enrol("r1")
        async with service.app.state.parts.database.transaction() as session:
            row = await session.get(RobotRow, "r1")
            row.post, row.seen_at = "post2", granted_at
            for (from_post, to_post), (after, left_at) in cleared.items():
                grant = GrantRow(
                    robot="r1",
                    claim_id="c1",
                    corridor=corridor_name(from_post, to_post),
                    from_post=from_post,
                    to_post=to_post,
                    granted_at=granted_at,
                    cleared_at=granted_at + after,
                    left_at=left_at,
                )
                session.add(grant)
                await session.flush()
        async with service.app.state.parts.database.reading() as session:
            seen = await read_traffic(session, service.app.state.parts.campus)
            left = await where_they_left(session, seen)
    assert left.robots["r1"] == replace(seen.robots["r1"], post="post3")
