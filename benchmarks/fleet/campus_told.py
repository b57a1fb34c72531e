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
from app.estimates.calibration import Basis
from app.estimates.durations import Kind, Thing
from app.estimates.forecast import forecast
from app.estimates.intervals import Interval, around
from app.traffic.journey import Goal, Journey, Task
from app.traffic.network import Lane, Network
from benchmarks.fleet.campus_ground import ASSUMED_HANDOVER_S, ASSUMED_M_S, Ground, is_attended
from benchmarks.fleet.promises import Promises, handling
from maps.ways import Ways

KINDS: Final = {"load": Kind.LOAD, "receive": Kind.RECEIVE}


@dataclass
class Told:
    ground: Ground
    rng: Random
    promises: Promises = field(default_factory=Promises)
    not_planned: int = 0

    def __post_init__(self) -> None:
        self._by_map = Estimates(Ways(self.ground.campus), ASSUMED_M_S, ASSUMED_HANDOVER_S)

    # What robots tell.

    def drove(self, lane: Lane, seconds: float) -> None:
        self.promises.drove(lane, seconds)

    def handed_over(self, kind: Kind, arrived_s: float, seconds: float) -> None:
        self.promises.durations.observe(_handling(kind, arrived_s), seconds)

    def arrived(self, key: str) -> None:
        self.promises.came(key, self._now_s)

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
        self.promises.make(key, self._now_s, basis, raw, by_map)

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
        durations, now_s, rng = self.promises.durations, self._now_s, self.rng

        def handling_s(goal: Goal) -> float:
            kind = KINDS.get(goal.key.rpartition("-")[2])
            return goal.handling_s if kind is None else durations.draw_s(_handling(kind, now_s), rng)

        return forecast(network, tasks, journeys, now_s, self.promises.chance(rng, now_s, handling_s))

    @property
    def _now_s(self) -> float:
        return self.ground.clock.now_s


def _is_kept(key: str, scene: Scene) -> bool:
    return scene.kept is not None and any(goal.key == key for goals in scene.kept.goals.values() for goal in goals)


def _handling(kind: Kind, now_s: float) -> Thing:
    return handling(kind, is_attended=is_attended(now_s), assumed_s=ASSUMED_HANDOVER_S)
