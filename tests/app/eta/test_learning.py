"""The service learns durations from robots' reports: people are told, those who look after robots see how good
it is, and a restart forgets nothing."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.accounts.sign_in.service import set_roles
from app.core.settings import Settings
from app.models import DurationRow, ForecastRow, Order, Role
from fleet.eta.arrivals import ENOUGH, SETS_OUT_S, Ahead, Estimates, FreeRobot
from fleet.eta.calibration import Basis
from fleet.eta.durations import Kind, Thing
from fleet.eta.intervals import Interval
from maps import shortest_route
from maps.ways import Ways
from protocol.clock import SteppedClock
from protocol.parts import Leg, Stop
from protocol.to_robot import Mission
from protocol.to_server import Step
from tests.app.conftest import HERE, SENDER, Browser, Mailroom
from tests.app.robots.playing import PlayedRobot, Service, serving
from tests.plain_maps import plain_map

TRACK = plain_map("test_track")
FROM, TO = "post1", "post4"
NOWHERE = Thing(Kind.CORRIDOR, "nowhere", 1.0)
CORRIDOR_S, HANDED_OVER_S = 40.0, 25.0


def estimates_of(service: Service) -> Estimates:
    estimates: Estimates = service.app.state.parts.estimates
    return estimates


class Carrier:
    """A robot that carries one order after the other, always as fast."""

    def __init__(self, robot: PlayedRobot, clock: SteppedClock, at: str) -> None:
        self.robot, self.clock, self.at = robot, clock, at

    async def deliver(self, service: Service) -> str:
        # The service looks now and then how many orders wait: by chance it would still count the one just delivered.
        await service.app.state.parts.fleet.learning.poll()
        order_id = await service.order(FROM, TO)
        mission = await self.robot.mission()
        for stop in mission.stops:
            await self.drive(mission, stop)
            self.clock.advance(HANDED_OVER_S)
            await self.robot.ends(await self.robot.say(self.robot.receipt(stop)))
            await self.robot.report(mission, Step.DONE, stop)
        await self.robot.ends(await self.robot.report(mission, Step.DONE))
        return order_id

    async def drive(self, mission: Mission, stop: Stop) -> None:
        await self.robot.report(mission, Step.DEPARTED, stop, post=self.at)
        for post in shortest_route(TRACK, self.at, stop.post).posts[1:]:
            self.clock.advance(CORRIDOR_S)
            step = Step.ARRIVED if post == stop.post else Step.PASSED
            await self.robot.ends(await self.robot.report(mission, step, stop, post=post))
        if self.at == stop.post:
            await self.robot.ends(await self.robot.report(mission, Step.ARRIVED, stop))
        self.at = stop.post


@pytest.mark.nightly
async def test_what_robots_did_is_what_people_are_told_and_a_restart_forgets_nothing(
    settings: Settings, clock: SteppedClock, robot: PlayedRobot
) -> None:
    async with serving(settings, clock) as service:
        token = await service.enrol("r1")
        async with robot.connected(service.url, token):
            await robot.greet(TO)
            carrier = Carrier(robot, clock, TO)
            orders = [await carrier.deliver(service) for _ in range(ENOUGH + 1)]
        first, last = [await service.row(Order, id=order_id) for order_id in (orders[0], orders[-1])]
        assert (first.window_assumed, last.window_assumed) == (True, False)
        arrived_at = (await service.row(ForecastRow, order_id=last.id)).arrived_at
        assert last.window_from <= arrived_at <= last.window_to, "it came when people were told"
        assert last.window_to - last.window_from < (first.window_to - first.window_from) / 2
        learned = estimates_of(service)
        assert learned.durations.seen(Kind.LOAD, learned.hours(clock.utc())) == len(orders)
        before = [
            (thing, learned.durations.quantile_s(thing, 0.5), learned.durations.seen(thing.kind, thing.name))
            for thing in learned.things()
        ]
        assert {seconds for thing, seconds, _ in before if thing.kind is Kind.CORRIDOR} == {CORRIDOR_S}
        assert {seconds for thing, seconds, _ in before if thing.kind is Kind.LOAD} == {HANDED_OVER_S}
        score = learned.told[Basis.PLACED].score()
    async with serving(settings, clock) as service:
        again = estimates_of(service)
        after = [
            (thing, again.durations.quantile_s(thing, 0.5), again.durations.seen(thing.kind, thing.name))
            for thing in again.things()
        ]
        assert (after, again.told[Basis.PLACED].score(), again.is_assumed) == (before, score, False)


async def test_what_a_robot_waited_before_it_was_let_in_or_stood_at_a_stop_is_no_driving(
    service: Service, robot: PlayedRobot, clock: SteppedClock
) -> None:
    await service.order(FROM, TO)
    here, passed = shortest_route(TRACK, TO, FROM).posts[:2]
    async with robot.connected(service.url, await service.enrol("r1")):
        await robot.greet(TO)
        mission = await robot.mission()
        stop = mission.stops[0]
        await robot.ends(await robot.report(mission, Step.DEPARTED, stop, post=TO))
        clock.advance(200.0)
        learning = service.app.state.parts.fleet.learning
        learning.let_in("r1", [Leg(from_post=here, to_post=passed)], clock.utc())
        clock.advance(CORRIDOR_S)
        await robot.ends(await robot.report(mission, Step.PASSED, stop, post=passed))
    (row,) = await service.rows(DurationRow, kind="corridor")
    assert (row.name, row.seconds) == (f"{here} {passed}", CORRIDOR_S)


def test_the_more_wait_the_later_it_is_said_to_come(mailroom: Mailroom, sender: Browser) -> None:
    estimates: Estimates = mailroom.app.state.parts.estimates
    now = mailroom.app.state.parts.clock.utc()
    comes_s = []
    for orders in (0, 3, 12):
        estimates.ahead = Ahead(orders, 2)
        comes_s.append(estimates.promise(FROM, TO, now).raw.p50_s)
    assert comes_s == sorted(comes_s)
    assert comes_s[2] > 2 * comes_s[0]
    assert estimates.promise(FROM, TO, now).assumed, "but no person is told before enough was seen"


def test_where_robots_are_planned_for_the_first_that_can_be_there_counts() -> None:
    now = datetime(2026, 1, 5, 14, 0, tzinfo=UTC)
    estimates = Estimates(Ways(TRACK), 0.15, 120.0)
    way_s = Ways(TRACK).length_m(TO, FROM) / 0.15
    in_an_hour, here_later, there_now = (
        FreeRobot(now + timedelta(hours=1), FROM),
        FreeRobot(now + timedelta(seconds=way_s + 10.0), FROM),
        FreeRobot(now - timedelta(hours=1), TO),
    )
    comes_s = []
    for free in ([in_an_hour], [in_an_hour, here_later], [in_an_hour, here_later, there_now]):
        estimates.free = free
        comes_s.append(estimates.fetching(FROM, now).assumed_s - SETS_OUT_S)
    assert comes_s == pytest.approx([3600.0, way_s + 10.0, way_s])
    estimates.free = [in_an_hour]
    assert estimates.fetching(FROM, now + timedelta(hours=2)) == Thing(Kind.FETCH, "planned, queue 0", SETS_OUT_S)


def test_robots_that_cannot_come_do_not_count() -> None:
    now = datetime(2026, 1, 5, 14, 0, tzinfo=UTC)
    estimates = Estimates(Ways(TRACK), 0.15, 120.0)
    by_the_queue = estimates.fetching(FROM, now)
    estimates.free = [FreeRobot(now, "a post of another map")]
    assert estimates.fetching(FROM, now) == by_the_queue and by_the_queue.name == "queue 0"


def test_office_hours_are_the_campuss_own() -> None:
    estimates = Estimates(Ways(TRACK), 0.15, 120.0, ZoneInfo("America/Toronto"))
    monday = datetime(2026, 1, 5, 14, 0, tzinfo=UTC)  # nine in the morning there
    hours = [estimates.hours(monday + timedelta(hours=later)) for later in (-2, 0, 10, 5 * 24)]
    assert hours == ["other hours", "office hours", "other hours", "other hours"]
    early = replace(estimates, office_hours=Settings(office_hours="7-9").hours_of_offices)
    hours = [early.hours(monday + timedelta(hours=later)) for later in (-2, 0, 10, 5 * 24)]
    assert hours == ["office hours", "other hours", "other hours", "other hours"]


def test_those_who_look_after_robots_see_how_good_it_is_and_so_does_prometheus(
    sender: Browser, mailroom: Mailroom, anonymous: TestClient
) -> None:
    estimates: Estimates = mailroom.app.state.parts.estimates
    mailroom.call(make_dispatcher, mailroom.app)
    seen = sender.get("/api/v1/estimates").json()
    assert (seen["assumed"], seen["inside_meant"]) == (True, 0.8)
    assert seen["placed"] == seen["under_way"] == dict.fromkeys(seen["placed"]) | {"scored": 0}
    estimates.durations.observe(estimates.corridor("post1", "post2") or NOWHERE, 30.0)
    for took_s in (100.0, 150.0, 400.0):
        told = estimates.told[Basis.PLACED]
        told.arrived(*[Interval(90.0, 100.0, 200.0)] * 2, Interval(10.0, 50.0, 90.0), took_s)
    estimates.told[Basis.UNDER_WAY].arrived(*[Interval(90.0, 100.0, 200.0)] * 3, 100.0)
    seen = sender.get("/api/v1/estimates").json()
    placed, under_way = seen["placed"], seen["under_way"]
    assert (placed["scored"], placed["inside_ratio"], placed["later_ratio"]) == pytest.approx((3, 2 / 3, 1 / 3))
    assert (under_way["scored"], under_way["inside_ratio"]) == (1, 1.0)
    assert placed["told"]["median_error_ratio"] == pytest.approx(1 / 3)
    assert placed["told"]["pinball_s"] < placed["by_map"]["pinball_s"]
    (way,) = seen["durations"]
    assert (way["from_post"], way["to_post"], way["seen"]) == ("post1", "post2", 1)
    here = TestClient(mailroom.app, base_url=HERE, client=("127.0.0.1", 50000))
    here.portal = anonymous.portal
    figures = here.get("/metrics").text
    assert 'campus_mail_estimates_scored{basis="placed"} 3.0' in figures
    assert 'campus_mail_estimates_median_error_ratio{basis="placed",by="told"} 0.3333' in figures


async def make_dispatcher(app: FastAPI) -> None:
    async with app.state.parts.database.transaction() as session:
        person = await app.state.parts.sign_in_service.person(session, SENDER, app.state.parts.clock.utc())
        set_roles(person, {Role.DISPATCHER}, set())
