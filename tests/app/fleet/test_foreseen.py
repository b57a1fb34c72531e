"""People see when the robot will be there as the timetable has it, once the service knows how long things take."""

from datetime import UTC, datetime, timedelta

import pytest

from app.estimates.arrivals import ENOUGH, Estimates
from app.estimates.durations import Kind, Thing
from app.estimates.intervals import Interval
from app.fleet.foreseen import window_of
from app.fleet.timetable import network_for
from app.settings import Settings
from app.tables import Order
from maps import builtin_map, shortest_route
from maps.ways import Ways
from protocol.clock import SteppedClock
from tests.app.fleet.playing import PlayedRobot, Service, serving, until

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


async def window(service: Service, order_id: str) -> tuple[datetime, datetime]:
    order: Order = await service.row(Order, id=order_id)
    assert order.window_from is not None
    assert order.window_to is not None
    return order.window_from, order.window_to


async def test_the_window_of_an_order_that_a_robot_has_is_that_of_the_timetable(
    settings: Settings, clock: SteppedClock
) -> None:
    robot = PlayedRobot(clock)
    async with serving(settings.model_copy(update={"traffic": "timetable"}), clock) as service:
        state = service.app.state
        token = await service.enrol("r1")
        async with robot.connected(service.url, token):
            await robot.greet("post5", home="post5")
            order_id = await service.order("post1", "post4")
            await robot.mission()
            await service.reaches(order_id, "assigned")
            told = await window(service, order_id)
            await state.foreseen.look()
            assert await window(service, order_id) == told, "nothing was learned yet"
            teach(state.orders.estimates, clock.utc())

            async def is_planned() -> bool:
                timetable = state.traffic_desk.timetable
                return timetable is not None and len(timetable.controller.goals("r1")) == 2

            await until(is_planned)
            await state.foreseen.look()
            foreseen = await window(service, order_id)
    campus = state.campus
    ways = shortest_route(campus, "post5", "post1").posts[1:], shortest_route(campus, "post1", "post4").posts[1:]
    comes_at = clock.utc() + timedelta(seconds=sum(map(len, ways)) * CORRIDOR_S + HANDOVER_S)
    assert foreseen != told
    assert foreseen[0] <= comes_at + timedelta(seconds=5)
    assert foreseen[1] >= comes_at - timedelta(seconds=5)
    assert foreseen[1] - foreseen[0] < (told[1] - told[0]) / 2
    assert foreseen[1] <= told[1]


def test_the_timetable_counts_with_what_corridors_take_and_with_their_lengths_until_that_is_known() -> None:
    settings, campus = Settings(), builtin_map("test_track")
    estimates = Estimates(Ways(campus), settings.assumed_speed_m_s, settings.assumed_handover_s)
    assert network_for(campus, settings, estimates).lanes == network_for(campus, settings).lanes
    teach(estimates, NOW)
    learned = [lane.travel_s for out in network_for(campus, settings, estimates).lanes for lane in out]
    assert learned == [pytest.approx(CORRIDOR_S, rel=0.02)] * len(learned)
    assert learned


@pytest.mark.parametrize(
    ("promised_s", "wanted_s"),
    [(None, (60.0, 120.0)), (300.0, (60.0, 120.0)), (90.0, (60.0, 90.0)), (50.0, None)],
)
def test_no_promise_is_made_later_by_and_by(promised_s: float | None, wanted_s: tuple[float, float] | None) -> None:
    promised_to = None if promised_s is None else NOW + timedelta(seconds=promised_s)
    found = window_of(Interval(60.0, 80.0, 120.0), promised_to, NOW)
    assert found == (None if wanted_s is None else tuple(NOW + timedelta(seconds=s) for s in wanted_s))
