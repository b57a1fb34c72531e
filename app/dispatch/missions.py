"""Missions as dispatch writes them: a new one for an order, and one more order on one that is under way."""

from collections.abc import Sequence
from typing import Final

from sqlmodel.ext.asyncio.session import AsyncSession

from app.dispatch.choice import WaitingOrder
from app.dispatch.insertion import Insertion, Tour, Visit, cheapest_insertion
from app.fleet.service import Fleet
from app.orders.stops import active_mission, left_of
from app.people.service import new_id
from app.tables import MissionRow, Order, StopRow
from maps.ways import Ways
from protocol.parts import StopAction

PLACES: Final = (StopAction.LOAD, StopAction.RECEIVE)


async def begin_mission(session: AsyncSession, fleet: Fleet, order: Order, robot: str) -> MissionRow:
    """Fetch and bring, nothing else yet."""
    mission = MissionRow(id=new_id(), robot=robot, created_at=fleet.clock.utc())
    session.add(mission)
    await session.flush()
    stops = _stops(mission, order.id, (order.from_post, order.to_post), fleet.settings.wait_limit_s)
    for position, stop in enumerate(stops):
        stop.position = position
    session.add_all(stops)
    await session.flush()
    return mission


def _stops(mission: MissionRow, order_id: str, posts: tuple[str, str], wait_limit_s: float) -> list[StopRow]:
    return [
        StopRow(
            id=new_id(),
            mission_id=mission.id,
            position=0,
            post=post,
            action=action,
            order_id=order_id,
            wait_limit_s=wait_limit_s,
            since_update=mission.update_number,
        )
        for action, post in zip(PLACES, posts, strict=True)
    ]


async def take_along(
    session: AsyncSession, fleet: Fleet, order: WaitingOrder, under_way: Sequence[Tour], ways: Ways
) -> MissionRow | None:
    """The mission that this order goes with from now on, if one comes by; its robot is told by its next update."""
    best = best_tour(order, under_way, ways, fleet.settings.robot_capacity, fleet.settings.detour_ratio)
    if best is None:
        return None
    tour, insertion = best
    mission = await active_mission(session, tour.robot)
    assert mission is not None, f"{tour.robot} is under way without a mission"  # noqa: S101  # the same transaction
    if mission.told_update:
        mission.update_number += 1
    new = _stops(mission, order.id, (order.from_post, order.to_post), fleet.settings.wait_limit_s)
    by_key = dict(zip((LOAD, RECEIVE), new, strict=True))
    stops = {stop.id: stop for stop in (await session.exec(left_of(mission.id))).all()}
    for position, visit in enumerate(insertion.visits):
        (by_key.get(visit.key) or stops[visit.key]).position = position
    session.add_all(new)
    await session.flush()
    return mission


LOAD, RECEIVE = "load", "receive"
"""The keys of the visits that are not written down yet."""


def best_tour(
    order: WaitingOrder, under_way: Sequence[Tour], ways: Ways, capacity: int, detour_ratio: float
) -> tuple[Tour, Insertion] | None:
    """Whose way gets longest by least, if by no more than `detour_ratio` of the order's own."""
    load, receive = Visit(LOAD, order.from_post, 1), Visit(RECEIVE, order.to_post, -1)
    limit_m = detour_ratio * ways.length_m(order.from_post, order.to_post)
    found = [
        (tour, insertion)
        for tour in under_way
        if order.may_go_with(tour.robot) and tour.visits
        if (insertion := cheapest_insertion(tour, load, receive, capacity, ways)) and insertion.detour_m <= limit_m
    ]
    return min(found, key=lambda one: (one[1].detour_m, one[0].robot), default=None)
