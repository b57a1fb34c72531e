"""A page of the tape plan: one post, its lines and markers, as a person lays them out with measure and protractor."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from maps.bays import WAITS_BEFORE_CROSSING_M, Marker
from maps.campus_map import CampusMap, Post
from maps.drawing import BLACK, Page, Shape, Words
from maps.geometry import (
    Point,
    distance_m,
    distance_to_path_m,
    moved,
    part_of_path,
    path_length_m,
    point_along,
    seen_from,
)
from maps.lines import Line, lines_of
from maps.marker_check import SHEET_WIDTH_M, seen_on_arrival
from maps.plan_paper import (
    BLUE,
    GREY,
    INNER_MM,
    MARGIN_MM,
    PALE,
    ROW_MM,
    TEXT_MM,
    Box,
    Column,
    View,
    badge,
    compass_deg,
    fitting_view,
    frame,
    north_and_scale,
    paper,
    table,
)
from maps.room import BODY_M

FLOOR: Final = Box(MARGIN_MM, 33, INNER_MM, 134)
SHOWN_OF_CORRIDOR_M: Final = 0.95
ARC_M: Final = 0.28
ACROSS_AT_M: Final = 1.0
"""Where the distance from line to line is told: farther out it says more than the protractor."""
HOW_TO: Final = (
    "Mark the middle of the post: all distances are from there. Set out each line by its bearing, clockwise",
    f"from north, or by the angle to the next line. Check it across, {ACROSS_AT_M:g} m from the post on both.",
)
LINE_COLUMNS: Final = (
    Column("line", 12),
    Column("", 56),
    Column("bearing", 20, "right"),
    Column("to the next", 26, "right"),
    Column("across", 20, "right"),
    Column("tape", 46),
)
MARKER_COLUMNS: Final = (
    Column("sheet", 12),
    Column("", 56),
    Column("for line", 18),
    Column("from the post", 32, "right"),
    Column("beside the line", 40, "right"),
    Column("faces", 22, "right"),
)


@dataclass(frozen=True)
class Ray:
    """One line as it leaves the post; `letter` on the drawing; `markers` that robots on it read."""

    letter: str
    line: Line
    path: tuple[Point, ...]
    heading_rad: float
    markers: tuple[Marker, ...]

    @property
    def end(self) -> Point:
        return self.path[-1]


def post_page(campus: CampusMap, post: Post, number: int, count: int) -> Page:
    """The floor round the post to scale, and what to measure."""
    rays = _rays(campus, post)
    shapes = [*frame(FLOOR), *_floor(post, rays)]
    top_mm = FLOOR.top_mm + FLOOR.height_mm + 6
    shapes += [
        Words(MARGIN_MM, top_mm + 4.2 * row, TEXT_MM, text, "left", colour=GREY) for row, text in enumerate(HOW_TO)
    ]
    top_mm += 7.5
    shapes += table(top_mm, LINE_COLUMNS, _line_rows(rays, post))
    top_mm += ROW_MM * (len(rays) + 1) + 4
    shapes += table(top_mm, MARKER_COLUMNS, _marker_rows(rays, post))
    return paper(campus, post.title, f"{post.name} · at x = {post.x_m:g} m, y = {post.y_m:g} m", number, count, shapes)


def _rays(campus: CampusMap, post: Post) -> list[Ray]:
    """Clockwise from north."""
    track = campus.track
    lines = [line for line in lines_of(campus) if post.name in line.posts]
    lines.sort(key=lambda line: round(compass_deg(line.corridor.heading_leaving(post.name)), 6))
    return [
        Ray(
            chr(ord("A") + number),
            line,
            _shown(line, post),
            line.corridor.heading_leaving(post.name),
            tuple(_markers_of(track, line, lines, post)),
        )
        for number, line in enumerate(lines)
    ]


def _shown(line: Line, post: Post) -> tuple[Point, ...]:
    path = line.path if line.bay else line.corridor.tape_from(post.name)
    return path if line.bay else part_of_path(path, 0.0, min(SHOWN_OF_CORRIDOR_M, path_length_m(path)))


def _markers_of(track: CampusMap, line: Line, lines: list[Line], post: Post) -> Iterator[Marker]:
    """Those of the post that robots on this line read, or that stand nearest to it, and those of its bay."""
    place = track.post(post.name)
    for marker in place.markers:
        readers = [one for one in lines if seen_on_arrival(track, marker, place, one.corridor)]
        here = Point(marker.x_m, marker.y_m)
        nearest = min(readers or lines, key=lambda one, here=here: distance_to_path_m(here, one.path))  # type: ignore[misc]
        if nearest is line:
            yield marker
    if line.bay:
        yield from line.bay.markers


# The drawing


def _floor(post: Post, rays: Sequence[Ray]) -> Iterator[Shape]:
    sheets = [Point(marker.x_m, marker.y_m) for ray in rays for marker in ray.markers]
    ends = [moved(ray.end, ray.heading_rad, BODY_M / 2 if ray.line.bay else 0.0) for ray in rays]
    view = fitting_view([post.point, *sheets, *ends], FLOOR, padding_mm=12)
    for ray in rays:
        yield from _bodies(view, ray)
    for ray in rays:
        yield from _tape(view, ray)
    yield from _angles(view, post, rays)
    numbers = iter(range(1, len(sheets) + 1))
    for ray in rays:
        for marker in ray.markers:
            yield from _sheet(view, marker, next(numbers))
    yield from _names(view, rays)
    yield from north_and_scale(view)
    yield from _legend(view)


def _bodies(view: View, ray: Ray) -> Iterator[Shape]:
    """Robots that stand in the bay and in the dock, or wait for the crossing."""
    at = ray.path[1:] if ray.line.bay else (point_along(ray.path, WAITS_BEFORE_CROSSING_M),)
    for axle in at:
        yield view.circle(axle, BODY_M / 2, PALE, dashed=not ray.line.bay)


def _tape(view: View, ray: Ray) -> Iterator[Shape]:
    width_mm = max(0.8, view.size_mm(0.024))
    tape = ray.path[:2] if ray.line.bay else ray.path
    yield from view.path(tape, width_mm)
    if not ray.line.bay:
        return
    yield _length(view, tape[0], tape[1], ray.heading_rad)
    across = (moved(tape[1], ray.heading_rad, 0.0, side_m) for side_m in (0.05, -0.05))
    yield from view.path(across, 0.5)
    for dock in ray.path[2:]:
        yield from view.path((tape[1], dock), 0.3, GREY, dashed=True)
        yield _length(view, tape[1], dock, ray.heading_rad)
        for ahead_m, left_m in ((0.05, 0.0), (0.0, 0.05)):
            ends = (moved(dock, ray.heading_rad, sign * ahead_m, sign * left_m) for sign in (1, -1))
            yield from view.path(ends, 0.5)
        front = (moved(dock, ray.heading_rad, BODY_M / 2, side_m) for side_m in (0.15, -0.15))
        yield from view.path(front, 1.2, GREY)


def _length(view: View, here: Point, there: Point, heading_rad: float) -> Words:
    """On the line, nearer to its end, where no angle is written."""
    length_m = distance_m(here, there)
    x_mm, y_mm = view.place(moved(here, heading_rad, 0.5 * length_m if length_m < 2 * ARC_M else 0.6 * length_m))
    return Words(x_mm, y_mm + 0.9, 2.4, f"{length_m:.2f} m", on_white=True)


def _angles(view: View, post: Post, rays: Sequence[Ray]) -> Iterator[Shape]:
    for ray, angle_deg in zip(rays, _to_next_deg(rays), strict=True):
        steps = max(2, round(angle_deg / 5))
        turns = [ray.heading_rad - math.radians(angle_deg) * step / steps for step in range(steps + 1)]
        yield from view.path((moved(post.point, turn, ARC_M) for turn in turns), 0.2, GREY)
        x_mm, y_mm = view.place(moved(post.point, ray.heading_rad - math.radians(angle_deg) / 2, ARC_M))
        yield Words(x_mm, y_mm + 1, TEXT_MM, f"{angle_deg:.4g}°", colour=GREY, on_white=True)


def _sheet(view: View, marker: Marker, number: int) -> Iterator[Shape]:
    """The sheet from above, a stroke the way it faces, its number behind it."""
    here = Point(marker.x_m, marker.y_m)
    edges = (moved(here, marker.heading_rad, 0.0, side * SHEET_WIDTH_M / 2) for side in (1, -1))
    yield from view.path(edges, 1.0, BLUE)
    yield from view.path((here, moved(here, marker.heading_rad, 0.07)), 0.3, BLUE)
    x_mm, y_mm = view.place(here)
    yield from badge(
        x_mm - 3.6 * math.cos(marker.heading_rad), y_mm + 3.6 * math.sin(marker.heading_rad), str(number), BLUE
    )


def _names(view: View, rays: Sequence[Ray]) -> Iterator[Shape]:
    for ray in rays:
        x_mm, y_mm = view.place(moved(ray.end, ray.heading_rad, BODY_M / 2 if ray.line.bay else 0.0))
        x_mm += 5 * math.cos(ray.heading_rad)
        y_mm -= 5 * math.sin(ray.heading_rad)
        yield from badge(x_mm, y_mm, ray.letter, BLACK)


def _legend(view: View) -> Iterator[Shape]:
    right_mm, base_mm = view.box.left_mm + view.box.width_mm - 4, view.box.top_mm + view.box.height_mm - 4
    said = ("blue: marker sheet, facing the way of its stroke", "circle: robot, dashed where it waits to cross")
    for row, text in enumerate(reversed(said)):
        yield Words(right_mm, base_mm - 3.8 * row, 2.4, text, "right", colour=GREY)


# The tables


def _to_next_deg(rays: Sequence[Ray]) -> list[float]:
    """The clockwise angle from each line to the next one; a whole turn for a line alone."""
    bearings = [compass_deg(ray.heading_rad) for ray in rays]
    return [
        round((after - here) % 360, 6) or 360.0
        for here, after in zip(bearings, [*bearings[1:], *bearings[:1]], strict=True)
    ]


def _line_rows(rays: Sequence[Ray], post: Post) -> Iterator[Sequence[str]]:
    letters = [ray.letter for ray in rays]
    following = zip(rays, _to_next_deg(rays), [*letters[1:], *letters[:1]], strict=True)
    for ray, angle_deg, after in following:
        across_m = 2 * ACROSS_AT_M * math.sin(math.radians(angle_deg) / 2)
        yield (
            ray.letter,
            _said(ray.line, post),
            f"{compass_deg(ray.heading_rad):.4g}°",
            f"{angle_deg:.4g}° to {after}",
            f"{across_m:.3f} m",
            _tape_said(ray.line, post),
        )


def _said(line: Line, post: Post) -> str:
    if not line.bay:
        return f"corridor to {line.corridor.other(post.name)}"
    return f"{line.bay.name}{', home' if line.bay.homes else ''}{', dock' if line.bay.dock else ''}"


def _tape_said(line: Line, post: Post) -> str:
    length_m = line.corridor.length_m
    if not line.bay:
        return f"{length_m:.2f} m{' (assumed)' if line.corridor.assumed else ''}"
    if line.bay.dock is None:
        return f"ends at {length_m:.2f} m"
    dock_m, _ = seen_from(post.point, line.corridor.heading_leaving(post.name), line.path[-1])
    return f"ends at {length_m:.2f} m, dock {dock_m:.2f} m"


def _marker_rows(rays: Sequence[Ray], post: Post) -> Iterator[Sequence[str]]:
    number = 0
    for ray in rays:
        for marker in ray.markers:
            number += 1
            out_m, left_m = seen_from(post.point, ray.heading_rad, Point(marker.x_m, marker.y_m))
            side = "left" if left_m > 0 else "right"
            faces = f"{compass_deg(marker.heading_rad):.4g}°"
            yield str(number), marker.post, ray.letter, f"{out_m:.2f} m", f"{abs(left_m):.2f} m to the {side}", faces
