"""Estimates of an order under way are corrected by its outcome, and scored apart from those given when
it was placed; a restart forgets nothing of it."""

from datetime import timedelta

import pytest

from app.core.settings import Settings
from app.models import ForecastRow, ForecastUnderWayRow, Order
from fleet.eta.calibration import Basis
from fleet.eta.intervals import Interval
from protocol.clock import SteppedClock
from protocol.to_robot import Mission
from protocol.to_server import Step
from tests.app.dispatch.test_eta_updates import teach
from tests.app.robots.playing import PlayedRobot, Service, serving, until

RAW, TOLD, BY_MAP = Interval(90.0, 100.0, 110.0), Interval(80.0, 100.0, 120.0), Interval(10.0, 50.0, 90.0)


async def rows(service: Service) -> list[ForecastUnderWayRow]:
    found = await service.rows(ForecastUnderWayRow)
    return sorted(found, key=lambda row: row.is_aboard)


async def kept(service: Service, number: int) -> list[ForecastUnderWayRow]:
    async def are_there() -> bool:
        service.app.state.parts.eta_updates.wake()
        return len(await rows(service)) == number

    await until(are_there)
    return await rows(service)


async def given(service: Service, robot: PlayedRobot) -> tuple[str, Mission]:
    async def can_come() -> bool:
        await service.app.state.parts.fleet.learning.poll()
        return service.app.state.parts.estimates.ahead.reason is None

    await until(can_come)
    order_id = await service.order("post1", "post4")
    return order_id, await robot.mission()


@pytest.mark.slow
async def test_what_is_told_first_and_after_loading_is_kept_scored_and_learned_from(
    settings: Settings, clock: SteppedClock, robot: PlayedRobot
) -> None:
    async with serving(settings, clock) as service:
        estimates = service.app.state.parts.estimates
        teach(estimates, clock.utc())
        async with robot.connected(service.url, await service.enrol("r1")):
            await robot.greet("post5", home="post5")
            order_id, mission = await given(service, robot)
            load, receive = mission.stops
            (first,) = await kept(service, 1)
            order = await service.row(Order, id=order_id)
            assert abs(order.expected_to - first.told_at - timedelta(seconds=first.told_p90_s)) < timedelta(seconds=1)
            clock.advance(200.0)
            await robot.ends(await robot.report(mission, Step.ARRIVED, load))
            await robot.ends(await robot.say(robot.receipt(load)))
            _, second = await kept(service, 2)
            assert (first.is_aboard, second.is_aboard) == (False, True)
            assert second.told_at > first.told_at
            clock.advance(300.0)
            await robot.ends(await robot.report(mission, Step.ARRIVED, receive))
            arrived_at = (await service.row(ForecastRow, order_id=order_id)).arrived_at
            assert [row.arrived_at for row in await rows(service)] == [arrived_at] * 2
        scores = {basis: told.score() for basis, told in estimates.told.items()}
        assert [score and score.count for score in scores.values()] == [1, 2]
        errors = {basis: told.calibration for basis, told in estimates.told.items()}
    async with serving(settings, clock) as service:
        again = service.app.state.parts.estimates.told
        assert {basis: told.score() for basis, told in again.items()} == scores
        assert {basis: told.calibration for basis, told in again.items()} == errors


async def test_a_forecast_is_put_right_by_what_came_of_earlier_ones(
    service: Service, clock: SteppedClock, robot: PlayedRobot
) -> None:
    """Robots always came later than the schedule had it, by four of the widths that it gave."""
    estimates = service.app.state.parts.estimates
    teach(estimates, clock.utc())
    for _ in range(200):
        estimates.told[Basis.UNDER_WAY].arrived(RAW, TOLD, BY_MAP, RAW.p50_s + 4 * (RAW.p90_s - RAW.p50_s))
    async with robot.connected(service.url, await service.enrol("r1")):
        await robot.greet("post5", home="post5")
        order_id, _ = await given(service, robot)
        (row,) = await kept(service, 1)
        assert row.told_p50_s > row.raw_p90_s
        order = await service.row(Order, id=order_id)
        assert order.expected_from > row.told_at + timedelta(seconds=row.raw_p90_s)
    assert estimates.told[Basis.PLACED].score() is None
