"""A robot's measured energy use decides which orders it gets: learned at the start, from kept records."""

from datetime import datetime, timedelta

from app.core.settings import Settings
from app.dispatch.charge_limits import Charges
from app.dispatch.open_work import RobotNow
from app.models import BatterySample, GrantRow
from app.robots.energy_use import usual_rates
from maps import corridor_name
from protocol.clock import SteppedClock
from tests.app.robots.playing import serving

LEG_S = 600
THIRSTY = 1.8
"""So many times what is assumed."""


def lived(robot: str, begin: datetime, settings: Settings, length_m: float) -> list[BatterySample | GrantRow]:
    """Days of one corridor after the other, each with a rest in a dock when it is low: a sample each minute."""
    rates = usual_rates()
    per_minute = THIRSTY * (rates.per_m * length_m / LEG_S + rates.per_s) * 60
    rows: list[BatterySample | GrantRow] = []
    ratio, charging, at = 1.0, False, begin
    for minute in range(2000):
        at += timedelta(minutes=1)
        charging = (charging and ratio < 0.95) or ratio < 0.3
        ratio += 0.02 if charging else -per_minute
        rows.append(BatterySample(robot=robot, at=at, ratio=ratio, charging=charging))
        if minute % (LEG_S // 60) == 0 and not charging:
            rows.append(driven(robot, at))
    return rows


def driven(robot: str, at: datetime, left_at: str = "post2", freed_by: str | None = None) -> GrantRow:
    return GrantRow(
        robot=robot,
        claim_id="c",
        corridor=corridor_name("post1", "post2"),
        from_post="post1",
        to_post="post2",
        granted_at=at - timedelta(seconds=LEG_S),
        cleared_at=at,
        left_at=left_at,
        freed_by=freed_by,
    )


def rested(name: str) -> RobotNow:
    can = {"is_there": True, "takes_work": True, "gives_away": False, "has_stopped": False}
    return RobotNow(name, "post5", 0.6, charging=False, docked=False, home="post5", held_up=None, **can)


async def test_after_a_restart_a_robot_that_spends_more_than_others_is_known_and_given_less(
    settings: Settings, clock: SteppedClock
) -> None:
    async with serving(settings, clock) as service:
        await service.enrol("thirsty")
        await service.enrol("new")
        campus = service.app.state.parts.campus
        length_m = campus.corridor("post1", "post2").length_m
        async with service.app.state.parts.database.transaction() as session:
            session.add_all(lived("thirsty", clock.utc() - timedelta(days=2), settings, length_m))
            # Neither was driven to its end: turned back, and taken back by a person.
            session.add(driven("thirsty", clock.utc() - timedelta(days=1), left_at="post1"))
            session.add(driven("thirsty", clock.utc() - timedelta(days=1), freed_by="command"))
    async with serving(settings, clock) as service:
        fleet = service.app.state.parts.fleet
        learned = fleet.spending.rates["thirsty"]
        assert learned.stretches > 10
        assert abs(learned.standing - THIRSTY) < 0.2
        assert fleet.spending.rates["new"] == usual_rates()
        charges = Charges(fleet.orders.ledger.ways, settings, fleet.spending.rates)
        needed = {name: charges.needed(rested(name), ["post1", "post4"]) for name in fleet.spending.rates}
        assert needed["thirsty"] > needed["new"]
        assert charges.drives_s(rested("thirsty")) < charges.drives_s(rested("new"))
