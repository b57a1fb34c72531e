"""The judge: overlapping bodies, and corridors entered without a grant; places are true poses alone."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final

from maps import CampusMap
from maps.geometry import Point, distance_to_path_m
from robot.simulated.collisions import CollisionJudge
from robot.simulated.true_poses import TruePose

CROSSING_M: Final = 0.4
IN_LINE_M: Final = 0.15


@dataclass
class TrueFloor:
    """All robots of one run."""

    track: CampusMap
    collisions: CollisionJudge = field(default_factory=CollisionJudge)
    ungranted: list[str] = field(default_factory=list)
    longest_on_crossing_s: float = 0.0
    driven_m: float = 0.0
    _handled: dict[str, int] = field(default_factory=dict)
    _in: dict[str, str | None] = field(default_factory=dict)
    _crossing_since: dict[str, tuple[str, float]] = field(default_factory=dict)
    _last: dict[str, TruePose] = field(default_factory=dict)

    def look(self, poses: Mapping[str, TruePose]) -> None:
        self.collisions.look(poses)
        for name, pose in poses.items():
            before = self._last.get(name)
            moved_m = math.dist((before.x_m, before.y_m), (pose.x_m, pose.y_m)) if before else 0.0
            self.driven_m += moved_m if before and before.handled == pose.handled else 0.0
            self._last[name] = pose
            self._look_at_crossing(name, pose)

    def _look_at_crossing(self, name: str, pose: TruePose) -> None:
        posts = (post for post in self.track.posts.values() if self.track.bays_of(post.name))
        here = next((post.name for post in posts if math.dist(post.point, (pose.x_m, pose.y_m)) < CROSSING_M), None)
        if here is None:
            self._crossing_since.pop(name, None)
            return
        post, since_s = self._crossing_since.setdefault(name, (here, pose.time_s))
        if post != here:
            self._crossing_since[name] = here, pose.time_s
        else:
            self.longest_on_crossing_s = max(self.longest_on_crossing_s, pose.time_s - since_s)

    def look_at_grants(self, poses: Mapping[str, TruePose], granted: Mapping[str, set[str]]) -> None:
        """`granted`: as the database has it, robot → corridors and spurs of the track, by name. Where a person puts a
        robot it did not enter."""
        for name, pose in poses.items():
            corridor = self._corridor(pose)
            entered, self._in[name] = corridor != self._in.get(name), corridor
            carried, self._handled[name] = pose.handled != self._handled.get(name, pose.handled), pose.handled
            if entered and not carried and corridor and corridor not in granted.get(name, ()):
                self.ungranted.append(f"{name} in {corridor} at {pose.time_s:.0f} s")

    def _corridor(self, pose: TruePose) -> str | None:
        here = Point(pose.x_m, pose.y_m)
        if min(math.dist(post.point, here) for post in self.track.posts.values()) < CROSSING_M:
            return None
        off_m, name = min((distance_to_path_m(here, one.tape), one.name) for one in self.track.corridors)
        return name if off_m < IN_LINE_M else None
