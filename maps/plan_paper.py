"""Paper of the tape plan: A4 pages with a head, floor drawn to scale, and tables."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise
from typing import NamedTuple

from maps.campus_map import CampusMap
from maps.drawing import Align, Circle, Line, Page, Shape, Words
from maps.geometry import Point

WIDTH_MM, HEIGHT_MM, MARGIN_MM = 210.0, 297.0, 15.0
INNER_MM = WIDTH_MM - 2 * MARGIN_MM
GREY, PALE, BLUE = "#707070", "#b8b8b8", "#1a5fa8"
TEXT_MM, ROW_MM = 2.7, 4.7
STEPS = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)


class Box(NamedTuple):
    left_mm: float
    top_mm: float
    width_mm: float
    height_mm: float


@dataclass(frozen=True, slots=True)
class View:
    """The floor on the page: 1 : `scale`, with `centre` (metres) in the middle of the box; north is up."""

    box: Box
    centre: Point
    scale: float

    def place(self, point: Point) -> tuple[float, float]:
        mm_per_m = 1000 / self.scale
        x_mm = self.box.left_mm + self.box.width_mm / 2 + (point.x_m - self.centre.x_m) * mm_per_m
        return x_mm, self.box.top_mm + self.box.height_mm / 2 - (point.y_m - self.centre.y_m) * mm_per_m

    def size_mm(self, length_m: float) -> float:
        return length_m * 1000 / self.scale

    def path(
        self, points: Iterable[Point], width_mm: float = 0.3, colour: str = "#000000", dashed: bool = False
    ) -> Iterator[Line]:
        for here, there in pairwise(points):
            yield Line(*self.place(here), *self.place(there), width_mm, colour, dashed)

    def circle(self, at: Point, radius_m: float, colour: str, dashed: bool = False) -> Circle:
        return Circle(*self.place(at), self.size_mm(radius_m), 0.25, colour, dashed)


def fitting_view(points: Sequence[Point], box: Box, padding_mm: float) -> View:
    """The largest round scale at which all points lie in the box, so far from its edge."""
    xs, ys = zip(*points, strict=True)
    wide_mm, high_mm = 1000 * (max(xs) - min(xs)), 1000 * (max(ys) - min(ys))
    exact = max(wide_mm / (box.width_mm - 2 * padding_mm), high_mm / (box.height_mm - 2 * padding_mm), 1.0)
    ten = 10 ** math.floor(math.log10(exact))
    scale = next(step * ten for step in STEPS if step * ten >= exact - 1e-9)
    return View(box, Point((max(xs) + min(xs)) / 2, (max(ys) + min(ys)) / 2), scale)


def north_and_scale(view: View) -> Iterator[Shape]:
    """An arrow in the upper right corner of the box and a bar in its lower left one."""
    x_mm, top_mm = view.box.left_mm + view.box.width_mm - 6, view.box.top_mm + 9
    yield Words(x_mm, top_mm - 2, 4, "N", bold=True)
    yield from (Line(x_mm, top_mm, x_mm + dx_mm, top_mm + 4, 0.4) for dx_mm in (-1.6, 1.6))
    yield Line(x_mm, top_mm, x_mm, top_mm + 12, 0.4)
    length_m = max(step for step in (0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500) if view.size_mm(step) <= 50)
    left_mm, base_mm = view.box.left_mm + 4, view.box.top_mm + view.box.height_mm - 5
    right_mm = left_mm + view.size_mm(length_m)
    yield Line(left_mm, base_mm, right_mm, base_mm, 0.4)
    yield from (Line(x_mm, base_mm - 1, x_mm, base_mm + 1, 0.4) for x_mm in (left_mm, right_mm))
    yield Words(right_mm + 2, base_mm + 1, TEXT_MM, f"{length_m:g} m   (1 : {view.scale:g})", "left")


@dataclass(frozen=True, slots=True)
class Column:
    heading: str
    width_mm: float
    align: Align = "left"


def table(
    top_mm: float, columns: Sequence[Column], rows: Iterable[Sequence[str]], left_mm: float = MARGIN_MM
) -> list[Shape]:
    """The first row in bold, each of the others on a thin line."""
    starts_mm = list(accumulate((column.width_mm for column in columns), initial=left_mm))
    shapes: list[Shape] = []
    for number, row in enumerate([[column.heading for column in columns], *rows]):
        base_mm = top_mm + ROW_MM * (number + 1) - 1.4
        for text, column, start_mm in zip(row, columns, starts_mm, strict=False):
            x_mm = start_mm if column.align == "left" else start_mm + column.width_mm - 5
            shapes.append(Words(x_mm, base_mm, TEXT_MM, text, column.align, bold=number == 0))
        line_mm = base_mm + 1.4
        shapes.append(Line(left_mm, line_mm, starts_mm[-1], line_mm, 0.4 if number == 0 else 0.1, GREY))
    return shapes


def paper(campus: CampusMap, title: str, under: str, number: int, count: int, shapes: Iterable[Shape]) -> Page:
    """A page with its head and foot."""
    right_mm, foot_mm = WIDTH_MM - MARGIN_MM, HEIGHT_MM - 9
    head = (
        Words(MARGIN_MM, 20, min(6.5, 1.4 * INNER_MM / max(len(title), 1)), title, "left", bold=True),
        Words(MARGIN_MM, 26, 3.2, under, "left", colour=GREY),
        Line(MARGIN_MM, 29, right_mm, 29, 0.5),
    )
    foot = (
        Words(
            MARGIN_MM, foot_mm, 2.5, f"Tape plan of {campus.title} · map version {campus.version}", "left", colour=GREY
        ),
        Words(right_mm, foot_mm, 2.5, f"page {number} of {count}", "right", colour=GREY),
    )
    return Page(WIDTH_MM, HEIGHT_MM, (*head, *shapes, *foot))


def frame(box: Box) -> Iterator[Shape]:
    """A thin border round a box."""
    right_mm, bottom_mm = box.left_mm + box.width_mm, box.top_mm + box.height_mm
    corners = [(box.left_mm, box.top_mm), (right_mm, box.top_mm), (right_mm, bottom_mm), (box.left_mm, bottom_mm)]
    for here, there in pairwise([*corners, corners[0]]):
        yield Line(*here, *there, 0.2, PALE)


def badge(x_mm: float, y_mm: float, text: str, colour: str) -> Iterator[Shape]:
    """A letter or number in a filled circle."""
    yield Circle(x_mm, y_mm, 2.3, 0.3, colour, fill=colour)
    yield Words(x_mm, y_mm + 1.0, 2.8, text, bold=True, colour="#ffffff")


def compass_deg(heading_rad: float) -> float:
    """Degrees clockwise from north."""
    return (90 - math.degrees(heading_rad)) % 360
