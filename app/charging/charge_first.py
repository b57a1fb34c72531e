"""Before each leg: a robot that has not the charge for it is sent to a dock first, while it still comes to one.

Work was given to it because its charge was enough as far as could be told. Then it stood in a corridor, or was led
another way. Its own battery plan would break off later, and take it to the nearest dock, occupied or not. The same
holds on the way home: it passes free docks.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import structlog
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.charging.errands import send_on_errand
from app.charging.free_docks import UNTIL_RATIO, free_docks
from app.dispatch.charge_limits import LEAVES_DOCK, THRESHOLDS, Charges
from app.dispatch.open_work import OpenWork, read_open_work
from app.models import ClaimRow, MissionRow, MissionState, RobotRow, StopRow
from app.orders.stops import stops_left
from app.robots.mission_updates import tell_mission
from app.robots.service import Fleet
from protocol.ids import new_id
from protocol.parts import Leg, StopAction

REASON: Final = "the robot charges first"
MOST_DOCKS: Final = 3
"""So many docks one after the other have not helped: a fourth will not either."""

log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class ChargeFirst:
    """Asked by the traffic service, in the transaction in which it would let the robot in."""

    fleet: Fleet

    async def sends(self, session: AsyncSession, robot: RobotRow, claim: ClaimRow, legs: Sequence[Leg]) -> bool:
        """Tell if the robot goes to a dock instead: then its reservation request is answered by that."""
        # Most robots have enough: they are let in without a further question.
        if all(self._charges.goes_on(robot, way) for way in (_posts(legs), _asked(claim))):
            return False
        if not self.fleet.connections.understands(robot.name, UNTIL_RATIO):
            return False
        mission = await _mission(session, robot.name)
        if mission is None:
            is_sent = await self._sends_from_the_way_home(session, robot, claim)
        else:
            is_sent = await self._sends_first(session, robot, mission, claim, legs)
        if is_sent:
            claim.granted, claim.reason = False, REASON
        return is_sent

    async def _sends_first(
        self, session: AsyncSession, robot: RobotRow, mission: MissionRow, claim: ClaimRow, legs: Sequence[Leg]
    ) -> bool:
        left = await stops_left(session, mission.id)
        if self._charges.goes_on(robot, _posts(legs)) or not await _breaks_off(session, left, claim):
            return False
        work = await read_open_work(session, self.fleet.clock.utc())
        dock = self._nearest_dock(robot, work)
        if dock is None:
            return False  # its own battery plan has the last word
        until_ratio = max(LEAVES_DOCK, self._charges.needed(robot, [stop.post for stop in left]))
        await self._put_first(session, robot, mission, left, (dock, until_ratio))
        return True

    async def _sends_from_the_way_home(self, session: AsyncSession, robot: RobotRow, claim: ClaimRow) -> bool:
        home = self._home_of(robot)
        if home is None or claim.goal not in (home, robot.home_bay):
            return False
        if self._charges.goes_on(robot, _asked(claim)) or await _has_charged_in_vain(session, robot):
            return False
        work = await read_open_work(session, self.fleet.clock.utc())
        dock = self._nearest_dock(robot, work)
        if dock in (None, home) or not work.robots[robot.name].takes_work:
            return False
        stop = StopRow(id=new_id(), mission_id=new_id(), position=0, post=dock, action=StopAction.DOCK)
        stop.until_ratio = max(THRESHOLDS.sufficient, self._charges.needed(robot, [dock, home]))
        await send_on_errand(session, self.fleet, robot, stop)
        log.info("charges_on_the_way_home", robot=robot.name, dock=dock, until_ratio=stop.until_ratio)
        return True

    @property
    def _charges(self) -> Charges:
        return Charges(self.fleet.orders.ledger.ways, self.fleet.settings, self.fleet.spending.rates)

    def _nearest_dock(self, robot: RobotRow, work: OpenWork) -> str | None:
        return self._charges.nearest_dock(robot, free_docks(self.fleet.orders.ledger.ways, work, robot.name))

    def _home_of(self, robot: RobotRow) -> str | None:
        return self.fleet.campus.address_of(robot.home_bay) if robot.home_bay is not None else robot.home

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


def _posts(legs: Iterable[Leg]) -> tuple[str, ...]:
    """From the beginning of the first one on."""
    ways = list(legs)
    return (ways[0].from_post, *(leg.to_post for leg in ways))


def _asked(claim: ClaimRow) -> tuple[str, ...]:
    """All of the way that it asked for, as far as where it goes."""
    return _posts(Leg.model_validate(leg) for leg in claim.legs)


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


async def _has_charged_in_vain(session: AsyncSession, robot: RobotRow) -> bool:
    """It stands where it charged last, or its last stops were docks alone."""
    its = select(StopRow).join(MissionRow).where(MissionRow.robot == robot.name, col(StopRow.done_at).is_not(None))
    last = (await session.exec(its.order_by(col(StopRow.done_at).desc()).limit(MOST_DOCKS))).all()
    docks = [stop.post for stop in last if stop.action == StopAction.DOCK]
    return len(docks) == MOST_DOCKS or bool(last and last[0].action == StopAction.DOCK and last[0].post == robot.post)
