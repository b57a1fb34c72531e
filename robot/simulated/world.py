"""The world around the robots: floor with tape, docks, markers, obstacles. Several robots can share one."""

from collections.abc import Iterable, Iterator
from itertools import chain
from random import Random
from typing import Protocol

from maps import CampusMap, Dock, Marker
from robot.simulated.base.docking import Beside, beside
from robot.simulated.floor import Floor
from robot.simulated.obstacles import Contact, Obstacle, contact
from robot.simulated.true_poses import TruePose

# Farther away nothing touches and nothing is seen by the light bumpers.
NEAR_M = 2.0


class Resident(Obstacle, Protocol):
    """A robot of this process."""

    @property
    def true_pose(self) -> TruePose: ...


class World:
    """`obstacles` may be changed at any time between steps; `gap_m` > 0 wears holes into the tape."""

    def __init__(
        self, campus: CampusMap, obstacles: Iterable[Obstacle] = (), gap_m: float = 0.0, seed: int = 0
    ) -> None:
        self.campus = campus
        self.floor = Floor(campus.track, gap_m, Random(f"{seed}/gaps"))
        self.obstacles = list(obstacles)
        self.robots: list[Obstacle] = []
        self.docks: tuple[Dock, ...] = tuple(place.dock for place in campus.track.docks() if place.dock)
        self.markers: tuple[Marker, ...] = tuple(
            marker for place in campus.track.posts.values() for marker in place.markers
        )

    def dock_beside(self, x_m: float, y_m: float, heading_rad: float) -> Beside | None:
        """Return the nearest dock's relation to a robot at this pose, if one is within sight of its beams."""
        nearest = min(self.docks, key=lambda dock: abs(dock.x_m - x_m) + abs(dock.y_m - y_m), default=None)
        if nearest is None or max(abs(nearest.x_m - x_m), abs(nearest.y_m - y_m)) > NEAR_M:
            return None
        return beside(nearest, x_m, y_m, heading_rad)

    def contacts(self, me: Obstacle, x_m: float, y_m: float, heading_rad: float) -> list[Contact]:
        """Every obstacle and every other robot near this pose, as `me` would meet it there."""
        others = chain(self.obstacles, self.others(me)) if len(self.robots) > 1 else self.obstacles
        return [contact(one, x_m, y_m, heading_rad) for one in others if _is_near(one, x_m, y_m)]

    def others(self, me: Obstacle) -> Iterator[Obstacle]:
        """Every robot but this one."""
        return (one for one in self.robots if one is not me)

    def moved(self, robot: Resident) -> None:
        """Called after each step of a robot of this process: how a shared world learns of it."""


def _is_near(one: Obstacle, x_m: float, y_m: float) -> bool:
    near_x_m, near_y_m, radius_m = one.nearest(x_m, y_m)
    return max(abs(near_x_m - x_m), abs(near_y_m - y_m)) < NEAR_M + radius_m
