"""The charge of its robots as the simulated service knows it, and its decisions by it: all with `fleet.charging`.

It knows what robots tell: how full they are, whether they charge, which corridors they have left. Packs, draws and
noise are not known here.
"""

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from math import inf
from typing import Final, Protocol

from benchmarks.fleet.campus_ground import ASSUMED_HANDOVER_S, ASSUMED_M_S, Ground
from benchmarks.fleet.charging_rules import is_no_worse, passes_dock
from benchmarks.fleet.charging_world import OWN_BEGIN
from fleet.charging.acceptance import Answer, Charge, Verdict, accepts, goes_on
from fleet.charging.curve import ChargeCurve
from fleet.charging.demand import Demand
from fleet.charging.docks import DockPlan, Need, plan_docks
from fleet.charging.energy import Rates, Use, assumed_rates
from fleet.charging.history import Driven, Sample, learned_from
from fleet.charging.levels import Thresholds
from fleet.charging.top_ups import NEEDS_IT_MORE, Move, TopUpPolicy, top_ups
from fleet.schedule.journey import Goal
from fleet.schedule.network import Lane, Network

SLOW: Final = 1.05
"""Ways are expected to take so many times longer than assumed, with all waits: rather too long."""
DRIVES_M_S: Final = 0.2
WORTH_A_WAY_ROUND_S: Final = 600.0
ENOUGH_MORE: Final = 0.02
FULL_ENOUGH: Final = 0.9
"""Then a robot that charges on the way goes on, whatever it is to do."""
LONGEST_DRIVE_S: Final = 8 * 3600.0


class Charged(Protocol):
    """The known charge of a robot. `recharging`: its own battery plan has it. `bound_for`: a dock that it was sent
    to."""

    name: str
    post: str
    ratio: float
    docked: bool
    charging: bool
    recharging: bool
    bound_for: str | None


@dataclass
class Charges:
    """`network`: as it is open now. `samples` and `driven`: since the robot charged last."""

    ground: Ground
    robots: Mapping[str, Charged]
    network: Callable[[], Network]
    lasts: float = 1.0
    thresholds: Thresholds = field(default_factory=Thresholds)
    demand: Demand = field(default_factory=Demand)
    rates: dict[str, Rates] = field(init=False)
    curves: dict[str, ChargeCurve] = field(init=False)
    samples: dict[str, list[Sample]] = field(default_factory=lambda: defaultdict(list))
    driven: dict[str, list[Driven]] = field(default_factory=lambda: defaultdict(list))
    _hour: datetime | None = None
    _orders: int = 0

    def __post_init__(self) -> None:
        self.rates = dict.fromkeys(self.robots, assumed_rates(7200.0 * self.lasts, 19_000.0 * self.lasts, DRIVES_M_S))
        self.curves = dict.fromkeys(self.robots, ChargeCurve(10_800.0))

    # What is learned.

    def told(self, robot: str, at: datetime, ratio: float, *, charging: bool) -> None:
        """A sample. What was spent since the last charge is learned from once it charges again."""
        samples = self.samples[robot]
        was_charging = bool(samples) and samples[-1][2]
        if charging != was_charging and samples:
            if was_charging:
                self._learn_curve(robot)
            else:
                self.rates[robot] = learned_from(self.rates[robot], samples, self.driven[robot])
            self.samples[robot], self.driven[robot] = samples[-1:], []
        self.samples[robot].append((at, ratio, charging))

    def left_corridor(self, robot: str, at: datetime, way_m: float) -> None:
        self.driven[robot].append((at, way_m))

    def _learn_curve(self, robot: str) -> None:
        charged = [(at, ratio) for at, ratio, charging in self.samples[robot] if charging]
        (begun_at, begun), (ended_at, ended) = charged[0], charged[-1]
        if ended > begun:
            self.curves[robot] = self.curves[robot].learned(begun, ended, (ended_at - begun_at).total_seconds())

    def ordered(self, local: datetime) -> None:
        self.count_hour(local)
        self._orders += 1

    def count_hour(self, local: datetime) -> None:
        hour = local.replace(minute=0, second=0, microsecond=0)
        if self._hour is not None and hour != self._hour:
            self.demand.learn(self._hour, self._orders)
            self._orders = 0
        self._hour = hour

    # What is decided.

    def verdict(self, robot: Charged, before: Sequence[Goal], more: Sequence[Goal]) -> Verdict:
        """Decide whether it may take these goals on, behind those that it has."""
        goals = (*before, *more)
        work, last = self._work(robot.post, goals), self.ground.network.posts[goals[-1].post]
        if (work + self._to_dock(last)).time_s == inf:
            return Verdict(Answer.CHARGE_FIRST, 1.0, 0.0)
        parts = [self._there_and_back(self.ground.network.posts[goal.post]) for goal in more]
        verdict = accepts(self._charge(robot), work, self._to_dock(last), self.thresholds, parts)
        if not verdict.is_accepted:
            return verdict
        left = max(self.thresholds.low + self.rates[robot.name].at_most(self._to_dock(last)), verdict.left)
        charge = replace(self._charge(robot), ratio=left, docked=False)
        done = Need(robot.name, charge, self._now_s + work.time_s, self._ways(last))
        if not is_no_worse(self.plan(done), self.plan()):
            return replace(verdict, answer=Answer.CHARGE_FIRST)
        return verdict

    def drives_s(self, robot: Charged) -> float:
        """So many seconds of driving it has charge for."""
        spare, rates = robot.ratio - self.thresholds.low, self.rates[robot.name]
        low_s, high_s = 0.0, LONGEST_DRIVE_S
        while high_s - low_s > 10.0:
            middle_s = (low_s + high_s) / 2
            fits = rates.at_most(_drive(middle_s)) <= spare
            low_s, high_s = (middle_s, high_s) if fits else (low_s, middle_s)
        return low_s

    def goes_on(self, robot: Charged, lane: Lane) -> bool:
        """Return whether it may enter one more corridor, or must go to a dock first."""
        end = self.ground.network.posts[lane.end]
        charge, leg = self._charge(robot), _drive(lane.travel_s)
        ways = self._ways(end).values()
        if robot.recharging or robot.ratio >= FULL_ENOUGH or not ways:
            return True
        return any(goes_on(charge, leg, way, self.thresholds) for way in ways)

    def passes_dock(self, robot: Charged, lane: Lane, goals: Sequence[Goal]) -> bool:
        """Return whether it may leave a post where it could charge now, with work before it that is more than one
        charge."""
        post = self.ground.network.posts[lane.start]
        if not self.is_free(post, robot) or not goals or robot.recharging or robot.ratio >= FULL_ENOUGH:
            return True
        to_next = self._work(post, goals[:1]) + self._to_dock(self.ground.network.posts[goals[0].post])
        return to_next.time_s == inf or passes_dock(self._charge(robot), to_next, self.thresholds)

    def is_free(self, post: str, robot: Charged) -> bool:
        """Return whether there is a dock that no other robot charges in or was sent to."""
        others = (one for one in self.robots.values() if one is not robot)
        return post in self.ground.chargers and not any(
            post in (one.bound_for, one.post if one.charging else None) for one in others
        )

    def waits_for_way(self, robot: Charged, lane: Lane, dock: str) -> bool:
        """To a dock: whether a closed corridor makes the way longer than its charge lasts, so that standing before it
        costs less."""
        number = self.ground.network.number_of(dock)
        as_ever_s = self.ground.network.shortest_s[lane.start][number]
        now_s = lane.travel_s + self.network().shortest_s[lane.end][number]
        if now_s <= as_ever_s + WORTH_A_WAY_ROUND_S:
            return False
        return robot.ratio < self.thresholds.critical + self.rates[robot.name].at_most(_drive(now_s))

    def needs_it_more(self, robot: str, other: str) -> bool:
        """Return whether the other leaves its dock to this one for a while: below `low` it would not last until its
        turn."""
        ratio = self.robots[robot].ratio
        return ratio < self.thresholds.low and self.robots[other].ratio >= ratio + NEEDS_IT_MORE

    def has_enough(self, robot: Charged, goals: Sequence[Goal]) -> bool:
        """Of a robot that was sent to a dock: whether it goes on. With nothing to do it stays until charging gets slow,
        unless another robot needs a dock more: on its way home it would only spend what the next order waits for."""
        if not goals and not self._is_needed_more(robot):
            return robot.ratio >= self.thresholds.sufficient
        work = self._work(robot.post, goals)
        if work.time_s == inf:
            return robot.ratio >= FULL_ENOUGH
        last = self.ground.network.posts[goals[-1].post] if goals else robot.post
        needed = accepts(self._charge(robot), work, self._to_dock(last), self.thresholds).needed
        return robot.ratio >= max(OWN_BEGIN, min(FULL_ENOUGH, needed + ENOUGH_MORE))

    def _is_needed_more(self, robot: Charged) -> bool:
        others = [one for one in self.robots.values() if not one.charging and one.bound_for in (None, robot.post)]
        return any(robot.ratio >= one.ratio + NEEDS_IT_MORE for one in others)

    def charging_s(self, robot: Charged, wanted: float) -> float:
        return self.curves[robot.name].time_s(robot.ratio, wanted)

    def dock_for(self, robot: Charged) -> str:
        """Where a robot charges that breaks off: by the plan for all docks, of those that it gets to."""
        need, rates = self._need(robot), self.rates[robot.name]
        spare = robot.ratio - self.thresholds.critical
        near = {dock: way for dock, way in need.ways.items() if rates.at_most(way) <= spare}
        stay = self.plan(replace(need, ways=near or need.ways)).stays.get(robot.name)
        return self.ground.nearest_dock(robot.post) if stay is None else stay.dock

    def instead_of(self, robot: Charged, dock: str) -> str | None:
        """The nearest dock, if the way to this one has become too long for the charge: it stood on the way."""
        spare, rates = robot.ratio - self.thresholds.critical, self.rates[robot.name]
        costs = {name: rates.at_most(way) for name, way in self._ways(robot.post).items()}
        nearest = min(costs, key=costs.__getitem__, default=dock)
        return nearest if nearest != dock and costs.get(dock, inf) > spare else None

    def comes_to_another_dock(self, robot: Charged) -> bool:
        """Before its own battery plan takes over."""
        spare, rates = robot.ratio - self.thresholds.low, self.rates[robot.name]
        return any(rates.at_most(way) <= spare for dock, way in self._ways(robot.post).items() if dock != robot.post)

    def moves(self, resting: Sequence[Charged], taken: Mapping[str, str | None], local: datetime) -> list[Move]:
        self.count_hour(local)
        policy = TopUpPolicy(self.demand.is_quiet(local), round(self.demand.expected(local, 1)))
        needs = [self._need(robot) for robot in resting]
        return top_ups(needs, self.plan(), taken, self.thresholds, policy, self._now_s)

    def plan(self, instead: Need | None = None) -> DockPlan:
        needs = {robot.name: self._need(robot) for robot in self.robots.values()}
        if instead is not None:
            needs[instead.robot] = instead
        curve = next(iter(self.curves.values()))
        return plan_docks(list(needs.values()), self.ground.chargers, curve, self.thresholds, self._now_s)

    # How it is done.

    @property
    def _now_s(self) -> float:
        return self.ground.clock.now_s

    def _charge(self, robot: Charged) -> Charge:
        return Charge(robot.ratio, self.rates[robot.name], robot.charging, robot.recharging)

    def _need(self, robot: Charged) -> Need:
        dock = robot.post if robot.charging else robot.bound_for
        return Need(robot.name, self._charge(robot), self._now_s, self._ways(robot.post), dock, OWN_BEGIN)

    def _work(self, post: str, goals: Sequence[Goal]) -> Use:
        network, way_s = self.network(), 0.0
        at = network.number_of(post)
        for goal in goals:
            way_s += network.shortest_s[at][goal.post]
            at = goal.post
        return _drive(way_s) + Use(0.0, len(goals) * ASSUMED_HANDOVER_S)

    def _ways(self, post: str) -> dict[str, Use]:
        """To the docks that a way leads to."""
        network = self.network()
        row = network.shortest_s[network.number_of(post)]
        times_s = {dock: row[network.number_of(dock)] for dock in self.ground.chargers}
        return {dock: _drive(way_s) for dock, way_s in times_s.items() if way_s < inf}

    def _to_dock(self, post: str) -> Use:
        """To the nearest; endless where no way leads to any."""
        return min(self._ways(post).values(), key=lambda use: use.time_s, default=Use(inf, inf))

    def _there_and_back(self, post: str) -> Use:
        return self._to_dock(post) + self._to_dock(post) + Use(0.0, ASSUMED_HANDOVER_S)


def _drive(way_s: float) -> Use:
    """A way that takes so long by the map."""
    return Use(way_s * ASSUMED_M_S, SLOW * way_s)
