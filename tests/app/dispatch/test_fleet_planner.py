"""The planner in the running service: orders of all robots decided together, and moved only before they have begun."""

import asyncio
from collections.abc import AsyncIterator, Sequence
from contextlib import AsyncExitStack
from dataclasses import replace
from datetime import timedelta
from itertools import permutations

import pytest

from app.core.settings import Settings
from app.dispatch.given_out import changes_of, give_out
from app.models import MissionRow, Order, Priority, RobotRow
from app.orders.views.schemas import NewOrder
from fleet.assignment.deciding import Decision
from fleet.assignment.problem import Routes
from fleet.assignment.routes import room
from fleet.eta.arrivals import SETS_OUT_S, FreeRobot
from fleet.schedule.planning import plan
from protocol.clock import SteppedClock
from protocol.parts import Activity, Battery
from protocol.to_robot import Cancel
from protocol.to_server import CommandAnswer, Event, Snapshot, Step
from tests.app.placed import placed
from tests.app.robots.playing import PlayedRobot, Service, at_post, serving, until


@pytest.fixture
async def service(settings: Settings, clock: SteppedClock) -> AsyncIterator[Service]:
    async with serving(settings, clock) as service:
        yield service


@pytest.fixture
async def robots(service: Service, clock: SteppedClock) -> AsyncIterator[tuple[PlayedRobot, PlayedRobot]]:
    """r1 at post1, at home at post5, and r2 at post4, which tells no home: it is planned for as if it were, too."""
    async with AsyncExitStack() as stack:
        first, second = (PlayedRobot(clock, name) for name in ("r1", "r2"))
        for robot, post, home in ((first, "post1", "post5"), (second, "post4", None)):
            robot.token = await service.enrol(robot.name)
            await stack.enter_async_context(robot.connected(service.url, robot.token))
            await robot.greet(post, home=home)
        await until(lambda: _are_known(service, 2))
        yield first, second


async def _are_known(service: Service, number: int) -> bool:
    schedule = service.app.state.parts.traffic_service.schedule
    return schedule is not None and len(schedule.known) == number


async def has_robot(service: Service, order_id: str) -> str:
    async def robot() -> str | None:
        order: Order = await service.row(Order, id=order_id)
        return order.robot if order.state != "queued" else None

    return str(await until(robot))


async def waits_because(service: Service, order_id: str, sentence: str) -> None:
    async def says_so() -> bool:
        return (await service.row(Order, id=order_id)).why == sentence

    await until(says_so)


async def change(service: Service, order_id: str, **values: object) -> None:
    state = service.app.state.parts
    async with state.database.transaction() as session:
        order = await state.orders.ledger.order(session, order_id)
        for name, value in values.items():
            setattr(order, name, value)
    state.dispatcher.wake()


async def order_with(service: Service, robot: str, from_post: str, to_post: str) -> str:
    """Place an order that only this robot may fetch."""
    state = service.app.state.parts
    async with state.database.transaction() as session:
        sender = await state.sign_in_service.person(session, "sender@campus.example", state.clock.utc())
        request = NewOrder(from_post=from_post, to_post=to_post, recipient="recipient@campus.example")
        order_id = await placed(state.orders, session, sender, request)
        (await state.orders.ledger.order(session, order_id)).wanted_robot = robot
    assert await has_robot(service, order_id) == robot
    return order_id


async def have_no_room(service: Service, *robots: str) -> list[str]:
    """Return the orders that these robots get: as many as they carry."""
    return [await order_with(service, robot, "post2", "post3") for robot in robots for _ in range(2)]


async def goals(service: Service, robot: str) -> list[str]:
    schedule = service.app.state.parts.traffic_service.schedule
    return [] if schedule is None else [goal.key for goal in schedule.controller.goals(robot)]


async def test_orders_of_one_moment_are_spread_over_the_robots_near_them(
    service: Service, robots: tuple[PlayedRobot, PlayedRobot]
) -> None:
    near_first, near_second = await asyncio.gather(service.order("post1", "post2"), service.order("post4", "post3"))
    assert await has_robot(service, near_first) == "r1"
    assert await has_robot(service, near_second) == "r2"
    mission = await robots[0].mission()
    assert [(stop.action, stop.post) for stop in mission.stops] == [("load", "post1"), ("receive", "post2")]
    assert await until(lambda: goals(service, "r1")) == [stop.id for stop in mission.stops]


async def test_while_orders_wait_the_next_is_told_a_time_by_when_and_where_robots_are_free(
    service: Service, robots: tuple[PlayedRobot, PlayedRobot]
) -> None:
    estimates, now = service.app.state.parts.estimates, service.app.state.parts.clock.utc()

    async def free() -> Sequence[FreeRobot]:
        return estimates.free

    await have_no_room(service, "r1", "r2")
    assert not estimates.free, "the next is given at once"
    await service.order("post4", "post1")
    free_at = {robot.post: robot.at for robot in await until(free)}
    assert free_at.keys() == {"post3", "post1"}, "one of them is likely to bring what waits"
    assert min(free_at.values()) > now + timedelta(seconds=60)
    ways_s = [estimates.ways.length_m(post, "post2") / estimates.speed_m_s for post in free_at]
    soonest = min(at + timedelta(seconds=way_s) for at, way_s in zip(free_at.values(), ways_s, strict=True))
    comes_s = estimates.fetching("post2", now).assumed_s - SETS_OUT_S
    assert comes_s == pytest.approx((soonest - now).total_seconds())


async def test_an_order_more_goes_with_a_robot_under_way_and_never_before_what_it_has_begun(
    service: Service, robots: tuple[PlayedRobot, PlayedRobot]
) -> None:
    first = await service.order("post1", "post4")
    mission = await robots[0].mission()
    await robots[0].ends(await robots[0].report(mission, Step.DEPARTED, mission.stops[0]))
    second = await order_with(service, "r1", "post1", "post3")
    update = await robots[0].mission()
    assert (update.id, update.update) == (mission.id, 2)
    assert update.stops[0].order_id == first, "it is on its way there"
    assert sorted(stop.order_id or "" for stop in update.stops) == sorted([first, second] * 2)


@pytest.mark.slow
async def test_more_than_they_can_carry_waits_and_the_important_goes_first(
    service: Service, robots: tuple[PlayedRobot, PlayedRobot], clock: SteppedClock
) -> None:
    carried = await have_no_room(service, "r1", "r2")
    waiting = await service.order("post2", "post3")
    clock.advance(0.001)  # two of one instant go by their ids
    important = await service.order("post2", "post3")
    await waits_because(service, waiting, "Every robot is busy.")
    await change(service, important, priority=Priority.HIGH)
    await service.cancel(carried[0])
    name = (await service.row(Order, id=carried[0])).robot
    robot = next(one for one in robots if one.name == name)
    await lets_go(robot)
    assert await has_robot(service, important) == name
    assert (await service.row(Order, id=waiting)).state == "queued"


async def test_what_is_given_and_not_in_the_schedule_yet_takes_a_place(
    service: Service, robots: tuple[PlayedRobot, PlayedRobot]
) -> None:
    state = service.app.state.parts
    given = await service.order("post1", "post2")
    await robots[0].mission()
    assert len(await until(lambda: goals(service, "r1"))) == 2
    work, controller = await state.planner._look(), state.traffic_service.schedule.controller
    controller.give("r1", (), state.clock.now())
    problem = state.planner._scenes.of(work, controller, state.clock.utc(), state.clock.now())
    assert given not in problem.orders
    assert {name: room(problem, name, one.route) for name, one in problem.robots.items()} == {"r1": 1, "r2": 2}


async def lets_go(robot: PlayedRobot) -> None:
    """As it is told to."""
    told = (await robot.hear("cancel")).body
    assert isinstance(told, Cancel)
    answer = CommandAnswer(command_id=told.command_id, accepted=True, happened_at=robot.clock.utc())
    await robot.ends(await robot.say(Event(happened=answer)))


async def test_an_order_left_for_later_is_not_fetched_before(
    service: Service, robots: tuple[PlayedRobot, PlayedRobot], clock: SteppedClock
) -> None:
    state = service.app.state.parts
    async with state.database.transaction() as session:
        sender = await state.sign_in_service.person(session, "sender@campus.example", clock.utc())
        in_an_hour = clock.utc() + timedelta(hours=1)
        wish = NewOrder(from_post="post1", to_post="post2", recipient="recipient@campus.example", not_before=in_an_hour)
        later = await placed(state.orders, session, sender, wish)
    assert await has_robot(service, await service.order("post1", "post2")) == "r1"
    assert (await service.row(Order, id=later)).state == "queued"
    clock.advance(3600)
    state.dispatcher.wake()
    await has_robot(service, later)


async def test_a_robot_that_stands_still_loses_what_it_has_not_loaded(
    service: Service, robots: tuple[PlayedRobot, PlayedRobot]
) -> None:
    order_id = await service.order("post1", "post2")
    await robots[0].mission()
    stopped = Snapshot(position=at_post("post1"), activity=Activity.STOPPED, battery=Battery(ratio=0.9))
    await robots[0].say(stopped)
    await lets_go(robots[0])
    await until(lambda: _goes_with(service, order_id, "r2"))
    assert (await service.states(order_id))[-2:] == ["queued", "assigned"]


async def _is_known_to_stand(service: Service, robot: str) -> bool:
    row: RobotRow = await service.row(RobotRow, name=robot)
    return row.activity == Activity.STOPPED


async def _goes_with(service: Service, order_id: str, robot: str) -> bool:
    order: Order = await service.row(Order, id=order_id)
    return order.robot == robot and order.state == "assigned"


async def test_mail_that_is_aboard_stays_where_it_is_whatever_happens_to_its_robot(
    service: Service, robots: tuple[PlayedRobot, PlayedRobot]
) -> None:
    order_id = await service.order("post1", "post2")
    mission = await robots[0].mission()
    await robots[0].ends(await robots[0].say(robots[0].receipt(mission.stops[0])))
    stopped = Snapshot(position=at_post("post1"), activity=Activity.STOPPED, battery=Battery(ratio=0.9))
    await robots[0].say(stopped)
    await until(lambda: _is_known_to_stand(service, "r1"))
    other = await service.order("post1", "post2")
    assert await has_robot(service, other) == "r2"
    assert (await service.row(Order, id=order_id)).robot == "r1"


async def test_what_was_decided_on_a_world_that_has_changed_is_not_written(
    service: Service, robots: tuple[PlayedRobot, PlayedRobot], clock: SteppedClock
) -> None:
    state = service.app.state.parts
    order_id = await service.order("post1", "post2")
    await robots[0].mission()
    await order_with(service, "r1", "post1", "post3")
    planner = state.planner
    work = await planner._look()
    decision = await planner._decide(work, state.traffic_service.schedule)
    assert decision is not None
    turned = {name: tuple(reversed(route)) for name, route in decision.routes.items()}
    changes = changes_of(work, _with_routes(decision, turned))
    assert changes
    await service.cancel(order_id)
    async with state.database.transaction() as session:
        assert not await give_out(session, state.fleet, changes, set())
    assert [row.update_number for row in await service.rows(MissionRow, robot="r1")] == [2]


async def test_no_mail_is_given_before_it_is_loaded_when_no_way_leads_to_where_it_is_loaded(
    service: Service, robots: tuple[PlayedRobot, PlayedRobot], clock: SteppedClock
) -> None:
    state = service.app.state.parts
    order_id = await service.order("post1", "post2")
    await robots[0].mission()
    other_id = await service.order("post3", "post4")
    await until(lambda: _all_have_robots(service))
    planner = state.planner
    work = await planner._look()
    decision = await planner._decide(work, state.traffic_service.schedule)
    assert decision is not None
    (name,) = {stop.robot for stop in work.of_orders[order_id]}
    load, give = work.of_orders[order_id]
    without_load = tuple(stop for stop in decision.routes[name] if stop.goal.key != load.id)
    changes = changes_of(work, _with_routes(decision, {**decision.routes, name: without_load}))
    route = changes.routes.get(name, [stop.id for stop in work.stops[name]])
    assert route.index(load.id) < route.index(give.id)
    assert {stop.id for stop in work.of_orders[other_id] if stop.robot == name} <= set(route)


def _with_routes(decision: Decision, routes: Routes) -> Decision:
    return replace(decision, timed=replace(decision.timed, routes=routes))


async def _all_have_robots(service: Service) -> bool:
    return not await service.rows(Order, state="queued")


async def test_who_waits_reads_how_many_are_ahead_and_is_expected_after_them(
    service: Service, robots: tuple[PlayedRobot, PlayedRobot]
) -> None:
    await have_no_room(service, "r1", "r2")
    both = {await service.order("post2", "post3"), await service.order("post2", "post3")}
    one_ahead = "Every robot is busy, and one order is ahead of this one."

    async def in_sequence() -> list[Order] | None:
        """Orders of one second are fetched in any sequence."""
        found = [row for row in await service.rows(Order) if row.id in both]
        found.sort(key=lambda row: row.why == one_ahead)
        return found if [row.why for row in found] == ["Every robot is busy.", one_ahead] else None

    rows = await until(in_sequence)
    now = service.app.state.parts.clock.utc()
    assert now < rows[0].expected_from <= rows[1].expected_from
    assert rows[0].expected_to <= rows[1].expected_to


async def test_who_waits_for_robots_that_need_help_is_told_so_and_no_time(
    service: Service, robots: tuple[PlayedRobot, PlayedRobot]
) -> None:
    for robot, post in zip(robots, ("post1", "post4"), strict=True):
        stopped = Snapshot(position=at_post(post), activity=Activity.STOPPED, battery=Battery(ratio=0.9))
        await robot.say(stopped)

    async def have_stopped() -> bool:
        return {row.activity for row in await service.rows(RobotRow)} == {Activity.STOPPED}

    await until(have_stopped)
    order_id = await service.order("post2", "post3")
    await waits_because(service, order_id, "Every robot that could fetch it has stopped and needs help.")
    order = await service.row(Order, id=order_id)
    assert (order.expected_from, order.expected_to) == (None, None)


async def test_a_better_timetable_is_gone_by_though_every_order_stays_with_its_robot(
    service: Service, robots: tuple[PlayedRobot, PlayedRobot]
) -> None:
    for name, start, end in (("r1", "post1", "post5"), ("r2", "post3", "post4")):
        await order_with(service, name, start, end)
        await until(lambda name=name: goals(service, name))
    state = service.app.state.parts
    controller, now_s = state.traffic_service.schedule.controller, state.clock.now()
    tasks, before = controller.tasks(now_s), await service.rows(MissionRow)
    plans = [plan(controller.network, tasks, order) for order in permutations(tasks)]
    best, worst = sorted((one for one in plans if one is not None), key=lambda one: one.cost_s)
    assert controller.adopt({}, worst, now_s)
    assert best.cost_s < worst.cost_s

    async def goes_by_the_best() -> bool:
        await state.planner.improve()  # on a busy machine its time may be over before it has begun
        took_s = sum(journey.done_s for journey in controller.journeys(now_s).values())
        return took_s == pytest.approx(best.cost_s)

    await until(goes_by_the_best)
    assert await service.rows(MissionRow) == before
