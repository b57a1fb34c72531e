"""The judge of bodies: which robots touched or overlapped, by true poses alone.

It knows no service, no daemon and no contact of the simulation: two circles of the bumper's radius, and how far apart
their middles are.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import combinations

from maps.bays import MARKER_BEFORE_BAY_M
from robot.simulated.obstacles import BUMPER_RADIUS_M
from robot.simulated.true_poses import TruePose

TOUCH_MM = 2.0
OVERLAP_MM = 5.0
"""Deeper than that is no touch any more. Bodies of two processes may each go on for a step of 1 mm at first contact."""
APART_MM = 10.0
PUT_DOWN_M = MARKER_BEFORE_BAY_M + 0.05
"""A robot is where a person put it until it has gone this far from there: it goes on to the marker of its bay."""


@dataclass
class Collision:
    """Two bodies that touch or overlap, from `began_s` on; (x_m, y_m) is between them where they were nearest.

    `by_hand`: a person had put one of them where it was met.
    """

    one: str
    other: str
    began_s: float
    by_hand: bool
    depth_mm: float = -math.inf
    x_m: float = 0.0
    y_m: float = 0.0
    lasted_s: float = 0.0

    @property
    def is_overlap(self) -> bool:
        return self.depth_mm > OVERLAP_MM

    def __str__(self) -> str:
        how = f"overlap by {self.depth_mm:.0f} mm" if self.is_overlap else "touch"
        hand = ", where a person had put one" if self.by_hand else ""
        return (
            f"{self.one} and {self.other} {how} at ({self.x_m:.2f}, {self.y_m:.2f}){hand}, "
            f"from {self.began_s:.1f} s on for {self.lasted_s:.1f} s"
        )


@dataclass
class CollisionJudge:
    """`look` at the poses of one moment, often; `found` holds every collision, also the present ones."""

    found: list[Collision] = field(default_factory=list)
    _present: dict[tuple[str, str], Collision] = field(default_factory=dict)
    _seen: dict[str, TruePose] = field(default_factory=dict)
    _put_down: dict[str, TruePose] = field(default_factory=dict)

    @property
    def overlaps(self) -> list[Collision]:
        """Overlaps that no person has caused."""
        return [one for one in self.found if one.is_overlap and not one.by_hand]

    @property
    def touches(self) -> int:
        """Return the number of collisions that no person has caused, overlaps among them."""
        return sum(not one.by_hand for one in self.found)

    def look(self, poses: Mapping[str, TruePose]) -> None:
        for name, pose in poses.items():
            self._follow_hands(name, pose)
        met = set()
        for pair, depth_mm in _depths(poses):
            if depth_mm < (-APART_MM if pair in self._present else -TOUCH_MM):
                continue
            met.add(pair)
            self._note(pair, depth_mm, poses)
        for pair in self._present.keys() - met:
            del self._present[pair]
        self._seen.update(poses)

    def _note(self, pair: tuple[str, str], depth_mm: float, poses: Mapping[str, TruePose]) -> None:
        one, other = poses[pair[0]], poses[pair[1]]
        now_s = max(one.time_s, other.time_s)
        if pair not in self._present:
            by_hand = any(name in self._put_down or name not in self._seen for name in pair)
            self._present[pair] = Collision(*pair, now_s, by_hand)
            self.found.append(self._present[pair])
        collision = self._present[pair]
        collision.lasted_s = now_s - collision.began_s
        if depth_mm > collision.depth_mm:
            collision.depth_mm = depth_mm
            collision.x_m, collision.y_m = (one.x_m + other.x_m) / 2, (one.y_m + other.y_m) / 2

    def _follow_hands(self, name: str, pose: TruePose) -> None:
        before, put_down = self._seen.get(name), self._put_down.get(name)
        if before is not None and pose.handled != before.handled:
            self._put_down[name] = pose
        elif put_down is not None and math.dist((pose.x_m, pose.y_m), (put_down.x_m, put_down.y_m)) > PUT_DOWN_M:
            del self._put_down[name]


def _depths(poses: Mapping[str, TruePose]) -> Iterator[tuple[tuple[str, str], float]]:
    """Every two robots, and how far their bodies reach into each other, in mm; negative: the gap between them."""
    for (one, here), (other, there) in combinations(sorted(poses.items()), 2):
        apart_m = math.dist((here.x_m, here.y_m), (there.x_m, there.y_m))
        yield (one, other), 1000 * (2 * BUMPER_RADIUS_M - apart_m)
