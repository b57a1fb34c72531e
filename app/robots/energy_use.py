"""The energy use of each robot, learned from its reports: at the start of the service, and now and then again.

Nothing of it is kept: samples and grants are, and from them it is made anew in milliseconds.
"""

import asyncio
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Final

from sqlalchemy import bindparam, select
from sqlmodel import col

from app.core.database.database import Database
from app.models import BatterySample, GrantRow, RobotRow
from fleet.charging.energy import Rates, assumed_rates
from fleet.charging.history import Driven, Sample, learned_from
from maps import CampusMap

DRIVES_M_S: Final = 0.2
"""The robots' usual `drive.cruise_mm_s` (docs/reference/settings.md); `assumed_speed_m_s` has their waits in it."""
REMEMBERED: Final = 5000
"""Latest samples of a robot: some days, if it is on all the time."""
LEARN_EVERY_S: Final = 600.0
"""Real seconds."""


def usual_rates() -> Rates:
    """Return the rates of a robot that nothing is known of: assumed, a full battery drives 2 h and stands 5.3 h."""
    return assumed_rates(7200.0, 19_000.0, DRIVES_M_S)


@dataclass
class EnergyUse:
    """Runs in the background of the service. `rates`: by name, of every robot as it was known at the last look."""

    database: Database
    campus: CampusMap
    rates: dict[str, Rates] = field(default_factory=dict)
    _stopped: asyncio.Event = field(default_factory=asyncio.Event)

    def __post_init__(self) -> None:
        self._length_m = {
            (corridor.name, post): corridor.length_m
            for corridor in self.campus.corridors
            for post in (corridor.a, corridor.b)
        }

    def stop(self) -> None:
        """End `run`."""
        self._stopped.set()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        while not self._stopped.is_set():
            with suppress(TimeoutError):
                async with asyncio.timeout(LEARN_EVERY_S):
                    await self._stopped.wait()
            if not self._stopped.is_set():
                await self.learn()

    async def learn(self) -> None:
        """Anew from all that is remembered: one robot after the other, each in a look of its own."""
        async with self.database.asking() as connection:
            names = (await connection.execute(_ROBOTS)).scalars().all()
        for name in names:
            samples, driven = await self._told_by(name)
            self.rates[name] = await asyncio.to_thread(learned_from, usual_rates(), samples, driven)

    async def _told_by(self, robot: str) -> tuple[Sequence[Sample], Sequence[Driven]]:
        async with self.database.asking() as connection:
            latest = (await connection.execute(_SAMPLES, {"robot": robot})).all()
            samples: list[Sample] = [(at, ratio, charging) for at, ratio, charging in reversed(latest)]
            if not samples:
                return [], []
            since = {"robot": robot, "since": samples[0][0]}
            left = (await connection.execute(_DRIVEN, since)).all()
        ways = [(at, self._driven_m(corridor, from_post, left_at)) for at, corridor, from_post, left_at in left]
        return samples, [(at, way_m) for at, way_m in ways if at is not None and way_m is not None]

    def _driven_m(self, corridor: str, from_post: str, left_at: str | None) -> float | None:
        """None if it came out where it had gone in, so that the distance is unknown; or if the map has changed."""
        return None if left_at == from_post else self._length_m.get((corridor, from_post))


_ROBOTS: Final = select(col(RobotRow.name)).order_by(col(RobotRow.name))
_SAMPLES: Final = (
    select(col(BatterySample.at), col(BatterySample.ratio), col(BatterySample.charging))
    .where(col(BatterySample.robot) == bindparam("robot"))
    .order_by(col(BatterySample.at).desc(), col(BatterySample.id).desc())
    .limit(REMEMBERED)
)
_DRIVEN: Final = (
    select(col(GrantRow.cleared_at), col(GrantRow.corridor), col(GrantRow.from_post), col(GrantRow.left_at))
    .where(
        col(GrantRow.robot) == bindparam("robot"),
        col(GrantRow.cleared_at) >= bindparam("since"),
        col(GrantRow.freed_by).is_(None),  # what a person took back was not driven, or not to its end
    )
    .order_by(col(GrantRow.cleared_at), col(GrantRow.id))
)
