"""True places of robots: bodies may not overlap, and no two may ever be in one corridor.

It is read from the simulated world, without the service and without what robots believe.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

from demo.settings import DemoFailed
from maps import CampusMap, Corridor
from maps.geometry import Point, distance_m, distance_to_path_m
from robot.simulated import CollisionJudge, PoseLog, TruePose, WorldFile

AT_POST_M = 0.8
"""So near to a post a robot counts as at it; also in its bays and docks."""


@dataclass(frozen=True)
class Somewhere:
    """At a post, or in a corridor."""

    post: str | None = None
    corridor: Corridor | None = None

    def __str__(self) -> str:
        return f"at {self.post}" if self.corridor is None else f"in {self.corridor.name}"


class TruePlaces:
    """The true places of all robots in the world of `file`; their way is written into `log`.

    `ghosts`: two in one place are counted and raise nothing.
    """

    def __init__(self, campus: CampusMap, file: Path, log: Path, ghosts: bool = False) -> None:
        self._campus, self._world, self._log, self._ghosts = campus, WorldFile(file), PoseLog(log), ghosts
        self.judge = CollisionJudge()
        self.seen: dict[str, Somewhere] = {}
        self.moves = 0
        """How often a robot went from a post into a corridor, or out of it."""
        self.most_at_once = 0
        """How many corridors had a robot in them at one moment, at most."""
        self.looks = 0
        self.met = 0
        """How often two came into one corridor."""
        self._poses: dict[str, TruePose] = {}
        self._inside: set[tuple[str, str, str]] = set()

    @property
    def poses(self) -> Mapping[str, TruePose]:
        """Return where every body was at the last look."""
        return self._poses

    @property
    def inside(self) -> int:
        """Return the number of robots that are in a corridor now."""
        return sum(here.corridor is not None for here in self.seen.values())

    def look(self) -> None:
        """See where every robot is now. Raises DemoFailed if two are where only one may be."""
        poses = self._world.poses()
        self._log.note(poses)
        self.judge.look(poses)
        for robot, pose in poses.items():
            if robot not in self._poses or _moved(pose, self._poses[robot]):
                self._place(robot, somewhere(self._campus, Point(pose.x_m, pose.y_m)))
        self._poses = poses
        self.looks += 1
        self.most_at_once = max(self.most_at_once, self.inside)
        self._check()

    def _place(self, robot: str, here: Somewhere) -> None:
        self.moves += robot in self.seen and self.seen[robot] != here
        self.seen[robot] = here

    def _check(self) -> None:
        inside = set(meetings(self.seen))
        self.met += len(inside - self._inside)
        self._inside = inside
        if self._ghosts:
            return
        for overlap in self.judge.overlaps:
            raise DemoFailed(f"{overlap}. The way of every robot is in true_poses.csv.")
        for one, other, corridor in inside:
            raise DemoFailed(f"{one} and {other} are both in the corridor {corridor}.")

    def close(self) -> None:
        self._log.close()
        self._world.close()


def somewhere(campus: CampusMap, point: Point) -> Somewhere:
    """The post that is near or whose spur is the nearest tape, else the corridor whose tape is nearest."""
    nearest = min(campus.posts.values(), key=lambda post: distance_m(post.point, point))
    if distance_m(nearest.point, point) <= AT_POST_M:
        return Somewhere(post=nearest.name)
    line = min(campus.track.corridors, key=lambda one: distance_to_path_m(point, one.tape))
    if line in campus.corridors:
        return Somewhere(corridor=line)
    return Somewhere(post=campus.address_of(line.a))


def meetings(places: Mapping[str, Somewhere]) -> Iterator[tuple[str, str, str]]:
    """Every two robots in one corridor that is for one at a time, and its name."""
    inside = {robot: here.corridor for robot, here in places.items() if here.corridor is not None}
    for (one, corridor), (other, same) in combinations(sorted(inside.items()), 2):
        if corridor == same and corridor.following_s is None:
            yield one, other, corridor.name


def _moved(pose: TruePose, before: TruePose) -> bool:
    return (pose.x_m, pose.y_m) != (before.x_m, before.y_m)
