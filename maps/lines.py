"""The lines on which bodies move: each corridor, and each spur with the way on into its dock."""

from dataclasses import dataclass
from functools import cached_property

from maps.bays import WAITS_BEFORE_CROSSING_M
from maps.campus_map import CampusMap, Corridor, Post
from maps.geometry import Point, part_of_path, path_length_m

Box = tuple[float, float, float, float]
"""Left, bottom, right, top, metres."""


@dataclass(frozen=True)
class Line:
    """`posts`: where it meets other lines; `path`: where the axle of a robot is, from post to post or into the dock.

    `bay`: the bay of a spur.
    """

    corridor: Corridor
    posts: frozenset[str]
    path: tuple[Point, ...]
    bay: Post | None = None

    def __str__(self) -> str:
        return f"the spur of {self.bay.name}" if self.bay else f"the corridor {self.corridor.name}"

    @property
    def place(self) -> str:
        """What the map file calls it."""
        return self.bay.name if self.bay else self.corridor.name

    @property
    def clear_of_crossings(self) -> tuple[Point, ...]:
        """Where a robot is that holds no crossing: in the bay or its dock, in a corridor between the waiting points.

        Empty in a corridor too short for that.
        """
        if self.bay:
            return self.path[1], self.path[-1]
        length_m = path_length_m(self.path)
        if length_m < 2 * WAITS_BEFORE_CROSSING_M:
            return ()
        return part_of_path(self.path, WAITS_BEFORE_CROSSING_M, length_m - WAITS_BEFORE_CROSSING_M)

    def is_far_from(self, box: Box, by_m: float) -> bool:
        """A quick answer for most of the map."""
        left_m, bottom_m, right_m, top_m = self.box
        its_left_m, its_bottom_m, its_right_m, its_top_m = box
        return max(its_left_m - right_m, left_m - its_right_m, its_bottom_m - top_m, bottom_m - its_top_m) > by_m

    @cached_property
    def box(self) -> Box:
        xs, ys = zip(*self.path, strict=True)
        return min(xs), min(ys), max(xs), max(ys)


def lines_of(campus: CampusMap) -> tuple[Line, ...]:
    """Every line of the map, in the order of the file, corridors first."""
    track = campus.track
    return tuple(_line(track, corridor) for corridor in track.corridors)


def _line(track: CampusMap, corridor: Corridor) -> Line:
    bay = next((place for end in (corridor.a, corridor.b) if (place := track.post(end)).bay_of), None)
    if bay is None:
        return Line(corridor, frozenset((corridor.a, corridor.b)), corridor.tape)
    post = corridor.other(bay.name)
    dock = (Point(bay.dock.x_m, bay.dock.y_m),) if bay.dock else ()
    return Line(corridor, frozenset((post,)), (*corridor.tape_from(post), *dock), bay)
