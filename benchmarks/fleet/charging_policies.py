"""Policies for who works and who charges: `fleet.charging`, and what there was before, to compare it with."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final, Protocol

from benchmarks.fleet.charging_rules import is_no_worse
from benchmarks.fleet.charging_world import HANDLING_S, OWN_BEGIN, SPEED_M_S, Campus, Clockwork, Job, Robot
from fleet.charging.acceptance import Answer, Charge, Verdict, accepts, goes_on
from fleet.charging.curve import ChargeCurve
from fleet.charging.demand import Demand
from fleet.charging.docks import DockPlan, Need, plan_docks
from fleet.charging.energy import Rates, Use, assumed_rates
from fleet.charging.levels import Thresholds
from fleet.charging.top_ups import Move, TopUpPolicy, top_ups

SLOW: Final = 1.4
"""Ways are expected to take so many times longer than on the map, with all waits: rather too long."""
WANTED_HOURS: Final = 1
ENOUGH_CHARGE: Final = 0.30


class Policy(Protocol):
    """Asked by a fleet that is simulated."""

    def accepts(self, robot: Robot, job: Job) -> Verdict | None:
        """None: it may, and nothing was predicted."""
        ...

    def given(self, robot: Robot, job: Job) -> None: ...

    def goes_on(self, robot: Robot, post: int, leg_s: float) -> bool: ...

    def enough(self, robot: Robot, to_post: int) -> float:
        """The charge with which a robot goes on that broke off."""
        ...

    def dock_for(self, robot: Robot) -> str | None:
        """Where a robot charges that breaks off; None: wherever it is nearest."""
        ...

    def moves(self, resting: Sequence[Robot], taken: Mapping[str, str | None]) -> list[Move]: ...

    def spent(self, robot: Robot, use: Use, ratio: float) -> None: ...

    def ordered(self) -> None: ...


class Predicting:
    """`fleet.charging`. It knows what robots tell, the map, and which corridors are closed; no more."""

    def __init__(self, campus: Campus, clock: Clockwork, robots: Mapping[str, Robot]) -> None:
        self.campus, self.clock, self.robots = campus, clock, robots
        self.thresholds = Thresholds()
        self.rates = dict.fromkeys(robots, assumed_rates(7200.0, 19_000.0, SPEED_M_S))
        self.curve = ChargeCurve(10_800.0)
        self._working: dict[str, Need] = {}
        self._asked: dict[str, Need] = {}
        self.demand = Demand()
        self._hour, self._orders = clock.local.hour, 0

    def accepts(self, robot: Robot, job: Job) -> Verdict:
        network = self.campus.now_open.shortest_s
        way_s = network[robot.post][job.from_post] + network[job.from_post][job.to_post]
        work = Use(way_s * SPEED_M_S, SLOW * way_s + 2 * HANDLING_S)
        charge, ways = self._charge(robot), self._ways(job.to_post)
        nearest = min(ways.values(), key=lambda use: use.time_s, default=None)
        if nearest is None:
            return replace(accepts(charge, work, Use(), self.thresholds), answer=Answer.CHARGE_FIRST)
        parts = [self._there_and_back(post) for post in (job.from_post, job.to_post)]
        verdict = accepts(charge, work, nearest, self.thresholds, parts)
        if not verdict.is_accepted:
            return verdict
        left = max(self.thresholds.low + charge.rates.at_most(nearest), verdict.left)
        done = Need(robot.name, replace(charge, ratio=left, docked=False), self.clock.now_s + work.time_s, ways)
        if not is_no_worse(self._plan(done), self._plan()):
            return replace(verdict, answer=Answer.CHARGE_FIRST)
        self._asked[robot.name] = done
        return verdict

    def given(self, robot: Robot, job: Job) -> None:
        self._working[robot.name] = self._asked[robot.name]

    def _there_and_back(self, post: int) -> Use:
        near = min(self._ways(post).values(), key=lambda use: use.time_s)
        return near + near + Use(0.0, HANDLING_S)

    def _plan(self, instead: Need | None = None) -> DockPlan:
        """For all robots: those at work with what they will have when it is done."""
        needs = {robot.name: self._need(robot) for robot in self.robots.values()}
        if instead is not None:
            needs[instead.robot] = instead
        return plan_docks(list(needs.values()), self.campus.docks, self.curve, self.thresholds, self.clock.now_s)

    def _need(self, robot: Robot) -> Need:
        if robot.job is not None and not (robot.dock or robot.bound_for) and robot.name in self._working:
            then = self._working[robot.name]
            return replace(then, ready_s=max(then.ready_s, self.clock.now_s))
        ways = self._ways(robot.post)
        if robot.dock is not None:
            ways[robot.dock] = Use()
        dock = robot.dock or robot.bound_for
        return Need(robot.name, self._charge(robot), self.clock.now_s, ways, dock, robot.until)

    def goes_on(self, robot: Robot, post: int, leg_s: float) -> bool:
        ways = self._ways(post).values()
        leg = Use(leg_s * SPEED_M_S, SLOW * leg_s)
        charge = self._charge(robot)
        return not ways or any(goes_on(charge, leg, way, self.thresholds) for way in ways)

    def enough(self, robot: Robot, to_post: int) -> float:
        way_s = self.campus.use(robot.post, to_post).time_s
        if way_s == float("inf"):
            return self.thresholds.sufficient
        charge = self._charge(robot)
        work = Use(way_s * SPEED_M_S, SLOW * way_s + HANDLING_S)
        ways = self._ways(to_post)
        back = min(ways.values(), key=lambda use: use.time_s, default=Use())
        return accepts(charge, work, back, self.thresholds).needed

    def dock_for(self, robot: Robot) -> str | None:
        self._working.pop(robot.name, None)
        stay = self._plan().stays.get(robot.name)
        return stay and stay.dock

    def moves(self, resting: Sequence[Robot], taken: Mapping[str, str | None]) -> list[Move]:
        self._count_hour()
        wanted = round(self.demand.expected(self.clock.local, WANTED_HOURS))
        policy = TopUpPolicy(self.demand.is_quiet(self.clock.local), wanted)
        needs = [self._need(robot) for robot in resting]
        return top_ups(needs, self._plan(), taken, self.thresholds, policy, self.clock.now_s)

    def spent(self, robot: Robot, use: Use, ratio: float) -> None:
        self.rates[robot.name] = self.rates[robot.name].learned(use, ratio)

    def ordered(self) -> None:
        self._count_hour()
        self._orders += 1

    def _count_hour(self) -> None:
        if self.clock.local.hour != self._hour:
            self.demand.learn(self.clock.local.replace(hour=self._hour), self._orders)
            self._hour, self._orders = self.clock.local.hour, 0

    def _charge(self, robot: Robot) -> Charge:
        return Charge(robot.pack.told, self.rates[robot.name], robot.dock is not None, robot.recharging)

    def _ways(self, post: int) -> dict[str, Use]:
        return {dock: Use(use.way_m, SLOW * use.time_s) for dock, use in self.campus.ways_to_docks(post).items()}


class Reacting:
    """As it was: work from 30 % on, home to a dock when there is none, and the robot's own battery plan."""

    def __init__(self, campus: Campus, clock: Clockwork, robots: Mapping[str, Robot]) -> None:
        self.campus = campus
        self.thresholds = Thresholds()
        self._rates = Rates(0.0, 0.0)

    def accepts(self, robot: Robot, job: Job) -> Verdict | None:
        weak = robot.dock is not None and robot.pack.told < OWN_BEGIN
        if robot.recharging or weak or robot.pack.told < ENOUGH_CHARGE:
            return accepts(Charge(0.0, self._rates), Use(), Use(), self.thresholds)
        return None

    def given(self, robot: Robot, job: Job) -> None: ...

    def goes_on(self, robot: Robot, post: int, leg_s: float) -> bool:
        return True

    def enough(self, robot: Robot, to_post: int) -> float:
        return 0.99

    def dock_for(self, robot: Robot) -> str | None:
        return None

    def moves(self, resting: Sequence[Robot], taken: Mapping[str, str | None]) -> list[Move]:
        free = [dock for dock in self.campus.docks if dock not in taken]
        moves = []
        for robot in resting:
            ways = self.campus.ways_to_docks(robot.post)
            near = min((dock for dock in ways if dock in free), key=lambda dock: ways[dock].time_s, default=None)
            if robot.dock is None and near is not None:
                free.remove(near)
                moves.append(Move(robot.name, near))
        return moves

    def spent(self, robot: Robot, use: Use, ratio: float) -> None: ...

    def ordered(self) -> None: ...
