"""One robot's body: where it truly is, what it draws from its pack, and how long its moves take.

Its mind knows of it what a robot's own senses tell. A kill leaves it where it was, a corridor half driven.
"""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field
from random import Random
from typing import Final

from benchmarks.fleet.packs import Pack
from benchmarks.fleet_simulation.durations import Spread, Taking
from benchmarks.fleet_simulation.judge import DOCK, Judge
from maps import CampusMap
from protocol.parts import Leg
from robot.agent.perception.battery import BatteryLevel

LOW, HYSTERESIS, BEGINS, FULL = 0.25, 0.03, 0.5, 0.99
"""The robot's own battery plan, as `robot.core.config` has it."""
EMPTY: Final = 0.01
OTHER_PACK: Final = 0.5
"""A technician puts another one in where it is empty."""


@dataclass
class Body:
    """`lane`: the corridor that it is in, of which `left_s` are left. `looks`: it knows which way."""

    name: str
    post: str
    campus: CampusMap
    taking: Taking
    judge: Judge
    pack: Pack
    rng: Random
    lane: Leg | None = None
    left_s: float = 0.0
    docked: bool = False
    in_hands: bool = False
    looks: bool = True
    driven_m: float = 0.0
    stranded: int = 0
    word: BatteryLevel = BatteryLevel.OK
    weak: bool = False
    _settled_s: float = 0.0
    _drives: bool = False
    on_battery: list[Callable[[], None]] = field(default_factory=list)

    @property
    def at(self) -> str | None:
        """The post where it stands, or in whose dock."""
        return None if self.lane is not None or self.in_hands else self.post

    # Moves. Each may be cut off by a kill.

    async def takes(self, spread: Spread) -> None:
        await asyncio.sleep(spread.draw_s(self.rng))

    async def enter(self, leg: Leg) -> None:
        """Turn towards it, and drive to its end."""
        await self.takes(self.taking.table.turn)
        self.lane, self.left_s = leg, self.taking.drive_s(leg, self.rng)
        self.judge.enters(self.name, leg)
        await self.drive_on()

    async def drive_on(self) -> None:
        """Drive what is left of the corridor."""
        assert self.lane is not None
        self._settle()
        self._drives, since_s = True, self.judge.now_s()
        try:
            await asyncio.sleep(self.left_s)
        finally:
            self.left_s = max(0.0, self.left_s - (self.judge.now_s() - since_s))
            self._settle()
            self._drives = False
        self._arrive()

    def _arrive(self) -> None:
        assert self.lane is not None
        leg, self.lane = self.lane, None
        self.driven_m += self.campus.corridor(leg.from_post, leg.to_post).length_m
        self.post, self.looks = leg.to_post, True
        self.judge.crosses(self.name, self.post)

    async def dock(self) -> bool:
        """False if another stands in it: this one feels that, and stays on the crossing."""
        await self.takes(self.taking.table.dock)
        if not self.judge.is_free(f"{DOCK} {self.post}"):
            return False
        self._settle()
        self.docked = True
        self.judge.docks(self.name, self.post)
        return True

    async def undock(self) -> None:
        self._settle()
        self.docked = False
        self.judge.crosses(self.name, self.post)
        await self.takes(self.taking.table.undock)

    # What people do with it.

    def is_taken(self) -> None:
        """Out of the way, in a person's hands."""
        self._settle()
        self.lane, self.docked, self.in_hands, self.looks = None, False, True, False
        self.judge.is_taken(self.name)

    def is_put(self, post: str, *, in_dock: bool = False) -> None:
        self._settle()
        self.post, self.in_hands, self.docked, self.looks = post, False, in_dock, in_dock
        self.judge.is_put(self.name, post, in_dock=in_dock)

    # Its charge.

    @property
    def ratio(self) -> float:
        return self.pack.told

    @property
    def charging(self) -> bool:
        return self.docked and self.word is not BatteryLevel.FULL

    def has(self, ratio: float) -> bool:
        return self.word is BatteryLevel.FULL or self.ratio >= ratio

    def look_at_battery(self) -> None:
        """Bring it up to date, and tell who listens."""
        self._settle()
        for tell in self.on_battery:
            tell()

    def _settle(self) -> None:
        past_s, self._settled_s = self.judge.now_s() - self._settled_s, self.judge.now_s()
        if self.docked:
            self.pack.charge(past_s)
        elif self._drives:
            self.pack.drive(past_s)
        else:
            self.pack.stand(past_s)
        if self.pack.ratio <= EMPTY and not self.docked:
            self.stranded += 1
            self.pack.ratio = OTHER_PACK
        ratio = self.pack.told
        low = LOW + (HYSTERESIS if self.word is BatteryLevel.LOW else 0.0)
        self.word = BatteryLevel.FULL if ratio >= FULL else BatteryLevel.LOW if ratio < low else BatteryLevel.OK
        self.weak = ratio < BEGINS + (HYSTERESIS if self.weak else 0.0)


def begins_in_dock(body: Body) -> None:
    """At the start of a run each robot stands where it is at home."""
    body.docked = True
    body.judge.docks(body.name, body.post)


def begins_at_post(body: Body) -> None:
    """The same without a dock."""
    body.judge.crosses(body.name, body.post)
