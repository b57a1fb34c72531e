"""Estimates of orders that a robot has: where the schedule has it there, renewed with each step, and never over."""

from collections.abc import AsyncIterator
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest

from app.core.settings import Settings
from app.dispatch.eta_updates import is_otherwise
from app.models import Order, Person, RobotRow
from app.traffic.schedule import network_for
from fleet.eta.arrivals import ENOUGH, Estimates
from fleet.eta.durations import Kind, Thing
from maps import shortest_route
from maps.ways import Ways
from protocol.clock import Clock, SteppedClock
from protocol.parts import Activity, Battery, Position
from protocol.to_robot import Mission
from protocol.to_server import Snapshot, Step, Why
from tests.app.robots.playing import PlayedRobot, Service, until
from tests.plain_maps import plain_map

CORRIDOR_S, HANDOVER_S = 40.0, 30.0
NOW = datetime(2026, 1, 5, 12, tzinfo=UTC)


def teach(estimates: Estimates, now: datetime) -> None:
    """Every corridor always takes as long, and every hand-over."""
    posts = estimates.ways.campus.posts
    ways = [estimates.corridor(a, post.name) for a in posts for post, _ in estimates.ways.campus.neighbours(a)]
    stops = [estimates.stop(kind, now) for kind in (Kind.LOAD, Kind.RECEIVE)]
    for thing in (*ways, *stops, Thing(Kind.FETCH, "queue 0", 60.0)):
        assert thing is not None
        seconds = CORRIDOR_S if thing.kind is Kind.CORRIDOR else HANDOVER_S
        for _ in range(20 * ENOUGH):
            estimates.durations.observe(thing, seconds)


async def order_of(service: Service, order_id: str) -> Order:
    order: Order = await service.row(Order, id=order_id)
    return order


async def expected(service: Service, order_id: str) -> tuple[datetime, datetime] | None:
    """As the row has it, which is the one place where it lies."""
    order = await order_of(service, order_id)
    return (order.expected_from, order.expected_to) if order.expected_from and order.expected_to else None


@pytest.fixture
async def robot(service: Service, clock: SteppedClock) -> AsyncIterator[PlayedRobot]:
    robot = PlayedRobot(clock)
    async with robot.connected(service.url, await service.enrol("r1")):
        await robot.greet("post5", home="post5")
        await until(lambda: can_come(service))
        yield robot


async def can_come(service: Service) -> bool:
    """Return whether promises are based on the durations learned."""
    await service.app.state.parts.fleet.learning.poll()
    return service.app.state.parts.estimates.ahead.reason is None


async def given(service: Service, robot: PlayedRobot) -> tuple[str, Mission]:
    order_id = await service.order("post1", "post4")
    mission = await robot.mission()
    await service.reaches(order_id, "assigned")

    async def is_planned() -> bool:
        desk = service.app.state.parts.traffic_service
        return desk.schedule is not None and len(desk.schedule.controller.goals("r1")) == 2

    await until(is_planned)
    await until(lambda: is_not_over(service, order_id, robot.clock))
    return order_id, mission


async def test_an_order_that_a_robot_has_is_expected_when_its_way_ends(
    service: Service, robot: PlayedRobot, clock: SteppedClock
) -> None:
    teach(service.app.state.parts.estimates, clock.utc())
    order_id, _ = await given(service, robot)
    campus = service.app.state.parts.campus
    ways = shortest_route(campus, "post5", "post1").posts[1:], shortest_route(campus, "post1", "post4").posts[1:]
    comes_at = clock.utc() + timedelta(seconds=sum(map(len, ways)) * CORRIDOR_S + HANDOVER_S)

    async def is_foreseen() -> bool:
        begins_at, ends_at = await expected(service, order_id) or (NOW, NOW)
        slack = timedelta(seconds=10)
        return begins_at - slack <= comes_at <= ends_at + slack and ends_at - begins_at < timedelta(seconds=120)

    await until(is_foreseen)


async def test_it_is_renewed_with_what_is_learned_on_the_way_and_the_promise_is_kept_beside_it(
    service: Service, robot: PlayedRobot, clock: SteppedClock
) -> None:
    """The robot needs far longer than anybody thought: at no step is the interval over."""
    order_id, mission = await given(service, robot)
    promised = (await order_of(service, order_id)).window_to
    load, receive = mission.stops
    for at, (step, stop, post) in enumerate(
        [
            (Step.DEPARTED, load, "post5"),
            (Step.PASSED, load, "post3"),
            (Step.PASSED, load, "post2"),
            (Step.ARRIVED, load, "post1"),
        ]
    ):
        clock.advance(100.0 * at)
        await robot.ends(await robot.report(mission, step, stop, post=post))
        towards = {"post5": "post3", "post3": "post2", "post2": "post1"}.get(post)
        await is_seen(robot, post, towards)
        await until(lambda: is_not_over(service, order_id, clock))
    await robot.ends(await robot.say(robot.receipt(load)))
    await until(lambda: is_not_over(service, order_id, clock))
    order = await order_of(service, order_id)
    assert (order.state, order.window_to) == ("carrying", promised)
    assert order.expected_to is not None
    assert promised is not None
    assert order.expected_to > promised, "what comes later is said, and the promise is not rewritten by it"
    await robot.ends(await robot.report(mission, Step.DEPARTED, receive, post="post1"))


async def is_seen(robot: PlayedRobot, post: str, towards: str | None) -> None:
    position = Position(post=post, towards=towards, seen_at=robot.clock.utc())
    activity = Activity.DRIVING if towards else Activity.WAITING
    await robot.say(Snapshot(position=position, activity=activity, battery=Battery(ratio=0.8)))


async def is_not_over(service: Service, order_id: str, clock: Clock) -> bool:
    known = await expected(service, order_id)
    return known is not None and known[1] > clock.utc()


async def test_a_robot_that_waits_for_help_has_no_time_and_says_why(service: Service, robot: PlayedRobot) -> None:
    order_id, _ = await given(service, robot)
    await robot.say(Why(sentence="Something blocks a wheel."))
    await robot.say(Snapshot(position=Position(post="post5"), activity=Activity.STOPPED, battery=Battery(ratio=0.8)))

    async def is_unknown() -> bool:
        return await expected(service, order_id) is None

    await until(is_unknown)
    seen = await view(service, order_id)
    assert (seen["window"], seen["estimate"]["to"]) == (None, None)
    assert seen["estimate"]["reason"] == "Something blocks a wheel."
    assert seen["estimate"]["promised_to"] is not None


async def test_why_it_waits_is_never_another_orders_stop(service: Service, robot: PlayedRobot) -> None:
    order_id, _ = await given(service, robot)
    await robot.say(Why(sentence="Waiting for the recipient at post3"))
    await is_seen(robot, "post3", None)

    async def is_told() -> bool:
        (row,) = await service.rows(RobotRow)
        return bool(row.why and row.activity == Activity.WAITING)

    await until(is_told)
    seen = await view(service, order_id)
    assert seen["why"] == seen["robot"]["why"] == seen["estimate"]["reason"] == "The robot serves another stop first."
    assert "post3" not in str({**seen, "robot": {**seen["robot"], "last_seen": None}}), "only where the robot was seen"


async def view(service: Service, order_id: str) -> dict[str, Any]:
    """As its sender sees it."""
    state = service.app.state.parts
    async with state.database.reading() as session:
        order = await session.get(Order, order_id)
        sender = await session.get_one(Person, order.sender_id)
        return (await state.orders.view(session, sender, order_id)).model_dump(mode="json", by_alias=True)


def test_the_schedule_counts_with_what_corridors_take_and_with_their_lengths_until_that_is_known() -> None:
    settings, campus = Settings(), plain_map("test_track")
    estimates = Estimates(Ways(campus), settings.assumed_speed_m_s, settings.assumed_handover_s)
    assert network_for(campus, settings, estimates).lanes == network_for(campus, settings).lanes
    teach(estimates, NOW)
    learned = [lane.travel_s for out in network_for(campus, settings, estimates).lanes for lane in out]
    assert learned == [pytest.approx(CORRIDOR_S, rel=0.02)] * len(learned)
    assert learned


@pytest.mark.parametrize(
    ("before_s", "becomes_s", "is_news"),
    [
        (None, None, False),
        (None, (60, 120), True),
        ((60, 120), None, True),
        ((600, 1200), (615, 1215), False),
        ((600, 1200), (640, 1200), True),
        ((10, 20), (20, 30), True),
        ((-30, 1), (-20, 4), True),
    ],
)
def test_people_hear_of_what_is_otherwise_by_enough(
    before_s: tuple[int, int] | None, becomes_s: tuple[int, int] | None, is_news: bool
) -> None:
    before, becomes = [
        None if one is None else (NOW + timedelta(seconds=one[0]), NOW + timedelta(seconds=one[1]))
        for one in (before_s, becomes_s)
    ]
    assert is_otherwise(before, becomes, NOW) is is_news
