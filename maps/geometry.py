"""Plane geometry of a map: metres, x to the east, y to the north; headings in radians, counter-clockwise from east."""

import math
from itertools import pairwise
from typing import NamedTuple


class Point(NamedTuple):
    x_m: float
    y_m: float


Segment = tuple[Point, Point]


def distance_m(a: Point, b: Point) -> float:
    return math.hypot(b.x_m - a.x_m, b.y_m - a.y_m)


def heading_rad(a: Point, b: Point) -> float:
    """The way from a to b, in (−π, π]."""
    return math.atan2(b.y_m - a.y_m, b.x_m - a.x_m)


def wrapped(angle_rad: float) -> float:
    """The same angle in (−π, π]; positive is a turn to the left."""
    return math.pi - (math.pi - angle_rad) % math.tau


def moved(start: Point, heading_rad: float, ahead_m: float, left_m: float = 0.0) -> Point:
    """Where one stands after going ahead and then sideways, still looking along `heading_rad`."""
    along, across = math.cos(heading_rad), math.sin(heading_rad)
    return Point(start.x_m + ahead_m * along - left_m * across, start.y_m + ahead_m * across + left_m * along)


def seen_from(origin: Point, heading_rad: float, point: Point) -> tuple[float, float]:
    """(ahead_m, left_m) of a point as seen from `origin` along `heading_rad`."""
    dx, dy = point.x_m - origin.x_m, point.y_m - origin.y_m
    along, across = math.cos(heading_rad), math.sin(heading_rad)
    return dx * along + dy * across, dy * along - dx * across


def path_length_m(path: tuple[Point, ...]) -> float:
    return sum(distance_m(a, b) for a, b in pairwise(path))


def distance_to_path_m(point: Point, path: tuple[Point, ...]) -> float:
    return min(_distance_to_segment_m(point, a, b) for a, b in pairwise(path))


def _distance_to_segment_m(point: Point, a: Point, b: Point) -> float:
    length_m = distance_m(a, b)
    ahead_m, left_m = seen_from(a, heading_rad(a, b), point)
    beyond_m = ahead_m - min(max(ahead_m, 0.0), length_m)
    return math.hypot(beyond_m, left_m)


def distance_between_paths_m(a: tuple[Point, ...], b: tuple[Point, ...]) -> float:
    """0 where they cross."""
    pairs = [(one, other) for one in pairwise(a) for other in pairwise(b)]
    if any(cross(one, other) for one, other in pairs):
        return 0.0
    return min(distance_to_path_m(point, path) for ends, path in ((a, b), (b, a)) for point in ends)


def cross(one: Segment, other: Segment) -> bool:
    """Do the two have a point in common that is no end of either?"""
    return _on_both_sides(one, other) and _on_both_sides(other, one)


def _on_both_sides(line: Segment, ends: Segment) -> bool:
    (_, left_m), (_, right_m) = (seen_from(line[0], heading_rad(*line), end) for end in ends)
    return left_m * right_m < 0


def part_of_path(path: tuple[Point, ...], from_m: float, to_m: float) -> tuple[Point, ...]:
    """The piece between two lengths along the path, both within it."""
    corners, along_m = [], 0.0
    for here, there in pairwise(path):
        if from_m < along_m < to_m:
            corners.append(here)
        along_m += distance_m(here, there)
    return (point_along(path, from_m), *corners, point_along(path, to_m))


def point_along(path: tuple[Point, ...], length_m: float) -> Point:
    """The point so far along the path; beyond its end, straight on."""
    for here, there in pairwise(path[:-1]):
        leg_m = distance_m(here, there)
        if length_m <= leg_m:
            return moved(here, heading_rad(here, there), length_m)
        length_m -= leg_m
    return moved(path[-2], heading_rad(*path[-2:]), length_m)


def rounded(path: tuple[Point, ...], radius_m: float, step_rad: float = math.radians(10)) -> tuple[Point, ...]:
    """The path with every corner replaced by an arc, since a robot that follows tape cannot follow a kink.

    An arc never takes more than half of a leg beside it, so its radius shrinks in a short one.
    """
    corners = (_arc(*corner, radius_m, step_rad) for corner in zip(path, path[1:], path[2:], strict=False))
    return (path[0], *(point for arc in corners for point in arc), path[-1])


def _arc(before: Point, corner: Point, after: Point, radius_m: float, step_rad: float) -> tuple[Point, ...]:
    arriving, leaving = heading_rad(before, corner), heading_rad(corner, after)
    turn_rad = wrapped(leaving - arriving)
    if radius_m <= 0 or abs(turn_rad) < step_rad:
        return (corner,)
    room_m = min(distance_m(before, corner), distance_m(corner, after)) / 2
    cut_m = min(radius_m * math.tan(abs(turn_rad) / 2), room_m)
    radius_m = cut_m / math.tan(abs(turn_rad) / 2)
    side = math.copysign(1.0, turn_rad)
    centre = moved(corner, arriving, -cut_m, side * radius_m)
    steps = math.ceil(abs(turn_rad) / step_rad)
    return tuple(moved(centre, arriving + turn_rad * i / steps, 0.0, -side * radius_m) for i in range(steps + 1))
