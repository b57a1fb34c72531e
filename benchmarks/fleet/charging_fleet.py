"""Robots that carry mail and charge, event by event: what a policy decides is done, and what comes of it is counted."""

from collections.abc import Callable, Mapping
from math import inf
from random import Random
from typing import Final

from benchmarks.fleet.charging_policies import Policy
from benchmarks.fleet.charging_world import (
    CLOSED_EVERY_S,
    CLOSED_S,
    DAY_S,
    EMPTY,
    HANDLING_S,
    OWN_BEGIN,
    OWN_FULL,
    OWN_LOW,
    Campus,
    Clockwork,
    Job,
    Robot,
    Task,
    carleton,
    orders_an_hour,
    some_robots,
)
from fleet.charging.acceptance import Answer, Verdict
from fleet.charging.energy import Use

LOOKS_EVERY_S: Final = 300.0
POLL_S: Final = 60.0
WAITS_SHARE, WAITS_S = 0.3, 120.0
"""At so many corridors others are in the way, for so long on average."""
MAKES_ROOM_WITH: Final = 0.1
TELLS_FROM: Final = 0.04
PolicyOf = Callable[[Campus, Clockwork, Mapping[str, Robot]], Policy]


class FleetRun:
    """One fleet with one policy. Of the same seed all policies get the same orders, packs and closed corridors."""

    def __init__(self, seed: int, policy: PolicyOf, robots: int = 6, orders_h: float = 2.0) -> None:
        self.campus, self.clock = carleton(), Clockwork()
        self.robots = some_robots(Random(f"{seed} robots"), self.campus, robots)
        self.policy = policy(self.campus, self.clock, self.robots)
        self.jobs: list[Job] = []
        self.waiting: list[Job] = []
        self.stranded: list[str] = []
        self.predicted: list[tuple[float, float]] = []
        """What work was said to cost at most, and what it has cost."""
        self._orders, self._traffic = Random(f"{seed} orders"), Random(f"{seed} traffic")
        self._faults = Random(f"{seed} faults")
        self._orders_h = orders_h
        self._marks = {name: (robot.pack.told, 0.0, 0.0) for name, robot in self.robots.items()}

    def run(self, days: float) -> None:
        self.clock.at(self._next_order_s(), self._order)
        self.clock.at(self._faults.expovariate(1 / CLOSED_EVERY_S), self._close)
        self.clock.at(0.0, self._look)
        self.clock.run(days * DAY_S)

    # What happens.

    def _next_order_s(self) -> float:
        """By thinning: as often as in the busiest hour, and then only as many as there are in this one."""
        at_s, most = self.clock.now_s, 3.0 * self._orders_h
        while True:
            at_s += self._orders.expovariate(most / 3600.0)
            self.clock.now_s, now_s = at_s, self.clock.now_s
            rate = orders_an_hour(self.clock.local, self._orders_h)
            self.clock.now_s = now_s
            if self._orders.random() < rate / most:
                return at_s

    def _order(self) -> None:
        from_post, to_post = self._orders.sample(range(len(self.campus.network.posts)), 2)
        job = Job(len(self.jobs), from_post, to_post, self.clock.now_s)
        self.jobs.append(job)
        self.waiting.append(job)
        self.policy.ordered()
        self.clock.at(self._next_order_s(), self._order)
        self.decide()

    def _close(self) -> None:
        name = self._faults.choice(self.campus.network.corridors)
        self.campus.closed.add(name)
        self.clock.at(self.clock.now_s + self._faults.uniform(*CLOSED_S), lambda: self.campus.closed.discard(name))
        self.clock.at(self.clock.now_s + self._faults.expovariate(1 / CLOSED_EVERY_S), self._close)

    def _look(self) -> None:
        self.clock.at(self.clock.now_s + LOOKS_EVERY_S, self._look)
        for robot in self.robots.values():
            if robot.task is None:
                self._settle(robot)
                robot.pack.wear(LOOKS_EVERY_S / DAY_S)
                if robot.dock is None and robot.pack.told < OWN_LOW:
                    self._begin(robot, self._charge(robot, lambda: OWN_FULL, by_itself=True))
        self.decide()

    # What is decided.

    def decide(self) -> None:
        for robot in self.robots.values():
            if robot.task is None:
                self._settle(robot)
        for job in list(self.waiting):
            self._give(job)
        resting = [robot for robot in self.robots.values() if robot.task is None]
        for move in self.policy.moves(resting, self._taken()):
            robot = self.robots[move.robot]
            self._begin(robot, self._top_up(robot, move.dock))

    def _taken(self) -> dict[str, str | None]:
        robots = self.robots.values()
        standing = {robot.dock: robot.name if _is_resting(robot) else None for robot in robots if robot.dock}
        return {**standing, **{robot.bound_for: None for robot in robots if robot.bound_for}}

    def _give(self, job: Job) -> None:
        idle = [robot for robot in self.robots.values() if robot.task is None and not robot.recharging]
        way_s = self.campus.now_open.shortest_s
        able = [one for one in idle if way_s[one.post][job.from_post] + way_s[job.from_post][job.to_post] < inf]
        on_the_way = None
        for robot in sorted(able, key=lambda one: (way_s[one.post][job.from_post], one.name)):
            verdict = self.policy.accepts(robot, job)
            if verdict is None or verdict.answer is Answer.YES:
                self._start(robot, job, verdict)
                return
            if verdict.is_accepted and on_the_way is None:
                on_the_way = robot, verdict
        if on_the_way is not None:
            self._start(on_the_way[0], job, on_the_way[1])
            return
        job.kept_waiting_by_charge |= bool(idle) or any(robot.recharging for robot in self.robots.values())

    def _start(self, robot: Robot, job: Job, verdict: Verdict | None) -> None:
        self.waiting.remove(job)
        job.robot, job.begun_s = robot.name, self.clock.now_s
        job.planned = verdict is not None and verdict.answer is Answer.ON_THE_WAY
        self.policy.given(robot, job)
        most = None if verdict is None or job.planned else robot.pack.told - verdict.left
        self._begin(robot, self._carry(robot, job, most))

    # What robots do.

    def _begin(self, robot: Robot, task: Task) -> None:
        robot.task = task
        self._step(robot)

    def _step(self, robot: Robot) -> None:
        assert robot.task is not None
        try:
            pause_s = next(robot.task)
        except StopIteration:
            robot.task = robot.job = robot.bound_for = None
            robot.at_s = self.clock.now_s
            self.clock.at(self.clock.now_s, self.decide)
        else:
            self.clock.at(self.clock.now_s + pause_s, lambda: self._step(robot))

    def _carry(self, robot: Robot, job: Job, most: float | None) -> Task:
        robot.job, before = job, robot.pack.ratio
        self._undock(robot)
        for post in (job.from_post, job.to_post):
            yield from self._go(robot, post, job)
            yield from self._stand(robot, HANDLING_S)
        job.done_s = self.clock.now_s
        if most is not None and not job.unplanned:
            self.predicted.append((most, before - robot.pack.ratio))

    def _go(self, robot: Robot, to: int, job: Job | None = None) -> Task:
        """To a post; with a job it breaks off to charge where it must."""
        while robot.post != to:
            lane = self.campus.next_lane(robot.post, to)
            if job is not None and not self._has_enough_for(robot, lane.travel_s if lane else 0.0, lane):
                job.unplanned |= not job.planned
                if robot.pack.told < OWN_LOW:
                    yield from self._charge(robot, lambda: OWN_FULL, by_itself=True)
                else:
                    yield from self._charge(robot, lambda: self._enough(robot, to), by_itself=False)
                self._undock(robot)
                continue
            if lane is None:
                yield from self._stand(robot, POLL_S)
                continue
            if self._traffic.random() < WAITS_SHARE:
                yield from self._stand(robot, self._traffic.expovariate(1 / WAITS_S))
            yield from self._drive(robot, lane.end, lane.travel_s * self._traffic.uniform(0.8, 1.2))
            robot.driven_m += self.campus.length_m[lane.corridor]
            self._tell(robot)

    def _has_enough_for(self, robot: Robot, leg_s: float, lane: object) -> bool:
        if robot.pack.told < OWN_LOW:
            return False
        end = robot.post if lane is None else lane.end  # type: ignore[attr-defined]
        return self.policy.goes_on(robot, end, leg_s)

    def _charge(self, robot: Robot, enough: Callable[[], float], *, by_itself: bool) -> Task:
        """In a dock until it has enough: by its own battery plan in the nearest, taken or not."""
        robot.recharging, robot.until = by_itself, OWN_FULL
        while robot.dock is None:
            ways = self.campus.ways_to_docks(robot.post)
            if not ways:
                yield from self._stand(robot, POLL_S)
                continue
            nearest = min(ways, key=lambda one: ways[one].time_s)
            robot.bound_for = nearest if by_itself else self.policy.dock_for(robot) or nearest
            yield from self._go(robot, self.campus.docks[robot.bound_for])
            if not self._dock(robot, robot.bound_for):
                yield from self._stand(robot, POLL_S)
        robot.bound_for, robot.until = None, enough()
        while robot.pack.told < robot.until:
            yield POLL_S
            robot.pack.charge(POLL_S)
        robot.recharging, robot.until = False, OWN_BEGIN
        self._mark(robot)

    def _enough(self, robot: Robot, to_post: int) -> float:
        return max(OWN_BEGIN, min(OWN_FULL, self.policy.enough(robot, to_post) + 0.02))

    def _top_up(self, robot: Robot, dock: str) -> Task:
        robot.bound_for = dock
        yield from self._go(robot, self.campus.docks[dock])
        if not self._dock(robot, dock):
            yield from self._stand(robot, POLL_S)

    # Their charge.

    def _stand(self, robot: Robot, time_s: float) -> Task:
        yield time_s
        robot.pack.stand(time_s)
        self._see_if_stranded(robot)

    def _drive(self, robot: Robot, post: int, time_s: float) -> Task:
        yield time_s
        robot.pack.drive(time_s)
        robot.post = post
        self._see_if_stranded(robot)

    def _settle(self, robot: Robot) -> None:
        """Of a robot that does nothing: it stands or it charges."""
        time_s, robot.at_s = self.clock.now_s - robot.at_s, self.clock.now_s
        if robot.dock is None:
            robot.pack.stand(time_s)
            self._see_if_stranded(robot)
        else:
            robot.pack.charge(time_s)

    def _see_if_stranded(self, robot: Robot) -> None:
        if robot.pack.ratio <= EMPTY:
            self.stranded.append(robot.name)
            robot.pack.ratio = 0.5  # a person carries it away and brings it back
            self._mark(robot)

    def _dock(self, robot: Robot, dock: str) -> bool:
        """Dock it; an idle robot in the dock that has more makes room."""
        for other in self.robots.values():
            if other.dock == dock:
                if not _is_resting(other) or other.pack.told < robot.pack.told + MAKES_ROOM_WITH:
                    return False
                self._settle(other)
                self._undock(other)
        robot.dock, robot.at_s = dock, self.clock.now_s
        return True

    def _undock(self, robot: Robot) -> None:
        if robot.dock is not None:
            robot.dock = None
            self._mark(robot)

    def _mark(self, robot: Robot) -> None:
        self._marks[robot.name] = (robot.pack.told, robot.driven_m, self.clock.now_s)

    def _tell(self, robot: Robot) -> None:
        told, driven_m, at_s = self._marks[robot.name]
        spent = told - robot.pack.told
        if spent >= TELLS_FROM:
            self.policy.spent(robot, Use(robot.driven_m - driven_m, self.clock.now_s - at_s), spent)
            self._mark(robot)


def _is_resting(robot: Robot) -> bool:
    return robot.task is None and not robot.recharging
