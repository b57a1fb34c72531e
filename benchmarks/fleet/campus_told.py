"""What people are told of their orders, and how true it was: `app.estimates` on the traffic's own timetable.

Corridors and hand-overs are learned from what robots tell, as `app/estimates/learning.py` does it. An order that has
no robot yet is estimated as robots will have charged for it, one after the other (`app/dispatch/planning/ahead.py`).
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from random import Random
from typing import Final

from app.dispatch.planning.scene import Routes, Scene
from app.dispatch.planning.timing import time_first
from app.estimates.arrivals import Estimates
from app.estimates.calibration import Basis, Calibrations
from app.estimates.durations import Durations, Kind, Thing
from app.estimates.forecast import Chance, forecast
from app.estimates.intervals import Interval, around
from app.estimates.score import Truth
from app.traffic.journey import Goal, Journey, Task
from app.traffic.network import Lane, Network
from benchmarks.fleet.campus_ground import ASSUMED_HANDOVER_S, ASSUMED_M_S, Ground, is_attended
from maps.ways import Ways

KINDS: Final = {"load": Kind.LOAD, "receive": Kind.RECEIVE}


@dataclass(frozen=True)
class Promise:
    """`placed_s`: when it was made."""

    placed_s: float
    basis: Basis
    raw: Interval
    told: Interval
    by_map: Interval


@dataclass
class Told:
    """`scored`: each truth that came, beside what was told of it; `raw`: beside what was worked out."""

    ground: Ground
    rng: Random
    durations: Durations = field(default_factory=Durations)
    calibrations: Calibrations = field(default_factory=Calibrations)
    promises: dict[str, Promise] = field(default_factory=dict)
    scored: list[Truth] = field(default_factory=list)
    raw: list[Truth] = field(default_factory=list)
    not_planned: int = 0
    _charge_s: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._by_map = Estimates(Ways(self.ground.campus), ASSUMED_M_S, ASSUMED_HANDOVER_S)

    # What robots tell.

    def drove(self, lane: Lane, seconds: float) -> None:
        self.durations.observe(corridor(lane), seconds)

    def handed_over(self, kind: Kind, arrived_s: float, seconds: float) -> None:
        self.durations.observe(handling(kind, arrived_s), seconds)

    def arrived(self, key: str) -> None:
        """A robot is at its recipient's with this mail."""
        promise = self.promises.pop(key, None)
        if promise is not None:
            truth_s = self._now_s - promise.placed_s
            self.calibrations.of[promise.basis].learn(promise.raw, promise.told, truth_s)
            self.scored.append(Truth(promise.told, promise.by_map, truth_s))
            self.raw.append(Truth(promise.raw, promise.by_map, truth_s))

    # What is told.

    def promise(self, key: str, start: int, end: int, scene: Scene, ahead: Callable[[], Routes]) -> None:
        """For an order that was placed now. `scene`: as it is decided already; `ahead`: what is likely to follow."""
        posts = self.ground.network.posts
        by_map = self._by_map.promise(posts[start], posts[end], self.ground.clock.local).by_map
        basis = Basis.TIMETABLE if _is_kept(key, scene) else Basis.NO_ROBOT_YET
        raw = self._in_plan(key, scene, ahead)
        if raw is None:
            self.not_planned += 1
            raw = by_map
        told = self.calibrations.of[basis].corrected(raw)
        self.promises[key] = Promise(self._now_s, basis, raw, told, by_map)

    def _in_plan(self, key: str, scene: Scene, ahead: Callable[[], Routes]) -> Interval | None:
        if (kept := scene.kept) is not None and _is_kept(key, scene):
            tasks = {name: robot.task(robot.route) for name, robot in scene.robots.items()}
            tasks = {name: replace(task, goals=kept.goals[name]) for name, task in tasks.items()}
            return self._forecast(scene.network, tasks, dict(kept.timetable.journeys))[key]
        timed = time_first(scene, ahead())
        if timed is None or timed.refused:
            return None
        found = self._forecast(scene.network, dict(timed.tasks), dict(timed.timetable.journeys)).get(key)
        return None if found is None else around(found.p50_s)

    def _forecast(self, network: Network, tasks: dict[str, Task], journeys: dict[str, Journey]) -> dict[str, Interval]:
        durations, now_s, rng = self.durations, self._now_s, self.rng

        def handling_s(goal: Goal) -> float:
            kind = KINDS.get(goal.key.rpartition("-")[2])
            return goal.handling_s if kind is None else durations.draw_s(handling(kind, now_s), rng)

        chance = Chance(
            lambda _, lane: durations.draw_s(corridor(lane), rng),
            handling_s,
            lambda _, lane, entered_s: entered_s + durations.draw_s(corridor(lane), rng, now_s - entered_s),
        )
        return forecast(network, tasks, journeys, now_s, chance)

    @property
    def _now_s(self) -> float:
        return self.ground.clock.now_s


def _is_kept(key: str, scene: Scene) -> bool:
    return scene.kept is not None and any(goal.key == key for goals in scene.kept.goals.values() for goal in goals)


def corridor(lane: Lane) -> Thing:
    return Thing(Kind.CORRIDOR, f"{lane.start} {lane.end}", lane.travel_s)


def handling(kind: Kind, now_s: float) -> Thing:
    return Thing(kind, "attended" if is_attended(now_s) else "not attended", ASSUMED_HANDOVER_S)
