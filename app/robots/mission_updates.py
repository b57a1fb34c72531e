"""Telling robots their missions: the stops that are left, under the newest number, after the codes that they need."""

from collections.abc import Sequence

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import MissionRow, Order, RobotRow, StopRow
from app.orders.stops import stops_left
from app.robots.commands import unanswered
from app.robots.service import Fleet
from protocol.parts import Stop, StopAction
from protocol.to_robot import Mission, Verifiers


async def tell_mission(
    session: AsyncSession, fleet: Fleet, robot: RobotRow, mission: MissionRow, *, anew: bool = False
) -> bool:
    """Tell a robot its mission as it is now; False if nothing is left of it to tell.

    An order that the robot was told to drop and has not answered for is left out: it would take it up again.
    `anew`: to a robot that has forgotten everything, and is told again what to drop afterwards.
    """
    stops = list(await stops_left(session, mission.id))
    if not anew:
        dropped = {command.order_id for command in await unanswered(session, robot=robot.name, kind="cancel")}
        stops = [stop for stop in stops if stop.order_id not in dropped]
    if stops:
        news = stops if anew else [stop for stop in stops if stop.since_update > mission.told_update]
        # First what codes are checked against: the mission must not begin without.
        if verifiers := await fleet.orders.verifiers(session, *await _orders_of(session, news)):
            await fleet.tell(session, robot, Verifiers(verifiers=verifiers))
        told = Mission(id=mission.id, update=mission.update_number, stops=tuple(stop_of(stop) for stop in stops))
        await fleet.tell(session, robot, told)
    mission.told_update = mission.update_number
    return bool(stops)


def stop_of(row: StopRow) -> Stop:
    """A stop as the robot is told it."""
    return Stop(
        id=row.id,
        post=row.post,
        action=StopAction(row.action),
        order_id=row.order_id,
        wait_limit_s=row.wait_limit_s,
        until_ratio=row.until_ratio,
    )


async def _orders_of(session: AsyncSession, stops: Sequence[StopRow]) -> Sequence[Order]:
    order_ids = {stop.order_id for stop in stops if stop.order_id}
    if not order_ids:
        return ()
    return (await session.exec(select(Order).where(col(Order.id).in_(order_ids)).order_by(col(Order.id)))).all()
