"""Battery samples: at most one a minute, and one when charging begins or ends."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Any, Final

from sqlalchemy import bindparam, func, insert, literal, or_, select
from sqlmodel import col
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import connection_of
from app.models import BatterySample, RobotRow

EVERY: Final = timedelta(minutes=1)
SHOWN: Final = 300

Sample = tuple[datetime, float, bool]

_KEEP: Final = insert(BatterySample)


@dataclass
class BatteryDiary:
    """When each robot was noted last. In memory: after a start each has one sample more."""

    _noted: dict[str, tuple[datetime, bool]] = field(default_factory=dict)

    async def note(self, session: AsyncSession, robots: Iterable[RobotRow], now: datetime) -> None:
        """Keep what is due of what these robots have said: one statement in whatever transaction this is."""
        due = [self._sample(robot, now) for robot in robots if self._is_due(robot, now)]
        if due:
            await (await connection_of(session)).execute(_KEEP, due)

    def _is_due(self, robot: RobotRow, now: datetime) -> bool:
        if not robot.battery_ratio:
            return False  # a robot that has not heard its base yet says 0; one that is empty says nothing
        at, charging = self._noted.get(robot.name, (None, False))
        return at is None or charging != robot.charging or now - at >= EVERY

    def _sample(self, robot: RobotRow, now: datetime) -> dict[str, Any]:
        # If the transaction fails, its messages are taken again, and this sample comes a minute later.
        self._noted[robot.name] = (now, robot.charging)
        return {"robot": robot.name, "at": now, "ratio": robot.battery_ratio, "charging": robot.charging}


async def samples_since(session: AsyncSession, robot: str, since: datetime, at_most: int = SHOWN) -> Sequence[Sample]:
    """Oldest first, and thinned to about so many: each so-manieth, the first and the last, and every change."""
    of_robot = {"robot": robot, "since": since}
    count = (await (await connection_of(session)).execute(_COUNT, of_robot)).scalar_one()
    each = max(1, -(-count // at_most))
    rows = await (await connection_of(session)).execute(_SOME, {**of_robot, "each": each, "count": count})
    return [(at, ratio, charging) for at, ratio, charging in rows.all()]


_THEIRS: Final = (col(BatterySample.robot) == bindparam("robot"), col(BatterySample.at) >= bindparam("since"))
_COUNT: Final = select(func.count()).select_from(BatterySample).where(*_THEIRS)
_IN_ORDER: Final = (col(BatterySample.at), col(BatterySample.id))
_NUMBERED: Final = (
    select(
        col(BatterySample.at),
        col(BatterySample.ratio),
        col(BatterySample.charging),
        func.row_number().over(order_by=_IN_ORDER).label("number"),
        func.lag(col(BatterySample.charging)).over(order_by=_IN_ORDER).label("before"),
    )
    .where(*_THEIRS)
    .subquery()
)
_SOME: Final = (
    select(_NUMBERED.c.at, _NUMBERED.c.ratio, _NUMBERED.c.charging)
    .where(
        or_(
            _NUMBERED.c.number % bindparam("each") == literal(0),
            _NUMBERED.c.number == literal(1),
            _NUMBERED.c.number == bindparam("count"),
            _NUMBERED.c.charging != _NUMBERED.c.before,
        )
    )
    .order_by(_NUMBERED.c.number)
    .limit(2 * SHOWN)
)
