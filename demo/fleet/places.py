"""True places of robots, by their simulated worlds: no two may ever be in one corridor.

The bodies are simulated apart from each other: they would drive through each other and feel nothing. So it is looked
at here, without the service and without what robots believe.
"""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import combinations
from pathlib import Path

from demo.settings import DemoFailed
from maps import CampusMap, Corridor
from maps.geometry import Point, distance_m, distance_to_path_m

AT_POST_M = 0.8
"""So near to a post a robot counts as at it, on the line, in its bay or in its dock."""


@dataclass(frozen=True)
class Somewhere:
    """At a post, or in a corridor."""

    post: str | None = None
    corridor: Corridor | None = None

    def __str__(self) -> str:
        return f"at {self.post}" if self.corridor is None else f"in {self.corridor.name}"


@dataclass
class TruePlaces:
    """The true places of all robots. `files`: where each one's world keeps its pose, twice a simulated second."""

    campus: CampusMap
    files: Mapping[str, Path]
    seen: dict[str, Somewhere] = field(default_factory=dict)
    moves: int = 0
    """How often a robot went from a post into a corridor, or out of it."""
    most_at_once: int = 0
    """How many corridors had a robot in them at one moment, at most."""
    looks: int = 0
    met: int = 0
    """How often two were in one corridor."""

    @property
    def inside(self) -> int:
        """Return the number of robots that are in a corridor now."""
        return sum(here.corridor is not None for here in self.seen.values())

    def look(self) -> None:
        """See where everybody is now. Raises DemoFailed if two are where only one may be."""
        for robot, file in self.files.items():
            point = _point_in(file)
            if point is None:
                continue
            here = somewhere(self.campus, point)
            self.moves += robot in self.seen and self.seen[robot] != here
            self.seen[robot] = here
        self.looks += 1
        self.most_at_once = max(self.most_at_once, self.inside)
        for one, other, corridor in collisions(self.seen):
            self.met += 1
            raise DemoFailed(f"{one} and {other} are both in the corridor {corridor}: they would have collided.")


def somewhere(campus: CampusMap, point: Point) -> Somewhere:
    """The post that is near, else the corridor whose tape is nearest."""
    nearest = min(campus.posts.values(), key=lambda post: distance_m(post.point, point))
    if distance_m(nearest.point, point) <= AT_POST_M:
        return Somewhere(post=nearest.name)
    return Somewhere(corridor=min(campus.corridors, key=lambda one: distance_to_path_m(point, one.tape)))


def collisions(places: Mapping[str, Somewhere]) -> Iterator[tuple[str, str, str]]:
    """Every two robots in one corridor that is for one at a time, and its name."""
    inside = {robot: here.corridor for robot, here in places.items() if here.corridor is not None}
    for (one, corridor), (other, same) in combinations(inside.items(), 2):
        if corridor == same and corridor.following_s is None:
            yield one, other, corridor.name


def _point_in(file: Path) -> Point | None:
    """None as long as that world has not begun."""
    try:
        saved = json.loads(file.read_bytes())
    except (FileNotFoundError, ValueError):
        return None
    return Point(saved["x_m"], saved["y_m"])
