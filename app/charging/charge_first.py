"""Before each leg: a robot that has not the charge for it is sent to a dock first, while it still comes to one.

Work was given to it because its charge was enough as far as anybody could tell. Then it stood in a corridor, or was led
another way. Its own battery plan would break off later, and take it to the nearest dock, occupied or not.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import structlog
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.charging.free_docks import UNTIL_RATIO, free_docks
from app.dispatch.charge_limits import LEAVES_DOCK, Charges
from app.dispatch.open_work import read_open_work
from app.models import ClaimRow, MissionRow, MissionState, RobotRow, StopRow
from app.orders.stops import stops_left
from app.robots.mission_updates import tell_mission
from app.robots.service import Fleet
from protocol.ids import new_id
from protocol.parts import Leg, StopAction

REASON: Final = "the robot charges first"

log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class ChargeFirst:
    """Asked by the traffic service, in the transaction in which it would let the robot in."""

    fleet: Fleet

    async def sends(self, session: AsyncSession, robot: RobotRow, claim: ClaimRow, legs: Sequence[Leg]) -> bool:
        """Tell if the robot goes to a dock instead: then its reservation request is answered by that."""
        charges = Charges(self.fleet.orders.ledger.ways, self.fleet.settings, self.fleet.spending.rates)
        way = (legs[0].from_post, *(leg.to_post for leg in legs))
        if charges.goes_on(robot, way) or not self.fleet.connections.understands(robot.name, UNTIL_RATIO):
            return False
        mission = await _mission(session, robot.name)
        left = await stops_left(session, mission.id) if mission is not None else ()
        if mission is None or not await _breaks_off(session, left, claim):
            return False
        work = await read_open_work(session, self.fleet.clock.utc())
        dock = charges.nearest_dock(robot, free_docks(self.fleet.campus, work, robot.name))
        if dock is None:
            return False  # its own battery plan has the last word
        until_ratio = max(LEAVES_DOCK, charges.needed(robot, [stop.post for stop in left]))
        await self._put_first(session, robot, mission, left, (dock, until_ratio))
        claim.granted, claim.reason = False, REASON
        return True

    async def _put_first(
        self,
        session: AsyncSession,
        robot: RobotRow,
        mission: MissionRow,
        left: Sequence[StopRow],
        charge: tuple[str, float],
    ) -> None:
        dock, until_ratio = charge
        mission.update_number += 1
        first = StopRow(id=new_id(), mission_id=mission.id, position=0, post=dock, action=StopAction.DOCK)
        first.until_ratio, first.since_update = until_ratio, mission.update_number
        session.add(first)
        for position, stop in enumerate(left, start=1):
            stop.position = position
        await session.flush()
        await tell_mission(session, self.fleet, robot, mission)
        log.info("charges_first", robot=robot.name, dock=dock, until_ratio=until_ratio)


async def _mission(session: AsyncSession, robot: str) -> MissionRow | None:
    active = select(MissionRow).where(MissionRow.robot == robot, MissionRow.state == MissionState.ACTIVE)
    missions = (await session.exec(active.with_for_update())).all()
    return missions[0] if len(missions) == 1 else None


async def _breaks_off(session: AsyncSession, left: Sequence[StopRow], claim: ClaimRow) -> bool:
    """On its way to the next stop of an order, for which it has not just charged: a dock that did not help once does
    not help twice. What it does for reasons of its own is its own matter."""
    if not left or left[0].order_id is None or claim.goal != left[0].post:
        return False
    over = select(StopRow).where(StopRow.mission_id == left[0].mission_id, col(StopRow.done_at).is_not(None))
    last = (await session.exec(over.order_by(col(StopRow.done_at).desc(), col(StopRow.position).desc()))).first()
    return last is None or last.action != StopAction.DOCK
