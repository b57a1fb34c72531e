"""Missions as dispatch writes them: new ones for orders, and one more order on one that is under way."""

from collections.abc import Sequence
from typing import Any, Final

from sqlalchemy import insert
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import connection_of
from app.dispatch.choice import WaitingOrder
from app.dispatch.insertion import Insertion, Tour, Visit, cheapest_insertion
from app.models import MissionRow, Order, StopRow
from app.orders.stops import active_mission, stops_left
from app.robots.service import Fleet
from maps.ways import Ways
from protocol.ids import new_id
from protocol.parts import Part, Stop, StopAction
from protocol.to_robot import Mission, Verifiers

PLACES: Final = (StopAction.LOAD, StopAction.RECEIVE)
_NEW_MISSION: Final = insert(MissionRow)
_NEW_STOP: Final = insert(StopRow)
Values = dict[str, Any]
"""A new row, by its columns."""
DETOUR_RATIO: Final = 0.5
"""A robot takes an order along if it lengthens its way by at most this share of the order's."""


async def begin_missions(
    session: AsyncSession, fleet: Fleet, given: Sequence[tuple[Order, str]], told: bool
) -> list[str]:
    """Fetch and bring, nothing else yet: a new mission for each of these orders and its robot. Their robots are told at
    once, unless something may still be added."""
    connection = await connection_of(session)
    now, wait_limit_s = fleet.clock.utc(), fleet.settings.wait_limit_s
    missions: list[Values] = [
        {"id": new_id(), "robot": robot, "created_at": now, "told_update": int(told)} for _, robot in given
    ]
    stops = [
        _stops(mission["id"], order.id, (order.load_post, order.to_post), wait_limit_s)
        for mission, (order, _) in zip(missions, given, strict=True)
    ]
    # All of one kind by one statement, and as values: that is most of what an order costs here.
    await connection.execute(_NEW_MISSION, missions)
    await connection.execute(_NEW_STOP, [stop for both in stops for stop in both])
    if told:
        await _tell_of_new(session, fleet, missions, stops, [order for order, _ in given])
    return [mission["id"] for mission in missions]


async def _tell_of_new(
    session: AsyncSession,
    fleet: Fleet,
    missions: Sequence[Values],
    stops: Sequence[Sequence[Values]],
    orders: Sequence[Order],
) -> None:
    """Send what `tell_mission` would tell each of them, with nothing read that is at hand."""
    verifiers = await fleet.orders.verifiers(session, *orders)
    news: dict[str, tuple[Part, ...]] = {}
    for mission, both, order in zip(missions, stops, orders, strict=True):
        codes = Verifiers(verifiers=tuple(one for one in verifiers if one.order_id == order.id))
        told = Mission(id=mission["id"], update=1, stops=tuple(_as_told(stop) for stop in both))
        news[mission["robot"]] = (codes, told)
    await fleet.tell_all(session, news)


def _as_told(stop: Values) -> Stop:
    return Stop(**{name: stop[name] for name in Stop.model_fields if name in stop})


def _stops(
    mission_id: str, order_id: str, posts: tuple[str, str], wait_limit_s: float, since_update: int = 1
) -> list[Values]:
    return [
        {
            "id": new_id(),
            "mission_id": mission_id,
            "position": position,
            "post": post,
            "action": action,
            "order_id": order_id,
            "wait_limit_s": wait_limit_s,
            "since_update": since_update,
        }
        for position, (action, post) in enumerate(zip(PLACES, posts, strict=True))
    ]


async def take_along(
    session: AsyncSession, fleet: Fleet, order: WaitingOrder, under_way: Sequence[Tour], ways: Ways
) -> MissionRow | None:
    """The mission that this order goes with from now on, if one comes by; its robot is told by its next update."""
    best = best_tour(order, under_way, ways, fleet.settings.robot_capacity, DETOUR_RATIO)
    if best is None:
        return None
    tour, insertion = best
    mission = await active_mission(session, tour.robot)
    assert mission is not None, f"{tour.robot} is under way without a mission"  # noqa: S101  # the same transaction
    if mission.told_update:
        mission.update_number += 1
    posts = (order.from_post, order.to_post)
    values = _stops(mission.id, order.id, posts, fleet.settings.wait_limit_s, mission.update_number)
    new = [StopRow(**one) for one in values]
    by_key = dict(zip((LOAD, RECEIVE), new, strict=True))
    stops = {stop.id: stop for stop in await stops_left(session, mission.id)}
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
    """Return the tour that gets longest by least, if by no more than `detour_ratio` of the order's own way."""
    load, receive = Visit(LOAD, order.from_post, 1), Visit(RECEIVE, order.to_post, -1)
    limit_m = detour_ratio * ways.length_m(order.from_post, order.to_post)
    found = [
        (tour, insertion)
        for tour in under_way
        if order.may_go_with(tour.robot) and tour.visits
        if (insertion := cheapest_insertion(tour, load, receive, capacity, ways)) and insertion.detour_m <= limit_m
    ]
    return min(found, key=lambda one: (one[1].detour_m, one[0].robot), default=None)
