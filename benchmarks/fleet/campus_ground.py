"""The hidden truth of a simulated campus: paces, people, failures; and who is where.

A robot that meets another in a corridor, or finds no bay, ends the run. That is checked here, with nothing of the
traffic.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from random import Random
from typing import Final

from benchmarks.fleet.charging_world import BEGINS, DAY_S, Clockwork
from benchmarks.fleet.world import CollisionError
from fleet.schedule.network import Network, network_of
from maps import CampusMap, builtin_map, corridor_name
from protocol.parts import Leg, Purpose

ASSUMED_M_S: Final = 0.15
"""Assumed by the service, waits at crossings included (its setting `assumed_speed_m_s`)."""
ASSUMED_HANDOVER_S: Final = 120.0
PACE: Final = (0.8, 1.3)
"""Of the assumed seconds, each corridor in each direction for itself; and each time 20 % more or less."""
SPREAD: Final = 0.2
OFFICE_H: Final = range(9, 17)
REPAIR_S, LONGEST_REPAIR_S = 20 * 60.0, 45 * 60.0
OPENS_H, CLOSES_H = 8, 19
BY_HOUR: Final = (0.0,) * 8 + (1.0, 3.0, 3.0, 1.0, 1.0, 1.0, 3.0, 3.0, 1.0) + (0.0,) * 7
"""How many orders come in an hour, beside each other: two rush hours in the morning, two in the afternoon."""


@dataclass(frozen=True, slots=True)
class Faults:
    """`dies`, `stands`: of all ways through a corridor; silent until a person comes, or told and over after a while.
    Closed corridors of the whole campus and lost connections of each robot: one in so many seconds."""

    dies: float = 0.0
    stands: float = 0.0
    closed_every_s: float = 0.0
    away_every_s: float = 0.0


FAULTS: Final = Faults(dies=1 / 1000, stands=1 / 300, closed_every_s=DAY_S, away_every_s=4 * 3600.0)


@dataclass
class Ground:
    """`chargers`: who charges at each dock. `inside`: who is in which corridor, `at` which post each stands or will
    stand. The service has sent a robot to a dock (`is_sent`), or has another leave it to this one (`needs_it_more`);
    `makes_room`: whether it does."""

    clock: Clockwork
    rng: Random
    faults: Faults
    campus: CampusMap = field(default_factory=lambda: with_bays(2))
    network: Network = field(init=False)
    chargers: dict[str, str | None] = field(init=False)
    inside: dict[str, Leg] = field(default_factory=dict)
    at: dict[str, str] = field(default_factory=dict)
    is_sent: Callable[[str, str], bool] = lambda _, __: False
    takes_bay: Callable[[str], bool] = lambda _: True
    needs_it_more: Callable[[str, str], bool] = lambda _, __: False
    makes_room: Callable[[str], bool] = lambda _: False

    def __post_init__(self) -> None:
        self.network = network_of(self.campus, lambda corridor, _: corridor.length_m / ASSUMED_M_S)
        self.chargers = {dock.name: None for dock in self.campus.docks()}
        ends = [(one.a, one.b) for one in self.campus.corridors]
        self._pace = {pair: self.rng.uniform(*PACE) for a, b in ends for pair in ((a, b), (b, a))}

    def travel_s(self, leg: Leg) -> float:
        assumed_s = self.length_m(leg) / ASSUMED_M_S
        return assumed_s * self._pace[leg.from_post, leg.to_post] * self.rng.uniform(1 - SPREAD, 1 + SPREAD)

    def handling_s(self, purpose: Purpose) -> float:
        """People come sooner in their hours, and somewhat sooner with mail than for it."""
        median_s = (45.0 if purpose is Purpose.LOAD else 60.0) * (1.0 if is_attended(self.clock.now_s) else 2.0)
        return min(600.0, median_s * self.rng.lognormvariate(0.0, 0.6))

    def repair_s(self) -> float:
        return min(LONGEST_REPAIR_S, self.rng.expovariate(1 / REPAIR_S))

    def length_m(self, leg: Leg) -> float:
        return self.campus.corridor(leg.from_post, leg.to_post).length_m

    def way(self, start: str, to: str) -> tuple[Leg, ...]:
        """The shortest by the map."""
        network, legs = self.network, []
        at, goal = network.number_of(start), network.number_of(to)
        while at != goal:
            lane = min(network.lanes[at], key=lambda one: (one.travel_s + network.shortest_s[one.end][goal], one.end))
            legs.append(Leg(from_post=network.posts[at], to_post=network.posts[lane.end]))
            at = lane.end
        return tuple(legs)

    def nearest_dock(self, post: str) -> str:
        row = self.network.shortest_s[self.network.number_of(post)]
        return min(self.chargers, key=lambda dock: row[self.network.number_of(dock)])

    def enter(self, robot: str, leg: Leg) -> None:
        """Raises CollisionError."""
        corridor = corridor_name(leg.from_post, leg.to_post)
        met = [other for other, its in self.inside.items() if corridor_name(its.from_post, its.to_post) == corridor]
        if met:
            raise CollisionError(f"{robot} meets {met[0]} in {corridor}")
        self.inside[robot], self.at[robot] = leg, leg.to_post

    def has_bay(self, robot: str, post: str) -> bool:
        """Return whether its bay is free. A robot that was let go, and has not heard it yet, still stands in it."""
        others = (other for other, at in self.at.items() if at == post and other != robot and other not in self.inside)
        return not self.takes_bay(robot) or sum(map(self.takes_bay, others)) < self.campus.posts[post].bays

    def has_room_at(self, dock: str, robot: str) -> bool:
        """Return whether its charger is free for this robot: one that was sent there comes before one that only rests
        there."""
        has, is_sent = self.chargers[dock], self.is_sent(robot, dock)
        if has is None or has == robot:
            there = [other for other, post in self.at.items() if post == dock and other not in self.inside]
            return is_sent or not any(self.is_sent(other, dock) for other in there)
        may_stay = self.is_sent(has, dock) and not self.needs_it_more(robot, has)
        return is_sent and not may_stay and self.makes_room(has)

    def leave(self, robot: str) -> None:
        del self.inside[robot]

    def carry(self, robot: str, post: str) -> None:
        """A person takes it there."""
        self.inside.pop(robot, None)
        self.at[robot] = post


def with_bays(bays: int) -> CampusMap:
    """The Carleton tunnels with so many bays at each post: as assumed in the design, until they are measured."""
    campus = builtin_map("carleton")
    return replace(campus, posts={name: replace(post, bays=bays) for name, post in campus.posts.items()})


def homes(campus: CampusMap, robots: int) -> Mapping[str, str]:
    docks = [dock.name for dock in campus.docks()]
    return {f"r{number}": docks[number % len(docks)] for number in range(robots)}


def hour_of(now_s: float) -> int:
    return int(now_s % DAY_S // 3600)


def is_attended(now_s: float) -> bool:
    return hour_of(now_s) in OFFICE_H


def orders_an_hour(now_s: float, mean: float) -> float:
    """`mean`: of all the hours of the week."""
    weekend = BEGINS.weekday() + now_s // DAY_S % 7 >= 5
    return 0.0 if weekend else mean * 7 / 5 * BY_HOUR[hour_of(now_s)] / (sum(BY_HOUR) / 24)
