"""One robot's body: where it truly is, what it draws from its pack, and how long its moves take.

Its mind knows of it what a robot's own senses tell. A kill leaves it where it was, a corridor half driven.
"""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field
from random import Random
from typing import Final

from benchmarks.fleet_simulation.driving import Part, is_spur, parts_back, parts_of, place_of
from benchmarks.fleet_simulation.durations import Spread, Taking
from benchmarks.fleet_simulation.judge import Judge, bay
from benchmarks.fleet_simulation.packs import Pack
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
    """`post`: the bay in which it stands, or the post on whose crossing. `lane`: the spur or corridor that it drives
    through, of which `parts` are left; `turned`: it has turned round in there."""

    name: str
    post: str
    track: CampusMap
    taking: Taking
    judge: Judge
    pack: Pack
    rng: Random
    lane: Leg | None = None
    parts: list[Part] = field(default_factory=list)
    turned: bool = False
    docked: bool = False
    in_hands: bool = False
    driven_m: float = 0.0
    stranded: int = 0
    word: BatteryLevel = BatteryLevel.OK
    weak: bool = False
    _settled_s: float = 0.0
    _drives: bool = False
    on_battery: list[Callable[[], None]] = field(default_factory=list)

    @property
    def at(self) -> str | None:
        """The bay or crossing where it stands."""
        return None if self.lane is not None or self.in_hands else self.post

    @property
    def corridor(self) -> Leg | None:
        """The corridor in which it is, the way that it looks."""
        return None if self.lane is None or is_spur(self.track, self.lane) else self.lane

    @property
    def is_wholly_inside(self) -> bool:
        """Off the crossing behind it; of one that has turned round: the marker ahead tells the way that it goes."""
        return self.corridor is not None and len(self.parts) <= (1 if self.turned else 3)

    @property
    def nears_crossing(self) -> bool:
        return self.corridor is not None and len(self.parts) <= 2

    @property
    def is_before_crossing(self) -> bool:
        """Where it waits until it may cross, and not yet over that line."""
        return (
            self.nears_crossing and len(self.parts) == 1 and self.judge.places_of(self.name) != {*self.parts[0].places}
        )

    # Moves. Each may be cut off by a kill.

    async def takes(self, spread: Spread) -> None:
        await asyncio.sleep(spread.draw_s(self.rng))

    async def turn_to(self, leg: Leg, came_by: Leg | None) -> None:
        """Turn towards it, and set out."""
        table = self.taking.table
        through = came_by is not None and not (is_spur(self.track, came_by) or is_spur(self.track, leg))
        if not self.track.post(leg.from_post).bay_of:
            await self.takes(table.straight_on if through else table.turn)
        self.lane, self.parts, self.turned = leg, parts_of(self.track, self.taking, leg, self.rng), False

    def turn_back(self) -> None:
        """Round, in its corridor."""
        assert self.lane is not None
        self.lane = Leg(from_post=self.lane.to_post, to_post=self.lane.from_post)
        self.parts, self.turned = parts_back(self.taking, self.lane, self.rng), not self.turned

    async def drive(self) -> None:
        """Drive what is left of the next part."""
        part = self.parts[0]
        self._settle()
        self.judge.is_in(self.name, part.places, self.lane)
        self._drives, since_s = True, self.judge.now_s()
        try:
            await asyncio.sleep(part.left_s)
        finally:
            part.left_s = max(0.0, part.left_s - (self.judge.now_s() - since_s))
            self._settle()
            self._drives = False
        self.parts.pop(0)
        if not self.parts:
            self._arrive()

    def _arrive(self) -> None:
        assert self.lane is not None
        leg, self.lane = self.lane, None
        self.driven_m += self.track.corridor(leg.from_post, leg.to_post).length_m
        self.post = leg.to_post
        self.judge.is_in(self.name, [place_of(self.track, self.post)])

    async def dock(self) -> None:
        """Straight on from the end of its bay."""
        await self.takes(self.taking.table.dock)
        self._settle()
        self.docked = True

    async def undock(self) -> None:
        self._settle()
        self.docked = False
        await self.takes(self.taking.table.undock)

    # What people do with it.

    def is_taken(self) -> None:
        """Out of the way, in a person's hands."""
        self._settle()
        self.lane, self.parts, self.docked, self.in_hands = None, [], False, True
        self.judge.is_taken(self.name)

    def is_put(self, place: str) -> None:
        """Into a bay, and into the dock that it has."""
        self._settle()
        self.post, self.in_hands, self.docked = place, False, self.track.post(place).dock is not None
        self.judge.is_put(self.name, bay(place))

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


def begins_at_home(body: Body) -> None:
    """At the start of a run each robot is in its bay, and in the dock there."""
    body.docked = body.track.post(body.post).dock is not None
    body.judge.is_in(body.name, [bay(body.post)])
